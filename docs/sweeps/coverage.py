#!/usr/bin/env python3
"""Recordings whose truth is known, and the sweep that asks how often intervals hold it: coverage.py KERF FOLDER

Each law is run along the motion of simulated scissors; its force is what a recording then has, without any noise: that is
added cell by cell, by the sweep. Of each law there are

    LAW.h5           100 Hz for 6 s
    LAW-coarse.h5    every fifth row, 20 Hz
    LAW-encoder.h5   positions rounded to 5 mrad, while the force is that of the true ones

and each law is fitted to the recording of another one too. Writes FOLDER/recordings, coverage.toml, and targets.toml, which
does the same without noise: what a fit finds there is what its intervals are to hold, and of LAW.h5 that is the truth.
"""

import pathlib
import subprocess
import sys

import h5py
import numpy

# The parameters that simulate a law: penetrations in rad, forces in N. `other`: whose recording it is fitted to besides.
LAWS = {
    "kelvin": dict(
        parameters="parallel_stiffness 5 N/rad; series_stiffness 8 N/rad; damping 1.6 N·s/rad", other="springpot"
    ),
    "maxwell": dict(
        parameters="parallel_stiffness 3 N/rad; stiffness [6] N/rad; relaxation_time [0.4] s",
        fidelity="arms = 1",
        option="arms=1",
        other="springpot",
    ),
    "springpot": dict(
        parameters="stiffness 2 N/rad; fractional_stiffness 6 N/rad; order 0.3 1", other="kelvin"
    ),
    "exponential": dict(
        parameters="amplitude 0.05 N; exponent 0.8 1; viscosity 0.3 N·s/rad", other="hunt_crossley"
    ),
    "hunt_crossley": dict(
        parameters="reference_force 0.4 N; reference_damping 0.1 N·s/rad; exponent 1.6 1",
        fidelity="reference_depth = 0.2",
        option="reference_depth=0.2",
        other="exponential",
    ),
    "friction": dict(
        parameters="offset 0.1 N; stiffness 4 N/rad; viscosity 0.3 N·s/rad; coulomb 0.6 N; presliding 0.02 rad",
        other="kelvin",
    ),
    "piecewise": dict(
        parameters="knot [0, 0.1, 0.25, 0.4] rad; closing [0, 0.3, 1.6, 2.4] N",
        fidelity="segments = 3",
        segments=3,
        other="exponential",
    ),
    "recording": dict(
        parameters="closing [0, 0.1, 0.4, 1.2, 2] N",
        fidelity="points = 5\nlast = 0.49358",
        option="points=5",
        other="exponential",
    ),
    "scissors_analytic": dict(
        parameters="pivot_torque 0.01 N·m; blade_friction 0.5 N; cutting_force 4 N",
        option="contact_angle=0.5",
        other="friction",
    ),
    "precontact": dict(parameters="stiffness 9 N/rad; width 0.15 rad", other="exponential"),
    "fracture": dict(
        parameters="amplitude 0.3 N; exponent 12 1; yield_energy 0.004 J; toughness 400 J/m²; width 0.001 m",
        unit="m",
        other="precontact-metres",
    ),
    "precontact-metres": dict(model="precontact", parameters="stiffness 180 N/m; width 0.0075 m", unit="m"),
    "fuzzy_rupture": dict(
        parameters="depth_centre [0.01] m; depth_width [0.005] m; speed_centre [0.02] m/s; speed_width [0.01] m/s;"
        " per_depth [100] N/m; per_speed [8] N·s/m; constant [0.2] N",
        fidelity="memberships = 1\nmost_depth = 0.03\nmost_speed = 0.1",
        unit="m",
        option="memberships=1",
        other="precontact-metres",
    ),
    "fuzzy_kelvin": dict(
        parameters="parallel_stiffness 100 N/m; series_stiffness 160 N/m; damping 32 N·s/m; depth_centre [0.01] m;"
        " depth_width [0.005] m; speed_centre [0.02] m/s; speed_width [0.01] m/s; per_depth [60] N/m;"
        " per_speed [8] N·s/m; constant [0.6] N",
        fidelity="memberships = 1\nmost_depth = 0.03\nmost_speed = 0.1",
        unit="m",
        option="memberships=1",
        other="fracture",
    ),
}
SEEDS = 1540
NOISE_N = 0.02
MUCH_NOISE_N = 0.1
METRES = 0.05  # a law that is one of lengths moves as far as the handle does at this lever [m/rad]


