"""A recording of 10^8 rows, looked at with Kerf and with h5py and numpy, by turns."""

import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

from studio_recordings import PEER, into_page_cache, run

ROUNDS = 3
MOVES = 200
ROWS = 100_000_000
AXES = 1


def measure(house):
    program = house / "build/release/bin/kerf_recording_benchmark"
    turns = {"first": [], "again": [], "peer": []}
    with tempfile.TemporaryDirectory(dir=house / "build") as name:
        folder = pathlib.Path(name)
        file, cache = folder / "long.h5", folder / "cache"
        subprocess.run([program, "make", file, str(ROWS), str(AXES)], check=True)
        for _ in range(ROUNDS):
            into_page_cache(file)
            shutil.rmtree(cache, ignore_errors=True)
            turns["first"].append(run([program, "long", file, cache, MOVES]))
            turns["peer"].append(run([sys.executable, "-c", PEER, file, 4]))
            turns["again"].append(run([program, "open", file, cache]))
        bytes_of_file = file.stat().st_size
        bytes_of_cache = sum(part.stat().st_size for part in cache.iterdir())

    def median(turn, *keys):
        values = turns[turn]
        for key in keys:
            values = [value[key] for value in values]
        return statistics.median(values)

    peer = median("peer", "first_view_ms") / 1e3
    meanwhile = all(result["all_meanwhile"] for result in turns["first"])
    body = "\n".join([
        "%.0f million rows, %.1f GB, in the page cache: position, velocity and force of one axis in 1200 columns. h5py and numpy read all "
        "and decimate it. Medians of %d rounds by turns; %d moves a round, stretches from the whole down to a hundred-thousandth." % (
            ROWS / 1e6, bytes_of_file / 1e9, ROUNDS, MOVES), "",
        "| what | measured | budget |", "|---|---|---|",
        "| First overview, of 64 rows a column and labelled so [s] | %.2f | 2 |" % (median("first", "first_view_ms") / 1e3),
        "| Of which opening [s] | %.2f | |" % (median("first", "open_ms") / 1e3),
        "| A move meanwhile, median and p99 [ms] | %.1f, %.1f | |" % (
            median("first", "meanwhile", "p50_ms"), median("first", "meanwhile", "p99_ms")),
        "| Exact extremes of every column are there after, these moves answered first [s] | %.1f | |" % median("first", "prepared_s"),
        "| A move then, median and p99 [ms] | %.1f, %.1f | |" % (
            median("first", "afterwards", "p50_ms"), median("first", "afterwards", "p99_ms")),
        "| Overview in a new process later, exact [s] | %.2f | 2 |" % (median("again", "first_view_ms") / 1e3),
        "| h5py and numpy: the same overview, exact [s] | %.1f | |" % peer, "",
        "- %s of the moves fell into the time before. Kept on the disk: %.0f MB, %.1f %% of the recording." % (
            "All" if meanwhile else "Not all", bytes_of_cache / 1e6, 100 * bytes_of_cache / bytes_of_file)])
    return "A recording of 10^8 rows in kerf studio against h5py and numpy", body
