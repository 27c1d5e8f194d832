#!/usr/bin/env python3
"""Writes punch.txt: what a lab's logger would have written of simulated scissors that cut, untidiness included.

    examples/data/make_punch.py build/release/bin/kerf examples/data/punch.txt

The simulation is Kerf's own (`kerf record`, seed 11), and so are the noise and the steps of its force sensor. The logger takes
every third tick, counts milliseconds since power-up, forces in gram-force and the angle by a 12-bit potentiometer; it ends two
lines in a stray backslash and lost the end of another one. Needs Debian's python3-h5py. The same file each time.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

SECONDS = 14
POWER_UP_MS = 21317
EVERY = 3
GRAM_FORCE_N = 9.80665e-3
COUNTS_PER_DEG = 4096 / 270
DEG_PER_RAD = 57.29577951308232


def simulated_cut(kerf):
    """Time [s], angle [rad] and measured force [N] of every tick."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "cut.h5"
        subprocess.run([kerf, "record", "--device", "sim:scissors", "--virtual", "--seconds", str(SECONDS), "--seed", "11",
                        "-o", str(file)], check=True, capture_output=True)
        with h5py.File(file) as recording:
            samples = recording["samples"]
            return samples["time"][()], samples["position"][:, 0], samples["force_measured"][:, 0]


def logged(time_s, angle_rad, force_n):
    lines = ["# punch 3, force under the thumb, potentiometer at the hinge; simulated by Kerf, no measured data",
             "time [ms]\tforce [gf]\tpotentiometer [counts]\tangle [deg]"]
    for row in range(0, len(time_s), EVERY):
        counts = round(angle_rad[row] * DEG_PER_RAD * COUNTS_PER_DEG)
        lines.append(f"{POWER_UP_MS + round(1e3 * time_s[row])}\t{force_n[row] / GRAM_FORCE_N:.1f}\t{counts}\t"
                     f"{counts / COUNTS_PER_DEG:.3f}")
    lines[900] += "\t\\"
    lines[2700] += "\t\\"
    lines[1801] = lines[1801].split("\t")[0] + "\t1"
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    Path(sys.argv[2]).write_text(logged(*simulated_cut(sys.argv[1])))
