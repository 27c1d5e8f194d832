# peers: python3-scipy python3-numpy
"""How often a study of a simulated drawer holds the truth, by the whole way from text files to study.json.

A drawer: 3 tissues x 2 speeds x 5 specimens, Kelvin elements whose parameters differ by 0.1 from specimen to specimen and by 0.05 from
recording to recording (standard deviations of logarithms); liver and skin are alike, cartilage is 1.5 times as stiff. One recording is
clipped, one is in gram-force under a map that says N, one has two clocks.
"""

import collections
import concurrent.futures
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy
from scipy.stats import beta

from sections import replace_section

SEEDS = 2000
LEAST, MOST = 0.93, 0.97
TISSUES = {"liver": 1.0, "skin": 1.0, "cartilage": 1.5}
SPEEDS = {"slow": 1.0, "fast": 2.0}  # strokes a second
MEANS = {"parallel_stiffness": 300.0, "series_stiffness": 500.0, "damping": 50.0}
BETWEEN, WITHIN = 0.1, 0.05
RATE, SECONDS, DEPTH, NOISE = 500.0, 4.0, 0.005, 0.01
MAP = "time=1[s],position=2[mm],force=3[N]"


def exact(held, trials, level=0.999):
    """Clopper and Pearson's interval of a share."""
    tail = 0.5 * (1.0 - level)
    return (beta.ppf(tail, held, trials - held + 1) if held else 0.0, beta.ppf(1.0 - tail, held + 1, trials - held) if held < trials else 1.0)


def drawer(folder, seed):
    """Text files of all recordings; the names of those that something is wrong with."""
    random = numpy.random.default_rng(seed)
    names, parameters, rates = [], [], []
    for place, (tissue, factor) in enumerate(TISSUES.items()):
        for specimen in range(5):
            of_specimen = random.normal(0.0, BETWEEN, 3)
            for speed, rate in SPEEDS.items():
                values = numpy.array(list(MEANS.values())) * factor * numpy.exp(of_specimen + random.normal(0.0, WITHIN, 3))
                names.append("%s_%s_s%d" % (tissue, speed, 5 * place + specimen + 1))
                parameters.append(values)
                rates.append(rate)
    k1, k2, b = numpy.array(parameters).T
    rates = numpy.array(rates)
    rows = int(SECONDS * RATE)
    time = numpy.arange(rows) / RATE
    # The arm's force f of x = D/2 (1 - cos wt) solves f' = k2 x' - (k2 / b) f, f(0) = 0.
    omega, a, phase = 2.0 * math.pi * rates, k2 / b, 2.0 * math.pi * time[:, None] * rates
    position = 0.5 * DEPTH * (1.0 - numpy.cos(phase))
    arm = (0.5 * k2 * DEPTH * omega / (a**2 + omega**2)
           * (a * numpy.sin(phase) + omega * (numpy.exp(-a * time[:, None]) - numpy.cos(phase))))
    force = k1 * position + arm
    force = numpy.maximum(force, 0.0) + random.normal(0.0, NOISE, force.shape)
    clipped, gram, two_clocks = random.choice(len(names), 3, replace=False)
    force[:, clipped] = numpy.minimum(force[:, clipped], 0.9 * force[:, clipped].max())
    force[:, gram] /= 9.80665e-3
    for at, name in enumerate(names):
        clock = numpy.where(time < SECONDS / 2, time, time - SECONDS / 2) if at == two_clocks else time
        table = numpy.column_stack([clock, 1e3 * position[:, at], force[:, at]])
        numpy.savetxt(folder / (name + ".txt"), table, fmt="%.6f", delimiter="\t")
    return {"clipped": names[clipped], "gram": names[gram], "two clocks": names[two_clocks]}


