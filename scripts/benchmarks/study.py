# peers: python3-scipy python3-numpy
"""How often a study of a simulated drawer holds the truth, by the whole way from text files to study.json, and how long one takes.

A drawer: 3 tissues x 2 speeds x 5 specimens, Kelvin elements whose parameters differ by 0.1 from specimen to specimen and by 0.05 from
recording to recording (standard deviations of logarithms); liver and skin are alike, cartilage is 1.5 times as stiff. One recording is
clipped, one is in gram-force under a map that says N, of one the clock starts anew, and one is two files with a clock each.

    study.py HOUSE [SEEDS]   SEEDS drawers (2,000)
    study.py HOUSE time      a drawer of 19 recordings of 18,000 rows, from files to report
    study.py HOUSE blanks [SEEDS]   drawers of four specimens whose tool rubs, and a blank (2,000)
"""

import ast
import collections
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

import numpy
from scipy.signal import lfilter
from scipy.stats import t as student

from population import LEAST, MOST, told
from sections import replace_section

SEEDS = 2000
TISSUES = {"liver": 1.0, "skin": 1.0, "cartilage": 1.5}
SPEEDS = {"slow": 1.0, "fast": 2.0}  # strokes a second
MEANS = {"parallel_stiffness": 300.0, "series_stiffness": 500.0, "damping": 50.0}
BETWEEN, WITHIN = 0.1, 0.05
RATE, SECONDS, DEPTH, NOISE = 500.0, 4.0, 0.005, 0.01
MAP = "time=1[s],position=2[mm],force=3[N]"


FINE = 20  # steps a row, so that the simulation's own error is far below a standard error


def simulated(parameters, rates, chirps, rows):
    """Positions [m] and forces [N] at FINE steps a row of Kelvin elements, each pushed `rates` times a second, faster by `chirps` a second."""
    k1, k2, b = numpy.array(parameters).T
    rates, chirps = numpy.array(rates), numpy.array(chirps)
    time = (numpy.arange(rows * FINE) / (RATE * FINE))[:, None]
    position = 0.5 * DEPTH * (1.0 - numpy.cos(2.0 * math.pi * rates * (time + 0.5 * chirps * time * time)))
    middle = time + 0.5 / (RATE * FINE)
    turns = rates * (middle + 0.5 * chirps * middle * middle)
    speed = math.pi * DEPTH * rates * (1.0 + chirps * middle) * numpy.sin(2.0 * math.pi * turns)
    decay = numpy.exp(-k2 / b / (RATE * FINE))
    force = k1 * position
    for at in range(len(rates)):  # the arm's force at the beginning of each step
        force[1:, at] += lfilter([b[at] * (1.0 - decay[at])], [1.0, -decay[at]], speed[:-1, at])
    return position, numpy.maximum(force, 0.0)


def specimens_of(random, specimens, speeds):
    """Names, parameters and strokes a second of every tissue, specimen and speed."""
    names, parameters, rates = [], [], []
    for place, (tissue, factor) in enumerate(TISSUES.items()):
        for specimen in range(specimens):
            of_specimen = random.normal(0.0, BETWEEN, 3)
            for speed, rate in speeds.items():
                names.append("%s_%s_s%d" % (tissue, speed, specimens * place + specimen + 1))
                parameters.append(numpy.array(list(MEANS.values())) * factor * numpy.exp(of_specimen + random.normal(0.0, WITHIN, 3)))
                rates.append(rate)
    return names, parameters, rates


def write_table(file, *columns):
    numpy.savetxt(file, numpy.column_stack(columns), fmt="%.7f", delimiter="\t")


