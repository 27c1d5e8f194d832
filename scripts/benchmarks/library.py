# peers: libbenchmark-dev
# targets: kerf_call_benchmark
"""What a call of libkerf costs over the step of the law itself, by turns in one run."""

import json
import pathlib
import subprocess
import sys

from sections import replace_section

REPETITIONS = 15
MOST_NS = 5.0
LAWS = ["kelvin", "exponential", "piecewise", "fuzzy_kelvin_3d"]


def medians(house):
    program = house / "build/release/bin/kerf_call_benchmark"
    command = [program, "--benchmark_format=json", "--benchmark_min_time=0.1",
               "--benchmark_repetitions=%d" % REPETITIONS, "--benchmark_enable_random_interleaving=true"]
    runs = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["benchmarks"]
    return {run["run_name"].split("/")[0]: run["cpu_time"] for run in runs if run.get("aggregate_name") == "median"}


def main():
    house = pathlib.Path(sys.argv[1])
    median = medians(house)
    lines = ["Medians of %d repetitions, interleaved at random, processor time of one call. Filtered: the host has no velocity." %
             REPETITIONS, "", "| law | step in C++ [ns] | by libkerf [ns] | difference [ns] | ratio | filtered [ns] |", "|---|---|---|---|---|---|"]
    missed = []
    for law in LAWS:
        step, call, filtered = (median["%s_%s" % (law, way)] for way in ("law", "library", "filtered"))
        lines.append("| %s | %.1f | %.1f | %.1f | %.2f | %.1f |" % (law, step, call, call - step, call / step, filtered))
        if call - step > MOST_NS:
            missed.append(law)
    lines += ["", "More than %g ns over the step: %s." % (MOST_NS, ", ".join(missed) if missed else "none")]
    replace_section(house / "docs/benchmarks.md", "library", "What a call of libkerf costs", "\n".join(lines))
    print("\n".join(lines))


main()
