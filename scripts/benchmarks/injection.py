# peers: python3-h5py
# targets: kerf kerf_faulty_calls kerf_faulty_allocations
"""Fails every call that writes, and some thousands of allocations, of every verb that writes; one at a time.

scripts/benchmark injection [--verbs NAME...] [--seed S] [--calls] [--allocations] [--seconds S]

With --seconds it goes on to the next verb after so many of calls and so many of allocations: what is tried is drawn by the seed.
"""

import argparse
import itertools
import pathlib
import random
import sys
import tempfile
import time

from sections import replace_section

MOST_CALLS = 400  # of a verb; of one that makes more, as many at even distances
FIRST = 1000  # allocations, and so many more on a logarithmic scale


def in_time(tries):
    """All of them in their order; or, in a drawn order, those for which there is time."""
    if arguments.seconds is None:
        yield from tries
        return
    begin = time.monotonic()
    for one in random.Random(arguments.seed).sample(tries, len(tries)):
        if time.monotonic() - begin > arguments.seconds:
            return
        yield one


def fail_calls(injector, verb, tally):
    count = injector.count_calls(verb)
    places = range(1, count + 1, 1 + count // MOST_CALLS)
    for call in in_time(list(itertools.product(injection.KINDS, places, sorted({False, verb.can_force})))):
        injector.try_call(verb, *call, tally)
    return count


def fail_allocations(injector, verb, tally):
    count = injector.count_allocations(verb)
    for at in in_time(injection.places_of_allocations(count, FIRST, FIRST, random.Random(arguments.seed))):
        injector.try_allocation(verb, at, tally)
    return count


def table(what, rows):
    lines = ["| verb | %s it makes | one fails | the verb fails | of these in a library itself | did not hold |" % what,
             "|---|---|---|---|---|---|"]
    lines += [f"| {name} | {count:,} | {tally.tried:,} | {tally.failed:,} | {tally.by_library} | {len(tally.faults)} |"
              for name, count, tally in rows]
    return "\n".join(lines)


def main():
    build = arguments.house / "build/release"
    libraries = [build / "tests/faults" / ("libkerf_faulty_%s.so" % name) for name in ("calls", "allocations")]
    both = arguments.calls == arguments.allocations
    calls, allocations = [], []
    with tempfile.TemporaryDirectory(prefix="kerf-faults-") as folder:
        bench = verbs.Bench(build / "bin/kerf", arguments.house / "examples", pathlib.Path(folder))
        injector = injection.Injector(bench, *libraries)
        for verb in [verb for verb in verbs.VERBS if not arguments.verbs or verb.name in arguments.verbs]:
            for rows, wanted, fail in ((calls, arguments.calls, fail_calls),
                                       (allocations, arguments.allocations, fail_allocations)):
                if not (both or wanted):
                    continue
                tally = injection.Tally()
                rows.append((verb.name, fail(injector, verb, tally), tally))
                print("%s: %d tried, %d did not hold" % (verb.name, tally.tried, len(tally.faults)), flush=True)
                print("".join("  %s\n" % fault for fault in tally.faults), end="", flush=True)
    parts = [table(what, rows) for what, rows in (("calls", calls), ("allocations", allocations)) if rows]
    share = "" if arguments.seconds is None else "Of these, as many as fit into %g s, in a drawn order. " % arguments.seconds
    body = ("Each call that writes fails in one run of its own (%s; + is: and all after it), and of allocations the first %s and "
            "as many more drawn on a logarithmic scale, seed %d. %s`tests/faults/injection.py` says what has to hold.\n\n" % (
                ", ".join(injection.KINDS), f"{FIRST:,}", arguments.seed, share)) + "\n\n".join(parts)
    if not arguments.verbs:
        replace_section(arguments.house / "docs/benchmarks.md", "injection", "Faults below files, and no memory", body)
    print(body)
    return 1 if any(tally.faults for _, _, tally in calls + allocations) else 0


parser = argparse.ArgumentParser()
parser.add_argument("house", type=pathlib.Path)
parser.add_argument("--verbs", nargs="*", default=[])
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--calls", action="store_true")
parser.add_argument("--allocations", action="store_true")
parser.add_argument("--seconds", type=float)
arguments = parser.parse_args()
sys.path.insert(0, str(arguments.house / "tests/faults"))
import injection  # noqa: E402
import verbs  # noqa: E402

sys.exit(main())
