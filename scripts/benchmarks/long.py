# peers:
# targets: kerf kerf_recording_benchmark
"""A recording of a day: how long it takes to end, and the memory of whatever goes through all its rows.

scripts/benchmark long [--rows 86400000] [--folder DIR]   (100 bytes a row, three times)
"""

import argparse
import os
import pathlib
import sys
import tempfile
import time

from sections import replace_section

parser = argparse.ArgumentParser()
parser.add_argument("house", type=pathlib.Path)
parser.add_argument("--rows", type=int, default=86_400_000)
parser.add_argument("--folder", type=pathlib.Path, help="where there is room for three such recordings")
arguments = parser.parse_args()
sys.path.insert(0, str(arguments.house / "tests/end_to_end"))
import long_recording  # noqa: E402


def record(kerf, folder):
    """What it costs, and how long it takes from the end of the thread that writes rows to that of the program."""
    seen = []

    def look(process):
        try:
            seen.append((len(os.listdir("/proc/%d/task" % process.pid)), time.monotonic()))
        except FileNotFoundError:
            pass

    cost = long_recording.run(long_recording.record_command(kerf, "day.h5", arguments.rows), folder, while_it_runs=look)
    most = max(threads for threads, _ in seen)
    return cost, time.monotonic() - max(at for threads, at in seen if threads == most)


def look_at_all(kerf, viewer, folder):
    costs = {verb: long_recording.run([kerf, *words], folder) for verb, words in long_recording.looks("day.h5").items()}
    costs["repair"] = long_recording.repair(kerf, arguments.rows, folder)
    for what in ("the page, first view", "the page, again"):
        costs[what] = long_recording.run([viewer, "open", "day.h5", "cache"], folder)
    return costs


kerf = arguments.house / "build/release/bin/kerf"
viewer = arguments.house / "build/release/bin/kerf_recording_benchmark"
with tempfile.TemporaryDirectory(dir=arguments.folder) as name:
    folder = pathlib.Path(name)
    recording, ending = record(kerf, folder)
    size = (folder / "day.h5").stat().st_size
    costs = {"record, in virtual time": recording} | look_at_all(kerf, viewer, folder)
lines = ["A recording of `sim:scissors` at 1 kHz with {:,} rows ({:.1f} h, {:.2f} GB), written in virtual time. From the last row to the end "
         "of the program: {:.1f} s, in which the disk takes what the system still holds.".format(
             arguments.rows, arguments.rows / 3.6e6, size / 1e9, ending),
         "", "| what | most memory [MB] | time [s] |", "|---|---|---|"]
lines += ["| {} | {:.0f} | {:.1f} |".format(what, cost.mebibytes * 1.048576, cost.seconds) for what, cost in costs.items()]
lines += ["", "Memory is the largest that the program, or `kerf-reader` for it, had in RAM; `segment` draws its charts, `report` is without "
          "fits, the page looks at the whole of three traces."]
replace_section(arguments.house / "docs/benchmarks.md", "long", "A day at once", "\n".join(lines))
