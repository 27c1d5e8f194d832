# peers: python3-numpy
"""Z-widths of 50 simulated devices through the loop: against eigenvalues where they are linear, else against a bisected simulation."""

import json
import pathlib
import subprocess
import sys
import time

import numpy

from sections import replace_section

DEVICES = 50
RUNGS = 3
SEED = 28


def drawn(random, is_linear):
    """A device with a hand on it: options of sim:axis, and what its model is told beside them."""
    between = random.uniform
    device = {"mass": between(0.03, 0.4), "viscous": between(0.05, 1.0), "delay": between(0.0, 2e-3), "corner": between(20.0, 200.0),
              "hand_mass": between(0.05, 0.3), "hand_damping": between(1.0, 8.0), "grip": between(100.0, 600.0),
              "coulomb": 0.0 if is_linear else between(0.01, 0.1), "step": 0.0 if is_linear else between(2e-6, 2e-5)}
    units = {"mass": "kg", "viscous": "Ns/m", "delay": "s", "corner": "Hz", "hand_mass": "kg", "hand_damping": "Ns/m", "grip": "N/m",
             "coulomb": "N", "step": "m"}
    uri = "sim:axis?noise=off&limit=40N&slew=100000N/s&" + "&".join(
        "%s=%.9g%s" % (key, value, units[key]) for key, value in device.items() if not (key == "step" and is_linear))
    uri += "&encoder=off" if is_linear else ""
    told = ["--delay", device["delay"], "--filter", 2 * numpy.pi * device["corner"], "--hand-mass", device["hand_mass"],
            "--hand-damping", device["hand_damping"], "--hand-stiffness", device["grip"], "--mass", device["mass"],
            "--viscous", device["viscous"], "--coulomb", device["coulomb"], "--encoder", device["step"]]
    most = 0.5 * (device["viscous"] + device["hand_damping"])
    return uri, ["%.9g" % it if not isinstance(it, str) else it for it in told], most


def searched(program, uri, told, most):
    result = subprocess.run(
        [program, "stability", "--z-width", "--device", uri, *told, "--damping", "0", "%.9g" % most, "--rungs", str(RUNGS),
         "--stiffness", "20", "50000", "--json"], check=True, capture_output=True, text=True)
    return json.loads(result.stdout)


def main():
    house = pathlib.Path(sys.argv[1])
    program = str(house / "build/release/bin/kerf")
    random = numpy.random.default_rng(SEED)
    lines = ["| devices | against | walls | mean of the quotient | spread (rms) | furthest off | within 5 % | trials a wall |", "|---|---|---|---|---|---|---|---|"]
    begin = time.perf_counter()
    for is_linear, against in ((True, "eigenvalues"), (False, "bisected simulation")):
        quotients, trials, not_found = [], [], 0
        for _ in range(DEVICES // 2):
            found = searched(program, *drawn(random, is_linear))
            for rung in found["ladder"]:
                trials.append(rung["trials"])
                if rung["end"] != "found":
                    not_found += 1
                    continue
                quotients.append(rung["K"] / rung["model"])
        quotients = numpy.array(quotients)
        lines.append("| %d, %s | %s | %d (%d beyond the search) | %.4f | %.4f | %.1f %% | %d of %d | %.0f |" % (
            DEVICES // 2, "linear" if is_linear else "with Coulomb friction and encoder", against, len(quotients), not_found,
            quotients.mean(), quotients.std(), 100 * abs(quotients - 1).max(), int((abs(quotients - 1) < 0.05).sum()),
            len(quotients), numpy.mean(trials)))
    lines += ["", "`sim:axis`, mass 0.03 to 0.4 kg, friction 0.05 to 1 N·s/m, delay 0 to 2 ms, filter 20 to 200 Hz, in hands of 0.05 to 0.3 kg, 1 to 8 N·s/m "
              "and 100 to 600 N/m, at three dampings from 0 to half of the damping of device and hand; Coulomb friction 0.01 to 0.1 N and steps of 2 to "
              "20 um where there are any. The bisected simulation is the same search, strike for strike, on a simulation of its own: equal boundaries say "
              "that the loop adds nothing, not that another search would find them. %.0f s in all, the simulations of the models included." % (time.perf_counter() - begin)]
    body = "\n".join(lines)
    print(body)
    replace_section(house / "docs/benchmarks.md", "zwidth", "Z-widths of %d simulated devices" % DEVICES, body)


if __name__ == "__main__":
    main()
