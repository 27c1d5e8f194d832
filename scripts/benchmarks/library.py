# peers: libbenchmark-dev
# targets: kerf_call_benchmark
"""What a call of libkerf costs over the step of the law itself, by turns in one run."""

import json
import math
import pathlib
import statistics
import subprocess
import sys

from sections import replace_section

REPETITIONS = 15
MOST_NS = 5.0


def quartiles(house):
    """Of the repetitions of each benchmark, by its name."""
    program = house / "build/release/bin/kerf_call_benchmark"
    command = [program, "--benchmark_format=json", "--benchmark_min_time=0.05",
               "--benchmark_repetitions=%d" % REPETITIONS, "--benchmark_enable_random_interleaving=true"]
    runs = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["benchmarks"]
    times = {}
    for run in runs:
        if run["run_type"] == "iteration":
            times.setdefault(run["run_name"].split("/")[0], []).append(run["cpu_time"])
    return {name: statistics.quantiles(values, n=4) for name, values in times.items()}


def main():
    house = pathlib.Path(sys.argv[1])
    found = quartiles(house)
    laws = sorted(name[:-len("_law")] for name in found if name.endswith("_law"))
    lines = ["Medians of %d repetitions, interleaved at random, processor time of one call; +- half of what lies between the quartiles. Filtered: the host has"
             " no velocity." % REPETITIONS, "",
             "| law | step in C++ [ns] | by libkerf [ns] | difference [ns] | filtered [ns] |", "|---|---|---|---|---|"]
    missed = []
    for law in laws:
        step, call, filtered = (found["%s_%s" % (law, way)][1] for way in ("law", "library", "filtered"))
        spread = math.hypot(*((found[name][2] - found[name][0]) / 2 for name in (law + "_law", law + "_library")))
        lines.append("| %s | %.1f | %.1f | %.1f +- %.1f | %.1f |" % (law, step, call, call - step, spread, filtered))
        if call - step > MOST_NS + spread:
            missed.append(law)
    lines += ["", "More than %g ns over the step: %s." % (MOST_NS, ", ".join(missed) if missed else "none")]
    replace_section(house / "docs/benchmarks.md", "library", "What a call of libkerf costs", "\n".join(lines))
    print("\n".join(lines))


main()