def write_two_clocks(folder, name, random, position, force):
    """The motion by one clock and the forces by another one, t = shift + (1 + skew) t_other, with the wire by which both are found together."""
    shift, skew = random.uniform(0.1, 0.4), random.uniform(-3e-4, 3e-4)
    fine = numpy.arange(len(position)) / (RATE * FINE)
    time = numpy.arange(len(position) // FINE) / RATE
    write_table(folder / (name + "_position.txt"), time, 1e3 * position[::FINE])
    other = numpy.arange(int((fine[-1] - shift) / (1.0 + skew) * RATE)) / RATE
    at = shift + (1.0 + skew) * other
    wire = numpy.interp(at, fine, position) + random.normal(0.0, 1e-6, len(at))
    write_table(folder / (name + "_force.txt"), other, 1e3 * wire, numpy.interp(at, fine, force) + random.normal(0.0, NOISE, len(at)))
    return {"name": name + "_position", "shift_s": shift, "skew": skew}


def drawer(folder, seed):
    """Text files of all recordings; the names of those that something is wrong with."""
    random = numpy.random.default_rng(seed)
    names, parameters, rates = specimens_of(random, 5, SPEEDS)
    clipped, gram, anew, two_clocks = random.choice(len(names), 4, replace=False)
    chirps = numpy.zeros(len(names))
    chirps[two_clocks] = 0.15  # strokes that are all alike tell no shift
    rows = int(SECONDS * RATE)
    fine_position, fine_force = simulated(parameters, rates, chirps, rows)
    position = fine_position[::FINE]
    force = fine_force[::FINE] + random.normal(0.0, NOISE, position.shape)
    force[:, clipped] = numpy.minimum(force[:, clipped], 0.9 * force[:, clipped].max())
    force[:, gram] /= 9.80665e-3
    time = numpy.arange(rows) / RATE
    wrong = {"clipped": names[clipped], "gram": names[gram], "anew": names[anew]}
    for at, name in enumerate(names):
        if at == two_clocks:
            wrong["two clocks"] = write_two_clocks(folder, name, random, fine_position[:, at], fine_force[:, at])
        else:
            clock = numpy.where(time < SECONDS / 2, time, time - SECONDS / 2) if at == anew else time
            write_table(folder / (name + ".txt"), clock, 1e3 * position[:, at], force[:, at])
    return wrong


def confirmed(text):
    """study.toml as a person corrects it: what is compared, and the two files that are one recording."""
    text = text.replace('compare = ["peak"]', 'compare = ["kelvin.parallel_stiffness"]')
    return re.sub(r"join_suggested = (.*)", r'join = \1\njoin_map = "%s"\njoin_on = "position"\nmap = "time=1[s],position=2[mm]"' % MAP, text)


def count_clocks(counts, truth, recordings):
    """Whether the shift and the skew of the two files lie within their 95 % intervals (t of 15 degrees of freedom)."""
    found = recordings[truth["name"]]
    if not found["joined"]:
        return
    counts["joined"] += 1
    for what in ("shift", "skew"):
        key = "shift_s" if what == "shift" else "skew"
        error = found["joined"]["shift_std_error_s" if what == "shift" else "skew_std_error"]
        counts[what, "held"] += abs(found["joined"][key] - truth[key]) <= 2.131 * error


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
        text = (study / "study.toml").read_text()
        counts["pair suggested"] += 'join_suggested = "%s' % wrong["two clocks"]["name"].removesuffix("position") in text
        (study / "study.toml").write_text(confirmed(text))
        ran = run("run", str(study / "study.toml"), "-j", "1")
        found = json.loads((study / "study.json").read_text())
        recordings = {one["name"]: one for one in found["recordings"]}
        counts["unit found"] += any("gf taken for N" in doubt for doubt in recordings[wrong["gram"]]["doubts"])
        counts["clock found"] += "anew" in (recordings[wrong["anew"]]["failure"] or "")
        count_clocks(counts, wrong["two clocks"], recordings)
        counts["clipping found"] += any("clipped" in line for line in recordings[wrong["clipped"]]["warnings"])
        counts["wrongly doubted"] += sum(bool(one["doubts"]) for name, one in recordings.items() if name not in (wrong["gram"], wrong["clipped"]))
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
        assert ran.returncode == 1, ran.stderr  # the file whose clock starts anew
    return counts


def table(counts):
    seeds = counts["seeds"]
    lines = ["%d simulated drawers of 30 text files (3 tissues x 2 speeds x 5 specimens; one clipped, one in gf under N, one whose clock starts anew, one in two "
             "files with a clock each), "
             "from files to `study.json`, law `kelvin`. Low or high: the exact 99.9 %% interval of the share does not touch %.0f to %.0f %%." % (
                 seeds, 100 * LEAST, 100 * MOST), "",
             "| 95 % interval of | mean of a group [%] | spread of a group [%] |", "|---|---|---|"]
    for parameter in MEANS:
        trials = counts[parameter, "trials"]
        cells = []
        for what in ("mean", "spread"):
            cells.append(told(counts[parameter, what], trials))
        lines.append("| %s | %s | %s |" % (parameter, *cells))
    differences = counts["differences"]
    lines += ["", "| found | of |", "|---|---|"]
    for what in ("unit found", "clock found", "clipping found", "pair suggested", "joined"):
        lines.append("| %s: %d | %d |" % (what, counts[what], seeds))
    for what in ("shift", "skew"):
        lines.append("| %s of the two clocks within its 95 %% interval: %d | %d |" % (what, counts[what, "held"], counts["joined"]))
    lines.append("| recordings doubted without a reason: %d | %d |" % (counts["wrongly doubted"], 27 * seeds))
    for verdict in ("differ", "not told apart", "cannot be told"):
        lines.append("| cartilage and another tissue (1.5 times): %s: %d | %d |" % (verdict, counts["differences", verdict], differences))
    lines.append("| studies in which anything else \"differs\": %d | %d |" % (counts["studies with a false alarm"], seeds))
    lines += ["", "Of two groups that differ 1.5 times, with five specimens each, %.0f %% of the comparisons say so after correction for all; of what is alike %.1f %% of the "
              "studies say that something differs, where 5 %% are allowed. The drawers are simulated by this script, in closed form and without Kerf's code." % (
                  100.0 * counts["differences", "differ"] / differences, 100.0 * counts["studies with a false alarm"] / seeds)]
    return lines


def time_one(house):
    """Seconds from 19 files of 18,000 rows to the report, on two processors."""
    program = str(house / "build/release/bin/kerf")
    random = numpy.random.default_rng(1)
    names, parameters, rates = specimens_of(random, 3, {"slow": 1.0 / 3.0, "fast": 2.0 / 3.0})
    position, force = (values[::FINE] for values in simulated(parameters + [numpy.array([1.0, 1.0, 20.0])], rates + [1.0 / 3.0], [0.0] * 19, 18000))
    force = force + random.normal(0.0, NOISE, force.shape)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "drawer").mkdir()
        for at, name in enumerate(names + ["blank_slow"]):
            write_table(folder / "drawer" / (name + ".txt"), numpy.arange(18000) / RATE, 1e3 * position[:, at], force[:, at])
        seconds, processor = [], []
        for words in (["new", str(folder / "drawer"), "--map", MAP, "-o", str(folder / "S")], ["run", str(folder / "S/study.toml"), "-j", "2"]):
            begin = time.monotonic()
            subprocess.run([program, "study", *words], check=True, capture_output=True)
            seconds.append(time.monotonic() - begin)
            used = resource.getrusage(resource.RUSAGE_CHILDREN)
            processor.append(used.ru_utime + used.ru_stime - sum(processor))
    return ["19 recordings of 18,000 rows (18 punches of three tissues at two speeds and a blank, 12 and 24 cycles each), the usual four laws, "
            "on two processors (`-j 2`):", "", "| step | seconds | of which processor, both together |", "|---|---|---|",
            "| `kerf study new` | %.1f | %.1f |" % (seconds[0], processor[0]),
            "| `kerf study run`, from files to report | %.1f | %.1f |" % (seconds[1], processor[1]), "",
            "The machine also did other work: %.1f processes were ready to run on average." % os.getloadavg()[0]]


