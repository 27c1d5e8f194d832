# peers:
# targets: kerf_fault_benchmark
"""A million random fault schedules in virtual time, held to the promises of docs/safety.md.

scripts/benchmark faults [--first SEED] [--count 1000000]
"""

import argparse
import json
import pathlib
import subprocess
import sys

from sections import replace_section

parser = argparse.ArgumentParser()
parser.add_argument("house", type=pathlib.Path)
parser.add_argument("--first", type=int, default=1)
parser.add_argument("--count", type=int, default=1_000_000)
arguments = parser.parse_args()
program = arguments.house / "build/release/bin/kerf_fault_benchmark"
run = subprocess.run([str(program), str(arguments.house / "examples"), str(arguments.first), str(arguments.count)],
                     stdout=subprocess.PIPE, text=True)
lines = run.stdout.strip().split("\n")
for violation in lines[:-1]:
    print(violation, file=sys.stderr)
result = json.loads(lines[-1])
replace_section(
    arguments.house / "docs/benchmarks.md", "faults", "Random faults",
    "{:,} schedules (seeds {} to {}), {:,} ticks, {:,} of them with a force: {} violations of the promises of "
    "[safety.md](safety.md).".format(result["schedules"], arguments.first, arguments.first + arguments.count - 1,
                                     result["ticks"], result["with_force"], result["violations"]))
sys.exit(run.returncode)
