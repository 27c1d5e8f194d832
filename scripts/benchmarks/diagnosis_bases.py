"""Forces that are changed on purpose: laws of their own in NumPy, six axes, measured recordings."""

import pathlib

import numpy as np


class Base:
    """Positions (N x A), forces (N x D) and how they come about. Without a law forces are measured."""

    def __init__(self, name, rate_hz, units, position, law=None, parameters=None, force=None):
        self.name, self.rate_hz, self.units, self.position = name, rate_hz, units, position
        self.law, self.parameters = law, parameters
        self.force = law(position(np.arange(0, seconds_of(name), 1 / rate_hz)), 1 / rate_hz, **parameters) if law else force
        self.x = position(self.times(len(self.force))) if callable(position) else position

    def times(self, rows):
        return np.arange(rows) / self.rate_hz

    def rendered(self, warp=lambda t: t, rows=None, moved=lambda x: x, state=0.0, **other):
        """The law again, at other times of the same motion or elsewhere: positions and forces."""
        x = moved(self.position(warp(self.times(rows or len(self.force)))))
        return x, self.law(x, 1 / self.rate_hz, state=state, **{**self.parameters, **other})


def seconds_of(name):
    return 4.0


def minimum_jerk(share):
    s = np.clip(share, 0, 1)
    return s**3 * (10 - 15 * s + 6 * s**2)


def strokes(t, size, stroke_s, pause_s):
    """To and fro, a pause before each."""
    period = 2 * (stroke_s + pause_s)
    at = np.mod(np.maximum(t, 0), period)
    there = minimum_jerk((at - pause_s) / stroke_s)
    back = minimum_jerk((at - 2 * pause_s - stroke_s) / stroke_s)
    return size * (there - back)


def kelvin(x, dt, k1=300.0, k2=500.0, b=50.0, onset=0.004, state=0.0, forgets=-1):
    """A spring beside a spring and a dashpot in series, in contact alone, exact for straight lines."""
    depth = np.maximum(x[:, 0] - onset, 0)
    tau, arm, force = b / k2, state, np.zeros(len(x))
    kept = np.exp(-dt / tau)
    for i in range(len(x)):
        v = (depth[i] - depth[i - 1]) / dt if i else 0.0
        arm = 0.0 if i == forgets else arm
        arm = kept * arm + k2 * tau * (1 - kept) * v if depth[i] > 0 or arm > 0 else 0.0
        force[i] = max(0.0, k1 * depth[i] + arm) if depth[i] > 0 else 0.0
    return force[:, None]


def two_arms(x, dt, k1=200.0, k2=400.0, k3=250.0, tau2=0.03, tau3=0.4, state=0.0, forgets=-1):
    """A Maxwell-Wiechert solid that is always in contact."""
    arm2, arm3, force = state, 0.6 * state, np.zeros(len(x))
    kept2, kept3 = np.exp(-dt / tau2), np.exp(-dt / tau3)
    for i in range(len(x)):
        v = (x[i, 0] - x[i - 1, 0]) / dt if i else 0.0
        arm2, arm3 = (0.0, 0.0) if i == forgets else (arm2, arm3)
        arm2 = kept2 * arm2 + k2 * tau2 * (1 - kept2) * v
        arm3 = kept3 * arm3 + k3 * tau3 * (1 - kept3) * v
        force[i] = k1 * x[i, 0] + arm2 + arm3
    return force[:, None]


def exponential(x, dt, a=0.25, b=220.0, onset=0.003, state=0.0):
    return (a * (np.exp(b * np.maximum(x[:, 0] - onset, 0)) - 1))[:, None]


def hunt_crossley(x, dt, k=2.0e4, n=1.5, damping=30.0, onset=0.004, state=0.0):
    depth = np.maximum(x[:, 0] - onset, 0)
    v = np.gradient(x[:, 0], dt)
    return np.maximum(0, k * depth**n * (1 + damping * 1e-2 * v))[:, None]