def law_file(name, law):
    unit = law.get("unit", "rad")
    lines = [
        f'model = "{law.get("model", name)}"\nposition_unit = "{unit}"\nforce_unit = "N"\n',
        f'[contact]\nposition = {{ value = 0, unit = "{unit}" }}\ndirection = "increasing"\n',
        "[parameters]",
    ]
    for parameter in law["parameters"].split("; "):
        key, rest = parameter.strip().split(" ", 1)
        value, unit = rest.rsplit(" ", 1)
        lines.append(f'{key} = {{ value = {value}, unit = "{unit}" }}')
    if "fidelity" in law:
        lines.append("\n[fidelity]\n" + law["fidelity"])
    return "\n".join(lines) + "\n"


def write_recording(kerf, file, unit, time, depth, speed, force):
    text = file.with_suffix(".csv")
    rows = numpy.column_stack([time, depth, speed, force])
    numpy.savetxt(text, rows, delimiter=",", header="time,depth,speed,force", comments="", fmt="%.10g")
    columns = f"time=time[s],position=depth[{unit}],velocity=speed[{unit}/s],force=force[N]"
    kerf("import", text, "--map", columns, "-o", file, "--force")
    text.unlink()


def simulate(kerf, folder, name, law):
    """The penetration of the motion through the law, and the three recordings of it."""
    unit = law.get("unit", "rad")
    scale = METRES if unit == "m" else 1
    with h5py.File(folder / "motion.h5") as motion:
        time = motion["samples/time"][:]
        angle = motion["samples/position"][:, 0]
        depth = scale * (angle.max() - angle)  # a recording without a contact begins at its least position
        speed = -scale * motion["samples/velocity"][:, 0]
    file = folder / f"{name}.law.toml"
    file.write_text(law_file(name, law))
    moved = folder / "moved.h5"
    write_recording(kerf, moved, unit, time, depth, speed, 0 * time)
    kerf("replay", moved, "--through", file, "-o", folder / "replayed", "--force")
    with h5py.File(folder / "replayed" / f"{name}.h5") as replayed:
        force = -replayed["samples/force_commanded"][:, 0]  # which pushes out
    step = 0.005 * scale
    write_recording(kerf, folder / f"{name}.h5", unit, time, depth, speed, force)
    write_recording(kerf, folder / f"{name}-coarse.h5", unit, time[::5], depth[::5], speed[::5], force[::5])
    write_recording(kerf, folder / f"{name}-encoder.h5", unit, time, numpy.round(depth / step) * step, speed, force)


def cells(name, law, recordings, noise, seeds):
    more = "".join(f"{key} = {law[key]}\n" for key in ["segments"] if key in law)
    if "option" in law:
        more += f'option = "{law["option"]}"\n'
    listed = ", ".join(f'"recordings/{one}.h5"' for one in recordings)
    return (
        f'[[cells]]\nlaw = "{name}"\nrecording = [{listed}]\nrows = "all"\nfolds = 0\n{more}noise = {noise}\n'
        f"seed = {seeds}\n\n"
    )


def main(program, folder):
    folder = pathlib.Path(folder).absolute()
    recordings = folder / "recordings"
    recordings.mkdir(parents=True, exist_ok=True)

    def kerf(*words):
        run = subprocess.run([program, *map(str, words)], capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f"kerf {' '.join(map(str, words))}: {run.stderr.strip()}")

    motion = recordings / "motion.h5"
    kerf("record", "--device", "sim:scissors?noise=off", "--virtual", "--seconds", 6, "--rate", 100, "-o", motion, "--force")
    sweep = 'version = 1\nverb = "fit"\nshards = 20\n\n'
    targets = 'version = 1\nverb = "fit"\nshards = 1\n\n'
    for name, law in LAWS.items():
        simulate(kerf, recordings, name, law)
        if "other" not in law:
            continue
        others = [name, f"{name}-coarse", f"{name}-encoder", law["other"]]
        seeds = f"{{ from = 1, to = {SEEDS} }}"
        sweep += cells(name, law, others, NOISE_N, seeds) + cells(name, law, [name], MUCH_NOISE_N, seeds)
        targets += cells(name, law, others, 0, 1)
    (folder / "coverage.toml").write_text(sweep)
    (folder / "targets.toml").write_text(targets)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
