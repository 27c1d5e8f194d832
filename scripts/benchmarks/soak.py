# peers: rt-tests
# targets: kerf
"""A loop at 1 kHz by the wall clock for an hour, recorded: does its memory grow, and how late does it wake beside cyclictest?

Both at the same time, so that they meet the same machine: Kerf on the last processor, cyclictest on the first.
scripts/benchmark soak [SECONDS]
"""

import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from latencies import HEADS, Latencies, add_check, add_cyclictest, check_command, cyclictest_command
from sections import replace_section

WARM_SECONDS = 60  # until then a loop measures its floor and starts


def resident_kib(process):
    """Of a process that may just have ended: then none."""
    for line in pathlib.Path("/proc/%d/status" % process.pid).read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1])
    return None


def watch(process):
    """Its resident memory, once a second, until it ends: [(s, KiB)]."""
    seen = []
    begin = time.monotonic()
    while process.poll() is None:
        kib = resident_kib(process)
        if kib is not None:
            seen.append((time.monotonic() - begin, kib))
        time.sleep(1.0)
    return seen


def main():
    house = pathlib.Path(sys.argv[1])
    seconds = int(sys.argv[2]) if len(sys.argv) > 2 else 3600
    with tempfile.TemporaryDirectory(dir=house / "build") as name:
        folder = pathlib.Path(name)
        environment = dict(os.environ, XDG_CACHE_HOME=name)
        peer_process = subprocess.Popen(cyclictest_command(seconds, min(os.sched_getaffinity(0))), stdout=subprocess.PIPE, text=True)
        said = folder / "check.json"
        with said.open("w") as output:
            process = subprocess.Popen(check_command(house, folder / "kelvin.law.toml", folder / "loop.h5", seconds), stdout=output,
                                       env=environment)
            seen = watch(process)
        if process.returncode > 1:
            sys.exit("kerf check ended with %d" % process.returncode)
        kerf, peer = Latencies(), Latencies()
        add_check(json.loads(said.read_text()), kerf)
        add_cyclictest(peer_process.communicate()[0], peer)
        file_mib = (folder / "loop.h5").stat().st_size / 2**20
    warm = [point for point in seen if point[0] >= min(WARM_SECONDS, seen[-1][0] / 2) and point[0] < seconds]
    slope = statistics.linear_regression(*zip(*warm)).slope
    kib = [point[1] for point in warm]
    body = "\n".join([
        "`kerf check --record` of a Kelvin law on `sim:pose6?truth=on`, 43 channels, %s s without a pause; beside it cyclictest "
        "(`-m -p 80`), which does nothing, on the first processor. Both at SCHED_FIFO 80." % format(seconds, ","), "", HEADS,
        kerf.figures("Kerf"), peer.figures("cyclictest"), "",
        "- Later than a millisecond woke Kerf {} times, cyclictest {}.".format(kerf.later_than(1000), peer.later_than(1000)),
        "- Resident memory of Kerf, once a second from the second minute on: %.2f to %.2f MiB, by a straight line %+.2f MiB an hour; "
        "%.1f MiB at most with the end, where the recording (%.0f MiB) is closed and summed up." % (
            min(kib) / 1024, max(kib) / 1024, slope * 3600 / 1024, max(point[1] for point in seen) / 1024, file_mib)])
    print(body)
    replace_section(house / "docs/benchmarks.md", "soak", "An hour by the wall clock", body)


main()