def six_axes(x, dt, k=600.0, kr=0.6, b=2.0, friction=0.15, state=0.0):
    """A tool in a soft tube: springs that differ by axis, damping, friction, and torques with a coupling."""
    v = np.gradient(x, dt, axis=0)
    force = np.empty_like(x)
    force[:, :3] = -k * np.array([1.0, 0.7, 1.4]) * x[:, :3] - b * v[:, :3] - friction * np.tanh(v[:, :3] / 0.01)
    force[:, 3:] = -kr * np.array([0.8, 1.2, 0.5]) * x[:, 3:] - 0.004 * v[:, 3:] + 0.02 * np.cross(x[:, :3], force[:, :3]) / 0.02
    return force


def wander(seed):
    rng = np.random.default_rng(seed)
    hz, phase = rng.uniform(0.3, 2.2, (6, 3)), rng.uniform(0, 6.28, (6, 3))
    size = np.array([0.004] * 3 + [0.2] * 3)
    return lambda t: np.stack([size[a] * sum(np.sin(2 * np.pi * hz[a, i] * t + phase[a, i]) for i in range(3)) for a in range(6)], axis=1)


def along(size, stroke_s, pause_s):
    return lambda t: strokes(np.asarray(t), size, stroke_s, pause_s)[:, None]


def laws():
    for rate in (333.0, 1000.0):
        yield Base("kelvin", rate, ["N"], along(0.02, 0.4, 0.1), kelvin, {})
        yield Base("two arms", rate, ["N"], along(0.015, 0.35, 0.15), two_arms, {})
        yield Base("exponential", rate, ["N"], along(0.016, 0.5, 0.1), exponential, {})
        yield Base("Hunt-Crossley", rate, ["N"], along(0.018, 0.3, 0.1), hunt_crossley, {})
        yield Base("six axes", rate, ["N"] * 3 + ["N·m"] * 3, wander(int(rate)), six_axes, {})


def measured(shared):
    """What is there of the measured data: a punch by hand at 333 Hz, a grasper on a bench at 1 kHz."""
    for name, begin in (("9_meniscus_slow_1824.txt", 4000), ("11_meniscus_fast_1826.txt", 2000), ("8_blank_fast_1821.txt", 2000)):
        file = pathlib.Path(shared) / "meniscus" / name
        if file.exists():
            rows = [line.rstrip("\\\n} ").split("\t")[:5] for line in file.read_text(errors="replace").splitlines()]
            table = np.array([[float(cell) for cell in row] for row in rows if len(row) == 5 and all(row)])[begin:begin + 3000]
            yield Base(name.split("_1")[0], 333.0, ["N"], np.radians(table[:, 3:4]), force=table[:, 1:2] * 9.80665e-3)
    for name in ("Tool_4_Maryland_L_2_00.TXT", "Tool_4_Maryland_L_2_33.TXT"):
        file = pathlib.Path(shared) / "grasper" / name
        if file.exists():
            table = np.genfromtxt(file, delimiter=",", comments="%", max_rows=9000)[4000:8000]
            force = np.stack([table[:, 2], table[:, 5]], axis=1) * 3.9811e-5
            position = np.stack([table[:, 1] * 2 * np.pi / 8192, table[:, 4] * 2 * np.pi / 4000], axis=1)
            yield Base("grasper " + name[-6:-4], 1000.0, ["N·m"] * 2, position, force=force)


def made():
    """In place of measured data: strokes with the noise and the steps of a sensor."""
    for rate in (333.0, 1000.0):
        rng = np.random.default_rng(int(rate))
        law = Base("kelvin", rate, ["N"], along(0.02, 0.4, 0.1), kelvin, {})
        force = np.round((law.force + 0.02 * rng.standard_normal(law.force.shape)) / 0.005) * 0.005
        yield Base("made", rate, ["N"], law.x + 1e-5 * rng.standard_normal(law.x.shape), force=force)
