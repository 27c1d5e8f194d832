"""An hour of 6 axes at 1 kHz, looked at with Kerf and with h5py and numpy, by turns."""

import json
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

ROUNDS = 7
MOVES = 200

# What a user would write: read the column, take the smallest and the largest of as many stretches as there are pixels.
PEER = """
import json, random, sys, time
begin = time.perf_counter()
import h5py, numpy
COLUMNS = 1200
imported = time.perf_counter()
cpu = time.process_time()

def look(file, first, end):
    count = min(COLUMNS, end - first)
    edges = numpy.linspace(0, end - first, count + 1).astype(int)[:-1]
    seen = [file["samples/time"][first:end][edges]]
    for name in ("position", "velocity", "force_commanded"):
        values = file["samples/" + name][first:end, 0]
        seen.append((numpy.minimum.reduceat(values, edges), numpy.maximum.reduceat(values, edges)))
    return seen

with h5py.File(sys.argv[1], "r") as file:
    rows = file["samples/time"].shape[0]
    look(file, 0, rows)
    first_ms = 1e3 * (time.perf_counter() - imported)
    first_cpu_ms = 1e3 * (time.process_time() - cpu)
    random.seed(2)
    times = []
    for move in range(int(sys.argv[2])):
        width = max(1, int(rows * 10 ** (-5 * random.random())))
        first = int((rows - width) * random.random())
        start = time.perf_counter()
        look(file, first, first + width)
        times.append(1e3 * (time.perf_counter() - start))
times.sort()
print(json.dumps({"first_view_ms": first_ms, "first_view_cpu_ms": first_cpu_ms, "p50_ms": times[len(times) // 2], "p99_ms": times[len(times) * 99 // 100],
                  "max_ms": times[-1]}))
"""


def run(command):
    begin = time.perf_counter()
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(result.stderr)
    return dict(json.loads(result.stdout), process_ms=1e3 * (time.perf_counter() - begin))


def into_page_cache(file):
    with open(file, "rb") as stream:
        while stream.read(1 << 24):
            pass


def compare(program, folder):
    file = folder / "hour.h5"
    cache = folder / "cache"
    subprocess.run([program, "make", file], check=True)
    turns = {"first": [], "again": [], "moves": [], "peer": []}
    for _ in range(ROUNDS):
        into_page_cache(file)
        shutil.rmtree(cache, ignore_errors=True)
        turns["first"].append(run([program, "open", file, cache]))
        turns["peer"].append(run([sys.executable, "-c", PEER, file, MOVES // 4]))
        turns["again"].append(run([program, "open", file, cache]))
        turns["moves"].append(run([program, "move", file, cache, MOVES]))
    return turns, file.stat().st_size, sum(part.stat().st_size for part in cache.iterdir())


def measure(house):
    program = house / "build/release/bin/kerf_recording_benchmark"
    with tempfile.TemporaryDirectory() as name:
        turns, bytes_of_file, bytes_of_cache = compare(program, pathlib.Path(name))

    def median(turn, key):
        return statistics.median(result[key] for result in turns[turn])

    def row(what, kerf, peer):
        return "| %s | %.1f | %.1f | %.2g |" % (what, kerf, peer, kerf / peer)

    peer = median("peer", "first_view_ms")
    body = "\n".join([
        "An hour at 1 kHz, %d MB: 6 axes of position, velocity and force, 2 channels and the times of the loop, as a "
        "recording is written. Position, velocity and force of one axis in 1200 columns of smallest and largest, the file "
        "in the page cache. h5py reads the same columns and numpy decimates them, which is exact too. Medians of %d rounds "
        "by turns; moves are stretches of the hour down to 36 ms, %d a round (h5py: %d)." % (
            bytes_of_file / 1e6, ROUNDS, MOVES, MOVES // 4), "",
        "| what [ms] | Kerf | h5py and numpy | ratio |", "|---|---|---|---|",
        row("Open and see the whole hour, the first time ever", median("first", "first_view_ms"), peer),
        row("The same, processor time", median("first", "first_view_cpu_ms"), median("peer", "first_view_cpu_ms")),
        row("The same in a new process later", median("again", "first_view_ms"), peer),
        row("A move, median", median("moves", "p50_ms"), median("peer", "p50_ms")),
        row("A move, p99", median("moves", "p99_ms"), median("peer", "p99_ms")),
        row("A move, the slowest", median("moves", "max_ms"), median("peer", "max_ms")), "",
        "- Of the first time, %.0f ms go by before a trace is asked for: every text of the file is looked through for damage, "
        "and the times are read once. Of a later one, %.1f ms." % (
            median("first", "open_ms"), median("again", "open_ms")),
        "- The slowest first time of %d was %.0f ms, the slowest move of %d %.1f ms." % (
            ROUNDS, max(result["first_view_ms"] for result in turns["first"]), ROUNDS * MOVES,
            max(result["max_ms"] for result in turns["moves"])),
        "- Kept on the disk for the next time: %.1f MB, %.1f %% of the recording." % (
            bytes_of_cache / 1e6, 100 * bytes_of_cache / bytes_of_file)])
    return "An hour's recording in kerf studio against h5py and numpy", body
