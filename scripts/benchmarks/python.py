# peers: python3-scipy
# targets: kerf_python kerf kerf-reader
"""The Python package against what a person would write without it, by turns in one run.

scripts/benchmark python [--rows 1000000] [--keep-document]
"""

import argparse
import gc
import math
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

from sections import replace_section

TURNS = 9
IMPORTS = 15

parser = argparse.ArgumentParser()
parser.add_argument("house", type=pathlib.Path)
parser.add_argument("--rows", type=int, default=1_000_000)
parser.add_argument("--keep-document", action="store_true", help="print alone: docs/benchmarks.md stays")
arguments = parser.parse_args()
build = arguments.house / "build/release"
sys.path.insert(0, str(build / "python"))

import h5py
import kerf
import numpy as np
import scipy.signal


def by_turns(clock, **ways):
    """Median seconds of each way; each is tried once before."""
    times = {name: [] for name in ways}
    for turn in range(TURNS + 1):
        for name, way in ways.items():
            gc.collect()
            begin = clock()
            way()
            if turn > 0:
                times[name].append(clock() - begin)
    return {name: statistics.median(of) for name, of in times.items()}


def import_ms():
    """What `import kerf` adds to NumPy's own import, and that."""
    found = {"kerf": [], "numpy": []}
    for _ in range(IMPORTS):
        told = subprocess.run([sys.executable, "-X", "importtime", "-c", "import numpy, kerf"], env={"PYTHONPATH": str(build / "python")},
                              capture_output=True, text=True, check=True).stderr
        for name, of in found.items():
            of.append(1e-3 * int(re.search(r"\|\s+(\d+) \| %s$" % name, told, re.M).group(1)))
    return {name: statistics.median(of) for name, of in found.items()}


def read_by_kerf(path):
    with kerf.Recording(path) as recording:
        names = {name.split(".")[0] for name in recording.columns if not name.startswith("channel.")}
        return {name: recording[name] for name in names}


def read_by_h5py(path):
    with h5py.File(path) as file:
        return {name: dataset[()] for name, dataset in file["samples"].items() if isinstance(dataset, h5py.Dataset)}


STIFFNESS, SERIES, DAMPING, PERIOD = 300.0, 900.0, 20.0, 1e-3


def kelvin_by_loop(depth):
    """Over the elements of an array, as it is written down first."""
    loss = math.exp(-PERIOD * SERIES / DAMPING)
    gain = DAMPING / PERIOD * (1.0 - loss)
    force = np.empty_like(depth)
    arm, last = 0.0, depth[0]
    for row in range(len(depth)):
        arm = loss * arm + gain * (depth[row] - last)
        last = depth[row]
        force[row] = STIFFNESS * depth[row] + arm
    return force


def kelvin_by_list(depth):
    """The quickest loop of Python that we know: over a list, which has to be made before."""
    loss = math.exp(-PERIOD * SERIES / DAMPING)
    gain = DAMPING / PERIOD * (1.0 - loss)
    arm, last, force = 0.0, depth[0], []
    for x in depth:
        arm = loss * arm + gain * (x - last)
        last = x
        force.append(STIFFNESS * x + arm)
    return force


def kelvin_by_scipy(depth):
    loss = math.exp(-PERIOD * SERIES / DAMPING)
    gain = DAMPING / PERIOD * (1.0 - loss)
    return STIFFNESS * depth + scipy.signal.lfilter([gain], [1.0, -loss], np.diff(depth, prepend=depth[0]))


def rendering(rows):
    law = kerf.Law("kelvin", {"parallel_stiffness": STIFFNESS, "series_stiffness": SERIES, "damping": DAMPING}, {"bilateral": True})
    moments = PERIOD * np.arange(rows)
    depth, speed = 0.005 * np.sin(7.0 * moments), 0.035 * np.cos(7.0 * moments)
    listed = depth.tolist()
    np.testing.assert_allclose(law.render(depth, speed, elapsed=PERIOD, resisting=True), kelvin_by_scipy(depth), rtol=1e-9, atol=1e-12)
    return by_turns(time.process_time, kerf=lambda: law.render(depth, speed, elapsed=PERIOD, resisting=True), scipy=lambda: kelvin_by_scipy(depth),
                    loop=lambda: kelvin_by_loop(depth), list=lambda: kelvin_by_list(listed))


def main():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "cut.h5")
        subprocess.run([build / "bin/kerf", "record", "--device", "sim:scissors", "--virtual", "--seconds", str(arguments.rows / 1000), "-o", path],
                       check=True, capture_output=True)
        ours, theirs = read_by_kerf(path), read_by_h5py(path)
        assert ours.keys() == theirs.keys() and all(ours[name].tobytes() == theirs[name].tobytes() for name in theirs)
        megabytes = sum(one.nbytes for one in theirs.values()) / 1e6
        del ours, theirs
        reading = by_turns(time.perf_counter, kerf=lambda: read_by_kerf(path), h5py=lambda: read_by_h5py(path))
        opening = by_turns(time.perf_counter, kerf=lambda: kerf.Recording(path).close())
    imports = import_ms()
    rendered = rendering(arguments.rows)
    rows = "{:,}".format(arguments.rows)
    lines = ["| what | kerf | peer | ratio | wanted |", "|---|---|---|---|---|",
             "| `import kerf` after NumPy | %.1f ms | NumPy itself %.1f ms | | at most 50 ms |" % (imports["kerf"], imports["numpy"]),
             "| open and read all of %s rows, two axes, %.0f MB | %.1f ms | h5py %.1f ms | %.2f | at most 1.2 |" % (
                 rows, megabytes, 1e3 * reading["kerf"], 1e3 * reading["h5py"], reading["kerf"] / reading["h5py"]),
             "| of that, to open it | %.1f ms | | | |" % (1e3 * opening["kerf"]),
             "| %s samples through Kelvin | %.2f ms | loop of Python %.0f ms | %.0f times as fast | 100 times |" % (
                 rows, 1e3 * rendered["kerf"], 1e3 * rendered["loop"], rendered["loop"] / rendered["kerf"]),
             "| the same | %.2f ms | loop over a list %.0f ms | %.0f times as fast | |" % (
                 1e3 * rendered["kerf"], 1e3 * rendered["list"], rendered["list"] / rendered["kerf"]),
             "| the same | %.2f ms | SciPy's `lfilter` %.2f ms | %.2f times as fast | once |" % (
                 1e3 * rendered["kerf"], 1e3 * rendered["scipy"], rendered["scipy"] / rendered["kerf"]),
             "", "Medians of %d turns (imports: %d); of renderings processor time, else by the clock on the wall, files in the page cache. Both readings gave the same bits, both filters the same forces to 1e-9." % (
                 TURNS, IMPORTS)]
    print("\n".join(lines))
    if not arguments.keep_document:
        replace_section(arguments.house / "docs/benchmarks.md", "python", "The Python package", "\n".join(lines))


main()
