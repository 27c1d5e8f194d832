# peers:
# targets: kerf_reader_benchmark
"""Reading files in a process of their own against reading them within one, by turns; and files that were damaged.

scripts/benchmark reader [--damaged 100000] [--seed 1]
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

from sections import replace_section

parser = argparse.ArgumentParser()
parser.add_argument("house", type=pathlib.Path)
parser.add_argument("--damaged", type=int, default=100_000)
parser.add_argument("--seed", type=int, default=1)
arguments = parser.parse_args()
program = arguments.house / "build/release/bin/kerf_reader_benchmark"
with tempfile.TemporaryDirectory() as folder:
    run = subprocess.run([str(program), folder, str(arguments.damaged), str(arguments.seed)], stdout=subprocess.PIPE, text=True)
    if run.returncode != 0:
        sys.exit("%s ended with %d: a damaged file ended the program that had it read" % (program.name, run.returncode))
*compared, damaged = json.loads(run.stdout)
lines = ["| rows | apart [ms] | within [ms] | more [ms] | ratio |", "|---|---|---|---|---|"]
for one in compared:
    lines.append("| {:,} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |".format(
        one["rows"], one["apart_ms"], one["here_ms"], one["apart_ms"] - one["here_ms"], one["apart_ms"] / one["here_ms"]))
lines += ["", "Medians of recordings of two axes: by `kerf-reader`, started for it, and by the same code within one process.", "",
          "{:,} files (seeds {} to {}) damaged at random, recordings as a recorder and as an import write them, sessions and stored "
          "forces by turns: {:,} refused in one line, the others read; the reader fell over {} times, the program never.".format(
              damaged["damaged"], arguments.seed, arguments.seed + arguments.damaged - 1, damaged["refused"],
              damaged["readers_that_fell_over"])]
replace_section(arguments.house / "docs/benchmarks.md", "reader", "Reading apart", "\n".join(lines))