RUBBING, OF_CYCLES, OF_SPECIMENS = 0.3, 0.2, 0.03  # [N]; relative, from cycle to cycle and from specimen to specimen


def rubbed(random, parameters, rows):
    """Position [m] and force [N] of a punch, a little faster each time, whose tool rubs against its motion, each cycle by another factor."""
    chirp = 0.5  # strokes a second, more each second
    position, force = (values[::FINE, 0] for values in simulated([parameters], [0.5], [2.0 * chirp], rows))
    time = numpy.arange(rows) / RATE
    turns = 0.5 * (time + chirp * time * time)
    speed = numpy.gradient(position, time)
    against = numpy.clip(speed / (0.4 * math.pi * DEPTH * 0.5 * (1.0 + 2.0 * chirp * time)), -1.0, 1.0)
    factors = 1.0 + OF_CYCLES * random.normal(size=int(turns[-1]) + 1)
    rubbing = RUBBING * (1.0 + 40.0 * position) * against * factors[turns.astype(int)]
    return position, force + rubbing + random.normal(0.0, NOISE, rows)


def one_blank(arguments):
    """Which intervals of one drawer hold the truth: with the blank's error in them, and without."""
    program, seed = arguments
    random = numpy.random.default_rng(seed)
    counts = collections.Counter(seeds=1)
    rows = int(SECONDS * RATE)
    time = numpy.arange(rows) / RATE
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "drawer").mkdir()
        for name in ["liver_slow_s%d" % (i + 1) for i in range(4)] + ["blank_slow"]:
            parameters = numpy.array(list(MEANS.values())) * numpy.exp(random.normal(0.0, OF_SPECIMENS, 3))
            if name == "blank_slow":
                parameters = [0.0, 1e-9, 50.0]
            position, force = rubbed(random, parameters, rows)
            write_table(folder / "drawer" / (name + ".txt"), time, 1e3 * position, force)
        study = folder / "S"
        run = lambda *words: subprocess.run([program, "study", *words], capture_output=True, text=True, check=True)
        run("new", str(folder / "drawer"), "--map", MAP, "--laws", "kelvin", "-o", str(study))
        text = (study / "study.toml").read_text()
        counts["suggested"] += '\nblank = "subtract"' in text
        (study / "study.toml").write_text(text.replace('\nblank = "leave"', '\nblank = "subtract"'))
        run("run", str(study / "study.toml"), "-j", "1")
        for quantity in json.loads((study / "study.json").read_text())["groups"][0]["quantities"]:
            parameter = quantity["name"].removeprefix("kelvin.")
            if parameter not in MEANS:
                continue
            estimate, truth = quantity["estimate"], math.log(MEANS[parameter])
            counts[parameter, "held"] += estimate["ci95"][0] <= truth <= estimate["ci95"][1]
            alone = math.sqrt(max(0.0, estimate["std_error"] ** 2 - estimate["std_error_of_blanks"] ** 2))
            counts[parameter, "held without"] += abs(estimate["mean"] - truth) <= student.ppf(0.975, 3) * alone
    return counts


