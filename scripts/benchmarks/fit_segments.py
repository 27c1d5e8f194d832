"""Piecewise-linear curves: time on 1.5 million points, and sums of squares against R's segmented and pwlf's algorithm."""

import json
import pathlib
import statistics
import subprocess
import tempfile

import segmented_peers

TURNS = 3
LARGE = [(5, 1.0), (15, 3.0)]  # segments, at most [s]
MOST_BREAKPOINTS = 4
WORSE = 1e-9  # relative, that still counts as not worse


def part(house):
    program = str(house / "build/release/bin/kerf_segmented_benchmark")
    return "\n\n".join([large(program), against_peers(program)])


def run(program, *arguments):
    return json.loads(subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout)


def large(program):
    lines = ["**Piecewise-linear curves of 1.5 million points**, every number of segments up to the one named in one pass, "
             "medians of %d:" % TURNS, "", "| points | segments | seconds | at most |", "|---|---|---|---|"]
    for what, kind in (("strokes, as recorded", "made:1500000"), ("in order of position", "made:1500000:sorted")):
        for segments, most in LARGE:
            seconds = statistics.median(run(program, kind, segments)["seconds"] for _ in range(TURNS))
            lines.append("| %s | %d | %.2f | %.0f%s |" % (what, segments, seconds, most, "" if seconds <= most else ", missed"))
    return "\n".join(lines)


def against_peers(program):
    lines = ["**Sums of squares** with 1 to %d breakpoints: R's segmented (20 bootstrap restarts) and pwlf's algorithm "
             "(differential evolution and a polish) over Kerf's; below 1 Kerf would be worse. Kerf proves its optimum on a "
             "grid and asks one point of each segment here, as they do." % MOST_BREAKPOINTS, "",
             "| case | breakpoints | Kerf [N^2] | segmented | pwlf | seconds: Kerf, all in one pass | segmented | pwlf |",
             "|---|---|---|---|---|---|---|---|"]
    worse = []
    with tempfile.TemporaryDirectory() as folder:
        paths = {}
        for name, x, y in segmented_peers.cases():
            paths[name] = (pathlib.Path(folder) / (name.replace(" ", "_") + ".csv"), x, y)
            rows = ["%.17g,%.17g" % pair for pair in zip(x, y)]
            paths[name][0].write_text("position,force\n" + "\n".join(rows) + "\n")
        of_r = with_r([str(path) for path, _, _ in paths.values()])
        for name, (path, x, y) in paths.items():
            kerf = run(program, path, MOST_BREAKPOINTS + 1, 1)
            best = {curve["segments"]: curve["sum_of_squares"] for curve in kerf["curves"]}
            for count in range(1, MOST_BREAKPOINTS + 1):
                ours = best.get(count + 1)
                if ours is None:
                    continue
                peers = {"segmented": of_r[path.name, count], "pwlf": segmented_peers.as_pwlf(x, y, count)}
                lines.append("| %s | %d | %.6f | %s | %s | %s | %.2f | %.2f |" % (
                    name, count, ours, ratio(peers["segmented"][0], ours), ratio(peers["pwlf"][0], ours),
                    "%.3f" % kerf["seconds"] if count == 1 else "", peers["segmented"][1], peers["pwlf"][1]))
                worse += ["%s with %d against %s by %.1e" % (name, count, peer, ours / squares - 1.0)
                          for peer, (squares, _) in peers.items() if ours > (1.0 + WORSE) * squares]
    return "\n".join(lines + ["", "Kerf worse: %s." % ("; ".join(worse) or "nowhere")])


def ratio(theirs, ours):
    return "%.6f" % (theirs / ours) if theirs == theirs else "no fit"


def with_r(paths):
    script = str(pathlib.Path(__file__).with_name("segmented_peers.R"))
    output = subprocess.run(["Rscript", script, str(MOST_BREAKPOINTS), *paths], check=True, capture_output=True,
                            text=True).stdout
    found = {}
    for line in output.splitlines():
        name, count, squares, seconds = line.split()
        found[name, int(count)] = (float(squares.replace("NA", "nan")), float(seconds))
    return found
