#!/usr/bin/python3
"""A share of what scripts/benchmark injection does: of each verb some calls and some allocations, drawn by a seed.

    injection_test.py calls|allocations KERF EXAMPLES LIBRARY_OF_CALLS LIBRARY_OF_ALLOCATIONS [--seed S]
"""

import argparse
import random
import sys
import tempfile
from pathlib import Path

from injection import KINDS, Injector, Tally, places_of_allocations
from verbs import VERBS, Bench

CALLS = 5  # of a verb
ALLOCATIONS = 4
MOST_SECONDS = 0.6  # what takes longer is left to the benchmark


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=["calls", "allocations"])
    parser.add_argument("files", nargs=4, type=Path)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    kerf, examples, calls, allocations = arguments.files
    drawn = random.Random(arguments.seed)
    tally = Tally()
    with tempfile.TemporaryDirectory(prefix="kerf-faults-") as folder:
        injector = Injector(Bench(kerf, examples, Path(folder)), calls, allocations)
        for verb in [verb for verb in VERBS if verb.seconds <= MOST_SECONDS]:
            count = injector.count_calls(verb)
            if arguments.what == "calls":
                every = [(kind, at, older) for kind in KINDS for at in range(1, count + 1) for older in {False, verb.can_force}]
                for call in drawn.sample(every, min(CALLS, len(every))):
                    injector.try_call(verb, *call, tally)
            else:
                count = injector.count_allocations(verb)
                # The first is before main().
                for at in [1, *drawn.sample(places_of_allocations(count, 1000, 1000, drawn), ALLOCATIONS)]:
                    injector.try_allocation(verb, at, tally)
    print("\n".join(tally.faults))
    print(f"{tally.tried} tried, {tally.failed} of them failed, {tally.by_library} of these in a library itself; "
          f"{len(tally.faults)} did not hold (seed {arguments.seed})")
    return 1 if tally.faults else 0


if __name__ == "__main__":
    sys.exit(main())
