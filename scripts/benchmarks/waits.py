# peers:
# targets: kerf kerf-reader kerf_fit_benchmark
"""How long a person waits for fits, choices and charts, and how much memory a long recording's take, against what was asked for.

    scripts/benchmark waits [--turns 3] [--data FOLDER] [--no-long]     --no-long: without the 10,000,000 rows, nothing written
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import fits_data
from sections import replace_section

LONG_ROWS = 10_000_000
LIMIT_S = 120  # of one turn; what takes longer is said to

parser = argparse.ArgumentParser()
parser.add_argument("house", type=pathlib.Path)
parser.add_argument("--turns", type=int, default=3)
parser.add_argument("--data", type=pathlib.Path, help="folder of what scripts/fetch-data brings")
parser.add_argument("--no-long", action="store_true")
arguments = parser.parse_args()
program = str(arguments.house / "build/release/bin/kerf")
fits = str(arguments.house / "build/release/bin/kerf_fit_benchmark")


def run(command, folder):
    """Seconds, and the most memory that the program or its reader had at once [GB]; the program may find nothing that serves."""
    begin = time.monotonic()
    with open(folder / "errors", "w+") as errors:
        child = subprocess.Popen(["timeout", str(LIMIT_S), *command], cwd=folder, stdout=subprocess.DEVNULL, stderr=errors)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        if child.returncode == 124:
            return float("inf"), float("nan")
        if child.returncode not in (0, 1):
            sys.exit("%s: %s" % (" ".join(map(str, command)), errors.read().strip()))
    return time.monotonic() - begin, usage.ru_maxrss * 1024 / 1e9


def median_of(command, folder, turns):
    first = run(command, folder)
    costs = [first] + ([run(command, folder) for _ in range(turns - 1)] if first[0] < LIMIT_S else [])
    return statistics.median(seconds for seconds, _ in costs), max(memory for _, memory in costs)


def verdict(figure, limit):
    return "no limit" if limit is None else "met" if figure <= limit else "**missed**"


def row(what, seconds, limit_s, memory=None, limit_gb=None):
    took = "%.2f" % seconds if seconds < LIMIT_S else "over %d" % LIMIT_S
    line = "| %s | %s | %s | %s |" % (what, took, "" if limit_s is None else "%g" % limit_s, verdict(seconds, limit_s))
    if memory is not None:
        line += "\n| %s, memory [GB] | %.2f | %g | %s |" % (what, memory, limit_gb, verdict(memory, limit_gb))
    print(line, flush=True)
    return line


def every_law(folder):
    """All laws in one process beside each other, as `kerf fit` has them, each with its folds: seconds of the fits alone."""
    path = str(folder / "kelvin.f64")
    subprocess.run([fits, "make", "kelvin", path, "20000"], check=True)
    turns = []
    for _ in range(arguments.turns):
        turns.append(json.loads(subprocess.run([fits, "laws", path, "together"], check=True, capture_output=True, text=True).stdout)["seconds"])
    return statistics.median(turns)


def recordings(folder):
    """A simulated cut, and what was fetched of punches by hand: names and files."""
    cut = folder / "cut.h5"
    subprocess.run([program, "record", "--device", "sim:scissors", "--seconds", "20", "--virtual", "-o", str(cut)], check=True,
                   capture_output=True)
    subprocess.run([program, "segment", str(cut)], check=True, capture_output=True)
    found = [("simulated cut, 20,000 rows", cut)]
    for name, file, columns, _ in fits_data.RECORDINGS:
        source = fits_data.find(arguments.house, file, arguments.data)
        if name in ("punch, meniscus, slow", "punch, meniscus, fast") and source:
            target = fits_data.imported(program, source, columns, folder / (source.stem + ".h5"))
            subprocess.run([program, "segment", str(target)], check=True, capture_output=True)
            found.append((name, target))
    return found


def long_rows(folder):
    recording = folder / "long.h5"
    subprocess.run([program, "record", "--device", "sim:scissors", "--virtual", "--seconds", str(LONG_ROWS // 1000), "-o",
                    str(recording)], check=True, capture_output=True)
    seconds, memory = median_of([program, "fit", str(recording), "--models", "kelvin,exponential", "--no-folds", "-o", "fits",
                                 "--force"], folder, 1)
    recording.unlink()
    return row("`fit` of kelvin and exponential, 10,000,000 rows", seconds, 15.0, memory, 1.5)


turns = "One turn" if arguments.turns == 1 else "Medians of %d turns, one of the 10,000,000 rows" % arguments.turns
lines = [turns + "; whole programs with reading and writing, in the first row the fits alone.", "", "| what | took [s] | at most | |", "|---|---|---|---|"]
print("\n".join(lines), flush=True)
with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name)
    lines.append(row("every scalar law with five folds, 20,000 rows", every_law(place), 0.4))
    for what, file in recordings(place):
        seconds, _ = median_of([program, "choose", str(file), "--no-loop", "-o", "choice", "--force"], place, arguments.turns)
        lines.append(row("`choose --no-loop`, " + what, seconds, 3.0))
        seconds, _ = median_of([program, "chart", str(file), "--no-cold", "-o", "chart", "--force"], place, arguments.turns)
        lines.append(row("`chart --no-cold`, " + what, seconds, 8.0))
    if not arguments.no_long:
        lines.append(long_rows(place))
if not arguments.no_long:
    replace_section(arguments.house / "docs/benchmarks.md", "waits", "How long a person waits for fits, choices and charts", "\n".join(lines))
