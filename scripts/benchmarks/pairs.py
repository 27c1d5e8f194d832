# peers: python3-h5py
"""Every pair of verbs that can want one output, at once and again and again, each killed now and then; readers beside writers.

scripts/benchmark pairs [--seconds 60] [--seed S]
"""

import argparse
import itertools
import pathlib
import sys
import tempfile
import time

from sections import replace_section


def again_and_again(attempt):
    """So many seconds of it: how often, and what did not hold."""
    faults = []
    begin = time.monotonic()
    for turn in itertools.count():
        if time.monotonic() - begin > arguments.seconds:
            return turn, faults
        if wrong := attempt(arguments.seed + turn):
            faults.append("seed %d: %s" % (arguments.seed + turn, wrong))


def main():
    rows = []
    with tempfile.TemporaryDirectory(prefix="kerf-pairs-") as folder:
        bench = verbs.Bench(arguments.house / "build/release/bin/kerf", arguments.house / "examples", pathlib.Path(folder))
        attempts = [(str(pair), lambda seed, pair=pair: pairs.try_pair(bench, pair, seed)) for pair in pairs.pairs(float("inf"))]
        attempts += [("readers beside %s" % verb.name, lambda seed, verb=verb: pairs.try_readers(bench, verb, seed))
                     for verb in verbs.VERBS if verb.outputs[0].endswith(".h5")]
        for name, attempt in attempts:
            turns, faults = again_and_again(attempt)
            rows.append((name, turns, len(faults)))
            print("%s: %d times, %d did not hold" % rows[-1], flush=True)
            print("".join("  %s\n" % fault for fault in faults), end="", flush=True)
    body = "%g s each, killed by SIGKILL three times in ten. `tests/faults/pairs.py` says what has to hold.\n\n" % arguments.seconds
    body += "| at once | times | did not hold |\n|---|---|---|\n" + "".join("| %s | %d | %d |\n" % row for row in rows)
    replace_section(arguments.house / "docs/benchmarks.md", "pairs", "Two at once", body)
    print(body)
    return 1 if any(row[2] for row in rows) else 0


parser = argparse.ArgumentParser()
parser.add_argument("house", type=pathlib.Path)
parser.add_argument("--seconds", type=float, default=60.0)
parser.add_argument("--seed", type=int, default=1)
arguments = parser.parse_args()
sys.path.insert(0, str(arguments.house / "tests/faults"))
import pairs  # noqa: E402
import verbs  # noqa: E402

sys.exit(main())
