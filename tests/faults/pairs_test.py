#!/usr/bin/python3
"""Every pair of quick verbs that can want one output, once, and readers beside every writer of a recording.

    pairs_test.py KERF EXAMPLES [--seed S]
"""

import argparse
import sys
import tempfile
from pathlib import Path

from pairs import pairs, try_pair, try_readers
from verbs import VERBS, Bench

MOST_SECONDS = 0.3  # what takes longer is left to scripts/benchmark pairs


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("kerf", type=Path)
    parser.add_argument("examples", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    faults = []
    tried = pairs(MOST_SECONDS)
    writers = [verb for verb in VERBS if verb.seconds <= MOST_SECONDS and verb.outputs[0].endswith(".h5")]
    with tempfile.TemporaryDirectory(prefix="kerf-pairs-") as folder:
        bench = Bench(arguments.kerf, arguments.examples, Path(folder))
        faults += [f"{pair}: {wrong}" for pair in tried if (wrong := try_pair(bench, pair, arguments.seed))]
        faults += [f"readers beside {verb.name}: {wrong}" for verb in writers
                   if (wrong := try_readers(bench, verb, arguments.seed))]  # fmt: skip
    print("\n".join(faults))
    print(f"{len(tried)} pairs, {len(writers)} writers with readers: {len(faults)} did not hold (seed {arguments.seed})")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
