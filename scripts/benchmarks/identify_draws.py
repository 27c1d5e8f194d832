"""Simulated axes of drawn truth, and what `kerf identify` finds of each: a row a draw in a file that grows, so that a study can go on where it ended."""

import hashlib
import json
import random
import subprocess
import threading
import time
from concurrent.futures import ThreadPoolExecutor

RIGHT = ("plain", "jitter", "motor constant", "saturation")
WRONG = ("backlash", "cogging", "a flexible link")
KEPT = ("mass", "viscous", "coulomb", "stiffness", "delay_s", "delay_jitter_s", "constant_force", "encoder_step", "motor_constant", "saturation",
        "largest_force", "domains", "frequency", "fits", "why_not", "missing", "validation_error", "problem")


def is_held(kind, number):
    """A sensor reads what a hand exerts, and a motor is to saturate where no hand takes the motion."""
    return {"motor constant": True, "saturation": False}.get(kind, number % 2 == 1)


def draw(kind, number):
    """Whether it is held, the truth of an axis in the units that `kerf identify` tells, and its URI."""
    draws = random.Random(1000 + number if kind == "plain" else "%s %d" % (kind, number))
    held = is_held(kind, number)
    device = {"mass": draws.uniform(0.05, 0.3), "viscous": draws.uniform(0.1, 2.0), "coulomb": draws.uniform(0.02, 0.3),
              "gravity": draws.uniform(-0.3, 0.3), "delay": 1e-3 * draws.uniform(0.0, 3.7), "step": 1e-6 * draws.uniform(2.0, 20.0)}
    units = {"mass": "kg", "viscous": "Ns/m", "coulomb": "N", "gravity": "N", "delay": "s", "step": "m", "hand_mass": "kg", "hand_damping": "Ns/m",
             "grip": "N/m", "jitter": "s", "motor_constant": "", "saturation": "N", "backlash": "m", "cogging": "N", "cogging_period": "m",
             "flexible": "N/m"}
    if held:
        device |= {"hand_mass": draws.uniform(0.1, 0.2), "hand_damping": draws.uniform(2.0, 8.0), "grip": draws.uniform(100.0, 600.0)}
    if kind == "jitter":  # far enough from none that no force would have to come before it was sent
        device |= {"jitter": 1e-6 * draws.uniform(30.0, 200.0), "delay": 1e-3 * draws.uniform(1.0, 3.7)}
    elif kind == "motor constant":
        device["motor_constant"] = draws.uniform(0.7, 1.3)
    elif kind == "saturation":
        device |= {"saturation": draws.uniform(0.5, 0.9), "coulomb": draws.uniform(0.02, 0.1)}
    elif kind == "backlash":
        device["backlash"] = 1e-3 * draws.uniform(0.1, 0.4)
    elif kind == "cogging":
        device |= {"cogging": draws.uniform(0.05, 0.2), "cogging_period": 1e-3 * draws.uniform(1.0, 4.0)}
    elif kind == "a flexible link":
        device["flexible"] = draws.uniform(1000.0, 5000.0)
    uri = "sim:axis?sensor=%s&tells=off&seed=%d" % ("on" if kind == "motor constant" else "off", number)
    uri += "".join("&%s=%.12g%s" % (key, value, units[key]) for key, value in device.items()) + ("" if held else "&hand=off")
    # Forces, mass and stiffness are told in commanded newtons.
    constant = device.get("motor_constant", 1.0)
    truth = {"mass": (device["mass"] + device.get("hand_mass", 0.0)) / constant,
             "viscous": (device["viscous"] + device.get("hand_damping", 0.0)) / constant,
             "coulomb": device["coulomb"] / constant, "constant_force": device["gravity"] / constant, "delay_s": device["delay"],
             "encoder_step": device["step"], "delay_jitter_s": device.get("jitter", 0.0)}
    if held:
        truth["stiffness"] = device["grip"] / constant
    for key in ("motor_constant", "saturation"):
        if key in device:
            truth[key] = device[key]
    return held, truth, uri


def identified(program, kind, number):
    """A row: what was drawn, and what was found of it; `found` is null where the program gave up."""
    held, truth, uri = draw(kind, number)
    out = subprocess.run([program, "identify", uri, "--json", "--seed", str(number + 1), "--held" if held else "--free", "--max-force", "2",
                          *(("--travel", "0.04") if kind == "saturation" else ())], capture_output=True, text=True)
    found = json.loads(out.stdout)["axes"][0] if out.returncode in (0, 1) and out.stdout else None
    return {"kind": kind, "number": number, "held": held, "truth": truth, "uri": uri, "error": out.stderr.strip() if found is None else "",
            "found": None if found is None else {key: found[key] for key in KEPT if key in found}}


def sources_of(house):
    """What the numbers depend on: rows of other sources are of another program."""
    digest = hashlib.sha256()
    for folder in ("fitting/device", "bench/analysis/identify", "drivers/src/simulated/drive"):
        for path in sorted((house / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def rows_of(path, sources, program, wanted, workers, seconds=1e9):
    """Rows of all (kind, number) wanted: those in the file, and the others, each added to it as it comes; none is begun after so many seconds."""
    end = time.monotonic() + seconds
    rows = {}
    if path.exists():
        for line in path.read_text().splitlines():
            try:
                row = json.loads(line)
            except ValueError:  # the end of a run that was cut off
                continue
            if row["sources"] == sources:
                rows[row["kind"], row["number"]] = row
    path.parent.mkdir(parents=True, exist_ok=True)
    lock = threading.Lock()

    def one(key):
        if time.monotonic() > end:
            return key, None
        row = {"sources": sources, **identified(program, *key)}
        with lock, path.open("a") as file:
            file.write(json.dumps(row) + "\n")
        return key, row

    with ThreadPoolExecutor(workers) as pool:
        rows.update(pool.map(one, [key for key in wanted if key not in rows]))
    return [rows[key] for key in wanted if rows[key] is not None]
