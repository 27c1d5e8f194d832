#!/usr/bin/env python3
"""The renderer of spring.py, asked tick by tick by kerf regress: over its standard input and output, or over
the socket that it is given. It is started once a case, says what it answers, and gives a line for each line.
With --fault it renders as renderers do that have become wrong.
"""

import argparse
import json
import socket
import sys
import time

arguments = argparse.ArgumentParser()
arguments.add_argument("--socket")
arguments.add_argument("--fault", choices=["gain", "sign", "lost", "shift", "buzz", "nan", "hang"])
given = arguments.parse_args()

if given.socket:
    connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    connection.connect(given.socket)
    questions, answers = connection.makefile("r"), connection.makefile("w")
else:
    questions, answers = sys.stdin, sys.stdout


def say(text):
    answers.write(text + "\n")
    answers.flush()  # the next tick is asked for once this one is answered


hello = json.loads(questions.readline())
if hello["version"] != 1:
    sys.exit(f"lockstep.py speaks version 1 and not {hello['version']}")
column = {name: i for i, name in enumerate(hello["columns"])}
say(json.dumps({"hello": "kerf lockstep", "version": 1, "sign": "resisting", "rate_hz": hello["rate_hz"],
                "seed": hello["seed"], "columns": ["tick", "fx[N]", "fy[N]", "compute_time[s]"]}))

lag, last, before = 0.0, 0.0, (0.0, 0.0)
for line in questions:
    begin = time.perf_counter()
    values = line.split(",")
    tick = int(values[0])
    now, x, vx, vy = (float(values[column[name]]) for name in ("time[s]", "x[m]", "vx[m/s]", "vy[m/s]"))
    period, last = now - last, now
    depth = x - 0.01
    if depth > 0.0:
        lag += period * (vx - lag / 0.05)
        force = (400.0 * depth + 200.0 * lag, 100.0 * depth * vy / 0.1)
    else:
        lag = 0.0
        force = (0.0, 0.0)
    force, before = (before, force) if given.fault == "shift" else (force, force)
    fx, fy = force
    if given.fault == "gain":
        fx, fy = 1.01 * fx, 1.01 * fy
    elif given.fault == "sign":
        fx, fy = -fx, -fy
    elif given.fault == "buzz":
        fx += 0.02 * (0.0, 1.0, 0.0, -1.0)[tick % 4]
    elif tick == 300 and given.fault == "nan":
        fx = float("nan")
    elif tick == 300 and given.fault == "lost":
        continue
    elif tick == 300 and given.fault == "hang":
        time.sleep(3600)
    say(f"{tick},{fx!r},{fy!r},{time.perf_counter() - begin:.3g}")