def blanks_table(counts):
    seeds = counts["seeds"]
    lines = ["%d simulated drawers of four specimens and a blank, law `kelvin`: the tool rubs with %.1f N, by a factor that differs by %.0f %% from cycle to cycle; specimens "
             "differ by %.0f %%. `subtract` was suggested in %d." % (seeds, RUBBING, 100 * OF_CYCLES, 100 * OF_SPECIMENS, counts["suggested"]), "",
             "| 95 % interval of a mean | with the blank's error [%] | without [%] |", "|---|---|---|"]
    for parameter in MEANS:
        lines.append("| %s | %s | %.1f |" % (parameter, told(counts[parameter, "held"], seeds), 100.0 * counts[parameter, "held without"] / seeds))
    return lines


TOGETHER = 50  # seeds that are kept as one


def some_seeds(program, kept, one, begin, end):
    """Counts of these seeds, made now or before."""
    if not kept.exists():
        counts = collections.Counter()
        for seed in range(begin, end):
            counts.update(one((program, seed)))
        partial = kept.with_suffix(".part")
        partial.write_text(repr({what: int(number) for what, number in counts.items()}))
        partial.rename(kept)
    return collections.Counter(ast.literal_eval(kept.read_text()))


def over_seeds(house, one, seeds):
    """Counts of all seeds. They are kept in build/drawers/ by the program and the script that made them: what was interrupted goes on
    where it was."""
    program = house / "build/release/bin/kerf"
    makers = hashlib.sha256(program.read_bytes() + pathlib.Path(__file__).read_bytes()).hexdigest()[:12]
    folder = house / "build/drawers" / ("%s-%s" % (one.__name__, makers))
    folder.mkdir(parents=True, exist_ok=True)
    counts = collections.Counter()
    with concurrent.futures.ProcessPoolExecutor(os.cpu_count()) as pool:
        spans = [(begin, min(begin + TOGETHER, seeds)) for begin in range(0, seeds, TOGETHER)]
        parts = [pool.submit(some_seeds, str(program), folder / ("%d-%d" % span), one, *span) for span in spans]
        for part in parts:
            counts.update(part.result())
    return counts


def main():
    house = pathlib.Path(sys.argv[1])
    if sys.argv[2:3] == ["blanks"]:
        seeds = int(sys.argv[3]) if len(sys.argv) > 3 else SEEDS
        counts = over_seeds(house, one_blank, seeds)
        body = "\n".join(blanks_table(counts))
        print(body)
        replace_section(house / "docs/benchmarks.md", "study-blanks", "Studies whose blanks are taken off", body)
        return
    if sys.argv[2:] == ["time"]:
        body = "\n".join(time_one(house))
        print(body)
        replace_section(house / "docs/benchmarks.md", "study-time", "How long a study takes", body)
        return
    seeds = int(sys.argv[2]) if len(sys.argv) > 2 else SEEDS
    counts = over_seeds(house, one_seed, seeds)
    body = "\n".join(table(counts))
    print(body)
    replace_section(house / "docs/benchmarks.md", "study", "Studies of simulated drawers", body)


if __name__ == "__main__":
    main()
