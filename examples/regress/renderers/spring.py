#!/usr/bin/env python3
"""A renderer for kerf regress in Python: a wall that relaxes across x, and friction along y.

    e' = vx - e / tau,   fx = k (x - x0) + k2 e,   fy = mu k (x - x0) vy / 0.1

while x > x0, else nothing; forces are resisting. Reads the trajectory that it is given and writes a row a tick.
With --fault it renders as renderers do that have become wrong, for trying out what a suite finds.
"""

import argparse
import csv
import sys
import time

arguments = argparse.ArgumentParser()
arguments.add_argument("--in", dest="trajectory", required=True)
arguments.add_argument("--out", required=True)
arguments.add_argument("--fault", choices=["gain", "sign", "lost", "shift", "buzz", "nan", "hang"])
given = arguments.parse_args()
if given.fault == "hang":
    time.sleep(3600)

rows = []
lag, last = 0.0, 0.0
with open(given.trajectory, newline="") as file:
    for row in csv.DictReader(file):
        now, x, vx, vy = (float(row[name]) for name in ("time[s]", "x[m]", "vx[m/s]", "vy[m/s]"))
        period, last = now - last, now
        depth = x - 0.01
        if depth > 0.0:
            lag += period * (vx - lag / 0.05)
            rows.append([now, 400.0 * depth + 200.0 * lag, 100.0 * depth * vy / 0.1])
        else:
            lag = 0.0
            rows.append([now, 0.0, 0.0])

if given.fault == "gain":
    rows = [[now, 1.01 * fx, 1.01 * fy] for now, fx, fy in rows]
elif given.fault == "sign":
    rows = [[now, -fx, -fy] for now, fx, fy in rows]
elif given.fault == "lost":
    del rows[300]
elif given.fault == "shift":
    rows = [[row[0], *before[1:]] for row, before in zip(rows, rows[:1] + rows)]
elif given.fault == "buzz":
    rows = [[now, fx + 0.02 * (0.0, 1.0, 0.0, -1.0)[i % 4], fy] for i, (now, fx, fy) in enumerate(rows)]
elif given.fault == "nan":
    rows[300][1] = float("nan")

with open(given.out, "w") as file:
    file.write("# sign: resisting\ntime[s],fx[N],fy[N]\n")
    for row in rows:
        file.write(",".join(map(repr, row)) + "\n")
sys.exit(0)
