"""Kelvin and exponential on 60,000 samples: Kerf against scipy.optimize.curve_fit and lmfit.minimize."""

import json
import pathlib
import statistics
import subprocess
import tempfile

ROUNDS = 5
TURNS = 6  # fits in a process; the first, which warms it up, is not counted
FASTER = 10.0  # times as fast as the faster peer, asked for
SAME = 1e-9  # relative difference of the sums of squares, at most


def part(house):
    program = str(house / "build/release/bin/kerf_fit_benchmark")
    peers = str(pathlib.Path(__file__).with_name("fit_peers.py"))
    lines = ["**One law, 60,000 samples** (60 s at 1 kHz, noise of 0.02 N): the fit with its covariance and intervals, in a "
             "process of its own, without reading the file; medians of %d fits, by turns. Kerf finds its own start. Its first "
             "column has the covariance that the peers give, of white noise; the second has intervals that allow for "
             "correlated residuals, as `kerf fit` gives them. SciPy and lmfit begin at a guess two to three times off, "
             "with `lfilter` and NumPy in the model and BLAS as Debian sets it." % (ROUNDS * (TURNS - 1)), "",
             "| law | Kerf, white [ms] | Kerf [ms] | curve_fit [ms] | lmfit [ms] | Kerf faster than the faster one: white, correlated | "
             "sums of squares differ by |",
             "|---|---|---|---|---|---|---|"]
    missed = []
    with tempfile.TemporaryDirectory() as folder:
        for law in ("kelvin", "exponential"):
            path = "%s/%s.f64" % (folder, law)
            subprocess.run([program, "make", law, path], check=True)
            commands = {"white": [program, "fit", law, path, str(TURNS), "white"],
                        "Kerf": [program, "fit", law, path, str(TURNS)]}
            for peer in ("scipy", "lmfit"):
                commands[peer] = ["/usr/bin/python3", peers, peer, law, path, str(TURNS)]
            seconds, squares = by_turns(commands)
            median = {name: statistics.median(values) for name, values in seconds.items()}
            ratio = min(median["scipy"], median["lmfit"]) / median["white"]
            honest = min(median["scipy"], median["lmfit"]) / median["Kerf"]
            difference = max(abs(squares[name] / squares["Kerf"] - 1.0) for name in ("scipy", "lmfit"))
            lines.append("| %s | %.1f | %.1f | %.1f | %.1f | **%.1f x**, %.1f x | %.0e |" % (
                law, 1e3 * median["white"], 1e3 * median["Kerf"], 1e3 * median["scipy"], 1e3 * median["lmfit"], ratio, honest, difference))
            if honest < FASTER:
                missed.append("%s, with intervals for correlated residuals, is %.1f times as fast, %.0f asked for" % (law, honest, FASTER))
            if difference > SAME:
                missed.append("the sums of squares of %s differ by %.0e" % (law, difference))
    return "\n".join(lines + ["", "Missed: %s." % ("; ".join(missed) or "nothing")])


def by_turns(commands):
    seconds = {name: [] for name in commands}
    squares = {}
    for _ in range(ROUNDS):
        for name, command in commands.items():
            result = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
            seconds[name] += result["seconds"][1:]
            squares[name] = result["sum_of_squares"]
    return seconds, squares
