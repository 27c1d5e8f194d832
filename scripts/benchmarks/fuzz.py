# peers:
# targets: kerf-reader
"""Ten million inputs, and what each fuzzer made of its share.

scripts/benchmark fuzz [--inputs 10000000] [--counts NAME=INPUTS...] [--seed S]

With --counts only these fuzzers run, and nothing is written into the document.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from sections import replace_section

# What is slow, because it builds much of each input, reads files from the disk or starts a process, gets so much of what the
# others get: all take minutes then.
SHARES = {"calibration": 0.3, "http": 0.1, "journal": 0.1, "law": 0.1, "scene": 0.1, "suite": 0.1, "import": 0.05, "protocol": 0.03,
          "command_line": 0.01, "hdf5": 0.005, "hdf5_bytes": 0.001, "session": 0.002}


def fuzzers():
    made = subprocess.run(["ninja", "-C", str(build), "-t", "query", "tests/fuzz/kerf_fuzzers"], capture_output=True, text=True,
                          check=True)
    return sorted(set(re.findall(r"\bkerf_(\w+)_fuzz\b", made.stdout)))


def shared_out(names):
    whole = sum(SHARES.get(name, 1.0) for name in names)
    return {name: round(arguments.inputs * SHARES.get(name, 1.0) / whole) for name in names}


def words_of(name):
    dictionary = corpus / (name + ".dict")
    return ["-dict=%s" % dictionary] if dictionary.exists() else []


def fuzz(name, inputs):
    """Seconds, and how many inputs were tried until the first fault; its line if there was one."""
    with tempfile.TemporaryDirectory() as found:
        begin = time.monotonic()
        run = subprocess.run([str(build / "bin" / ("kerf_%s_fuzz" % name)), "-seed=%d" % arguments.seed, "-runs=%d" % inputs,
                              "-print_final_stats=1", *words_of(name), "-artifact_prefix=%s/%s-" % (kept, name), found,
                              str(corpus / name)], stderr=subprocess.PIPE, text=True, errors="replace")
        seconds = time.monotonic() - begin
    if run.returncode != 0:
        print(run.stderr[-3000:], file=sys.stderr)
    tried = re.search(r"stat::number_of_executed_units: *(\d+)", run.stderr)
    return seconds, int(tried.group(1)) if tried else 0, run.returncode != 0


def main():
    kept.mkdir(parents=True, exist_ok=True)
    counts = dict(given.split("=") for given in arguments.counts) or shared_out(fuzzers())
    rows = []
    for name, inputs in counts.items():
        seconds, tried, fell = fuzz(name, int(inputs))
        rows.append((name, tried, tried / seconds, fell))
        print("%s: %d inputs in %.0f s%s" % (name, tried, seconds, ", a fault" if fell else ""), flush=True)
    lines = ["| what is fuzzed | inputs | a second | faults |", "|---|---|---|---|"]
    lines += ["| %s | %s | %s | %d |" % (name, f"{tried:,}", f"{rate:,.0f}", fell) for name, tried, rate, fell in rows]
    lines += ["", "%s inputs with the seed %d, by Clang's libFuzzer, with the address and the undefined-behaviour sanitizer; from the "
              "inputs that are stored. `tests/fuzz` says what has to hold." % (f"{sum(row[1] for row in rows):,}", arguments.seed)]
    if not arguments.counts:
        replace_section(arguments.house / "docs/benchmarks.md", "fuzz", "Inputs that nobody meant", "\n".join(lines))
    print("\n".join(lines))
    return 1 if any(row[3] for row in rows) else 0


parser = argparse.ArgumentParser()
parser.add_argument("house", type=pathlib.Path)
parser.add_argument("--inputs", type=int, default=10_000_000)
parser.add_argument("--counts", nargs="*", default=[])
parser.add_argument("--seed", type=int, default=1)
arguments = parser.parse_args()
build = arguments.house / "build/dev"
corpus = arguments.house / "tests/fuzz/corpus"
kept = arguments.house / "build/fuzz"
subprocess.run([str(arguments.house / "scripts/build"), "dev", "--target", "kerf_fuzzers"], check=True)
sys.exit(main())