def one_seed(arguments):
    program, seed = arguments
    counts = collections.Counter()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "drawer").mkdir()
        wrong = drawer(folder / "drawer", seed)
        study = folder / "S"
        run = lambda *words: subprocess.run([program, "study", *words], capture_output=True, text=True)
        run("new", str(folder / "drawer"), "--map", MAP, "--laws", "kelvin", "-o", str(study))
        text = (study / "study.toml").read_text().replace('compare = ["peak"]', 'compare = ["kelvin.parallel_stiffness"]')
        (study / "study.toml").write_text(text)
        ran = run("run", str(study / "study.toml"), "-j", "1")
        found = json.loads((study / "study.json").read_text())
        recordings = {one["name"]: one for one in found["recordings"]}
        counts["unit found"] += any("gf taken for N" in doubt for doubt in recordings[wrong["gram"]]["doubts"])
        counts["clock found"] += "anew" in (recordings[wrong["two clocks"]]["failure"] or "")
        counts["clipping found"] += any("clipped" in line for line in recordings[wrong["clipped"]]["warnings"])
        counts["wrongly doubted"] += sum(bool(one["doubts"]) for name, one in recordings.items()
                                         if name not in wrong.values())
        together = math.hypot(BETWEEN, WITHIN)
        for group in found["groups"]:
            for quantity in group["quantities"]:
                parameter = quantity["name"].removeprefix("kelvin.")
                if parameter not in MEANS:
                    continue
                truth = math.log(MEANS[parameter] * TISSUES[group["tissue"]])
                estimate = quantity["estimate"]
                counts[parameter, "trials"] += 1
                counts[parameter, "mean"] += estimate["ci95"][0] <= truth <= estimate["ci95"][1]
                spread = estimate["together"] and estimate["together"]["ci95"]
                counts[parameter, "spread"] += bool(spread) and spread[0] <= together <= spread[1]
        alarm = False
        for comparison in found["comparisons"]:
            tissues = {comparison["first"].split(",")[0], comparison["second"].split(",")[0]}
            differ = comparison["verdict"] == "differ"
            if "cartilage" in tissues and len(tissues) == 2:
                counts["differences"] += 1
                counts["differences", comparison["verdict"]] += 1
            else:
                alarm = alarm or differ
        counts["studies with a false alarm"] += alarm
        counts["seeds"] += 1
        assert ran.returncode == 1, ran.stderr  # the file with two clocks
    return counts


def table(counts):
    seeds = counts["seeds"]
    lines = ["%d simulated drawers of 30 text files (3 tissues x 2 speeds x 5 specimens; one clipped, one in gf under N, one with two clocks), "
             "from files to `study.json`, law `kelvin`. Low or high: the exact 99.9 %% interval of the share does not touch %.0f to %.0f %%." % (
                 seeds, 100 * LEAST, 100 * MOST), "",
             "| 95 % interval of | mean of a group [%] | spread of a group [%] |", "|---|---|---|"]
    for parameter in MEANS:
        trials = counts[parameter, "trials"]
        cells = []
        for what in ("mean", "spread"):
            lower, upper = exact(counts[parameter, what], trials)
            cells.append("%.1f%s" % (100.0 * counts[parameter, what] / trials, " **low**" if upper < LEAST else " (high)" if lower > MOST else ""))
        lines.append("| %s | %s | %s |" % (parameter, *cells))
    differences = counts["differences"]
    lines += ["", "| found | of |", "|---|---|"]
    for what in ("unit found", "clock found", "clipping found"):
        lines.append("| %s: %d | %d |" % (what, counts[what], seeds))
    lines.append("| recordings doubted without a reason: %d | %d |" % (counts["wrongly doubted"], 27 * seeds))
    for verdict in ("differ", "not told apart", "cannot be told"):
        lines.append("| cartilage and another tissue (1.5 times): %s: %d | %d |" % (verdict, counts["differences", verdict], differences))
    lines.append("| studies in which anything else \"differs\": %d | %d |" % (counts["studies with a false alarm"], seeds))
    return lines


def main():
    house = pathlib.Path(sys.argv[1])
    seeds = int(sys.argv[2]) if len(sys.argv) > 2 else SEEDS
    program = str(house / "build/release/bin/kerf")
    counts = collections.Counter()
    with concurrent.futures.ProcessPoolExecutor(os.cpu_count()) as pool:
        for one in pool.map(one_seed, ((program, seed) for seed in range(seeds))):
            counts.update(one)
    body = "\n".join(table(counts))
    print(body)
    replace_section(house / "docs/benchmarks.md", "study", "Studies of simulated drawers", body)


if __name__ == "__main__":
    main()
