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

RUNS = 15
REPETITIONS = 5
MOST_NS = 5.0


def of_one_run(house):
    """The fastest repetition of each benchmark, by its name: what else the machine did is not the call's."""
    program = house / "build/release/bin/kerf_call_benchmark"
    command = [program, "--benchmark_format=json", "--benchmark_min_time=0.01",
               "--benchmark_repetitions=%d" % REPETITIONS, "--benchmark_enable_random_interleaving=true"]
    runs = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["benchmarks"]
    times = {}
    for run in runs:
        if run["run_type"] == "iteration":
            times.setdefault(run["run_name"].split("/")[0], []).append(run["cpu_time"])
    return {name: min(values) for name, values in times.items()}


def quartiles(house):
    """Of runs of the program: each has its stack and its memory elsewhere, which is worth up to 10 ns of a law of 200 ns."""
    times = {}
    for _ in range(RUNS):
        for name, time in of_one_run(house).items():
            times.setdefault(name, []).append(time)
    return {name: statistics.quantiles(values, n=4) for name, values in times.items()}


def main():
    house = pathlib.Path(sys.argv[1])
    found = quartiles(house)
    laws = sorted(name[:-len("_law")] for name in found if name.endswith("_law"))
    lines = ["Medians of %d runs of the program, of each the fastest of %d repetitions, interleaved at random; processor time of one call; +- half of what lies"
             " between the quartiles of runs, whose memory lies elsewhere each time. Filtered: the host has no velocity." % (RUNS, REPETITIONS), "",
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
