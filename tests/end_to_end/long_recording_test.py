#!/usr/bin/python3
"""A long recording takes no more memory than a short one: to record, and for every verb that looks at all of it.

    long_recording_test.py KERF

Compares recordings of which one has 1.6 million rows more: held at once, these alone are more than what is allowed.
"""

import sys
import tempfile
from pathlib import Path

from long_recording import looks, record_command, repair, run

SHORT_ROWS = 100_000
LONG_ROWS = 1_700_000
# A column of numbers, were it kept, takes 12 MiB more for the long one; all of them 156 MiB. What grows by right are chunks that
# HDF5 keeps an index of, and cycles.
MOST_MORE_MEBIBYTES = 10.0


def costs(kerf: Path, folder: Path, rows: int) -> dict[str, float]:
    found = {"record": run(record_command(kerf, "r.h5", rows), folder).mebibytes}
    for verb, arguments in looks("r.h5").items():
        found[verb] = run([kerf, *arguments], folder).mebibytes
    found["convert"] = run([kerf, "convert", "r.h5", "-o", "r.mcap"], folder).mebibytes
    found["repair"] = repair(kerf, rows, folder).mebibytes
    return found


def main() -> int:
    kerf = Path(sys.argv[1]).resolve()
    taken = []
    for rows in (SHORT_ROWS, LONG_ROWS):
        with tempfile.TemporaryDirectory(prefix="kerf-long-") as folder:
            taken.append(costs(kerf, Path(folder), rows))
    short, long = taken
    faults = [verb for verb in short if long[verb] - short[verb] > MOST_MORE_MEBIBYTES]
    for verb in short:
        print(f"{verb}: {short[verb]:.0f} MiB at {SHORT_ROWS} rows, {long[verb]:.0f} at {LONG_ROWS}", "  TOO MUCH" * (verb in faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
