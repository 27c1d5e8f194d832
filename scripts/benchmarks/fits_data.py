"""Measured data of other labs, imported by the program and read back by h5py: what a fit and its peers both see."""

import csv
import subprocess

import h5py
import numpy

VHB = "time=时间,position=位移,force=3"
PUNCH = "time=5[ms],position=4[deg],force=2[gf]"
SPINDLE = "time=1[s],position=2[0.0439453125 deg],force=3[-3.9811e-5 Nm]"
AT_ZERO = ["--contact", "0", "--direction", "increasing"]

# Name, file, columns, where contact is.
RECORDINGS = [
    ("VHB, relaxation at 4", "vhb/relaxation_4d0.csv", VHB, AT_ZERO),
    ("VHB, relaxation at 5", "vhb/relaxation_5d0.csv", VHB, AT_ZERO),
    ("VHB, cycle", "vhb/cycle_0d03_1d5_gbk.csv", "time=1[s],position=2[mm],force=3[N]", AT_ZERO),
    ("tendon, relaxation", "tendon/relaxation_fresh_1.csv", "time=Time,position=Extension,force=Load", AT_ZERO),
    ("punch, blank, slow", "meniscus/7_blank_slow_1819.txt", PUNCH, []),
    ("punch, blank, fast", "meniscus/8_blank_fast_1821.txt", PUNCH, []),
    ("punch, meniscus, slow", "meniscus/9_meniscus_slow_1824.txt", PUNCH, []),
    ("punch, meniscus, fast", "meniscus/11_meniscus_fast_1826.txt", PUNCH, []),
    ("punch, tendon, fast", "meniscus/14_quadriceps_tendon_fast_1853.txt", PUNCH, []),
    ("punch, skin, slow", "meniscus/15_skin_knee_lateral_slow_1900.txt", PUNCH, []),
    ("punch, skin, fast", "meniscus/16_skin_knee_lateral_fast_1904.txt", PUNCH, []),
    ("grasper, 0.1 Hz", "grasper/Tool_4_Maryland_L_2_00.TXT", SPINDLE, AT_ZERO),
    ("grasper, 0.4 Hz", "grasper/Tool_4_Maryland_L_2_33.TXT", SPINDLE, AT_ZERO),
]
LIVER = "liver/pig_liver_20150826_region1.csv"
LEAST_PEAK_N = 0.3  # of a site at which the ball more than touches
TOUCHING_M = 1e-9   # the first row of a site touches


def find(house, name, folder=None):
    """The file in the folder given, in data/ of this clone, or beside the clone; None where it is in neither."""
    for place in ([folder] if folder else [house / "data", house.parent / "shared/data"]):
        if (place / name).exists():
            return place / name
    return None


def imported(program, source, columns, target):
    subprocess.run([program, "import", str(source), "--map", columns, "-o", str(target)], check=True, capture_output=True)
    return target


class Series:
    """One axis as a law sees it; penetration grows into the tissue."""

    def __init__(self, path, contact):
        with h5py.File(path) as file:
            read = lambda name: file["samples"][name][()].reshape(len(file["samples/time"]), -1)[:, 0]
            direction = contact["direction"]
            self.time = read("time")
            self.x = direction * (read("position") - contact["position"])
            self.v = direction * read("velocity")
            self.force = read("force_measured")
        self.dt = numpy.diff(self.time, prepend=2.0 * self.time[0] - self.time[1])
        # Equal but for the digits of the time stamps is equal.
        self.uniform = bool(numpy.ptp(self.dt) < 1e-6 * self.dt.min())
        self.dt = numpy.full_like(self.dt, self.dt[1:].mean()) if self.uniform else self.dt

    def __len__(self):
        return len(self.time)


def liver_sites(source, folder):
    """A text of each site at which something is felt, one row a second: no law of speed is asked."""
    sites = {}
    with open(source, newline="") as file:
        for row in csv.DictReader(file):
            sites.setdefault(int(row["site"]), []).append((row["depth_mm"], row["normal_force_N"]))
    paths = []
    for number, rows in sites.items():
        if max(float(force) for _, force in rows) <= LEAST_PEAK_N:
            continue
        paths.append(folder / ("site_%03d.csv" % number))
        paths[-1].write_text("time [s],depth [mm],force [N]\n" +
                             "".join("%d,%s,%s\n" % (i, *row) for i, row in enumerate(rows)))
    return paths
