"""Changes that are made to forces, and whether another change makes the same difference: both without Kerf."""

import numpy as np
from scipy import linalg, optimize

BOUND = 0.05


def one_axis(base, rng):
    return int(rng.integers(base.force.shape[1]))


def scaled(base, rng, factor, axis=None):
    got = base.force.copy()
    axes = slice(None) if axis is None else [axis]
    got[:, axes] *= factor
    return base.x, got


def sign(base, rng):
    return scaled(base, rng, -1.0, one_axis(base, rng))


def unit(base, rng):
    factor = rng.choice([180 / np.pi, np.pi / 180, 1000.0, 1e-3, 9.80665e-3, 1 / 9.80665e-3])
    return scaled(base, rng, factor, one_axis(base, rng))


def gain(base, rng):
    return scaled(base, rng, rng.choice([rng.uniform(0.4, 0.99), rng.uniform(1.01, 2.5)]), rng.choice([None, one_axis(base, rng)]))


def offset(base, rng):
    got = base.force.copy()
    axis = one_axis(base, rng)
    got[:, axis] += rng.choice([-1, 1]) * rng.uniform(0.01, 0.3) * np.abs(got[:, axis]).max()
    return base.x, got


def drift(base, rng):
    got = base.force.copy()
    axis = one_axis(base, rng)
    got[:, axis] += np.linspace(0, rng.choice([-1, 1]) * rng.uniform(0.02, 0.4), len(got)) * np.abs(got[:, axis]).max()
    return base.x, got


def axes(base, rng):
    """Two forces or two torques swapped, or three in turn; now and then with another sign."""
    got = base.force.copy()
    first = 0 if rng.random() < 0.5 else 3
    order = rng.choice([[1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]])
    signs = rng.choice([1, 1, -1], 3)
    got[:, first:first + 3] = base.force[:, first + np.array(order)] * signs
    return base.x, got


def rotation(base, rng):
    got = base.force.copy()
    axis = rng.standard_normal(3)
    cross = np.cross(np.eye(3), axis / np.linalg.norm(axis))
    turn = linalg.expm(np.radians(rng.uniform(1, 60)) * cross)
    got[:, :3] = base.force[:, :3] @ turn.T
    return base.x, got


def shifted(force, ticks, way):
    """By straight lines, by a spline, or by the phases of its spectrum."""
    at = np.arange(len(force)) - ticks
    if way == "lines":
        return np.stack([np.interp(at, np.arange(len(force)), column) for column in force.T], axis=1)
    if way == "cubic":
        inside = np.clip(at, 1, len(force) - 3)
        row = np.floor(inside).astype(int)
        s = (inside - row)[:, None]
        a, b, c, d = (force[row + k] for k in (-1, 0, 1, 2))
        return (-s * (s - 1) * (s - 2) / 6 * a + (s + 1) * (s - 1) * (s - 2) / 2 * b - (s + 1) * s * (s - 2) / 2 * c + (s + 1) * s * (s - 1) / 6 * d)
    filled = np.concatenate([force, force[::-1]])
    phases = np.exp(-2j * np.pi * np.fft.rfftfreq(len(filled)) * ticks)
    return np.fft.irfft(np.fft.rfft(filled, axis=0) * phases[:, None], len(filled), axis=0)[:len(force)]


def lag(base, rng):
    """Whole ticks, or fractions: a law is asked for its force of a moment ago, what was measured is shifted."""
    ticks = rng.choice([float(rng.integers(1, 30)), -float(rng.integers(1, 10)), rng.uniform(0.1, 6)])
    if ticks == int(ticks):
        return base.x, shifted(base.force, ticks, "lines")
    if base.law:
        return base.x, base.rendered(lambda t: t - ticks / base.rate_hz)[1]
    return base.x, shifted(base.force, ticks, rng.choice(["lines", "cubic", "phases"]))


def lost(base, rng):
    rows = np.sort(rng.choice(np.arange(50, len(base.force) - 50), rng.choice([1, 1, 2, 5]), replace=False))
    keep = np.ones(len(base.force), bool)
    for row in rows:
        keep[row:row + rng.choice([1, 1, 1, 4])] = False
    return base.x[keep], base.force[keep]


def doubled(base, rng):
    row = rng.integers(50, len(base.force) - 50)
    return np.insert(base.x, row, base.x[row], axis=0), np.insert(base.force, row, base.force[row], axis=0)


def silence(base, rng):
    got = base.force.copy()
    begin = rng.integers(len(got) // 4, len(got) // 2)
    end = rng.choice([len(got), begin + len(got) // 4])
    got[begin:end, :] = 0
    return base.x, got


def rate(base, rng):
    """Twice, half or nearly as many ticks a second, or the same ticks over a time of which a per cent is wrong."""
    factor = rng.choice([2.0, 0.5, 1.01, 0.98])
    rows = int(len(base.force) * factor) if factor in (2.0, 0.5) else len(base.force)
    if base.law:
        x = base.position(base.times(rows) / factor)
        return base.position(base.times(rows) / factor), base.law(x, 1 / base.rate_hz / factor, **base.parameters)
    at = np.arange(rows) / factor
    take = lambda values: np.stack([np.interp(at, np.arange(len(values)), column) for column in values.T], axis=1)
    return take(base.x), take(base.force)


def saturation(base, rng):
    got = base.force.copy()
    axis = one_axis(base, rng)
    most = rng.uniform(0.4, 0.9) * np.abs(got[:, axis]).max()
    got[:, axis] = np.clip(got[:, axis], -most, most)
    return base.x, got


def vibration(base, rng):
    got = base.force.copy()
    axis = one_axis(base, rng)
    hz = rng.uniform(15, 0.5 * base.rate_hz) if rng.random() < 0.8 else 0.5 * base.rate_hz
    wave = np.cos(2 * np.pi * hz * base.times(len(got)) + (0 if hz == 0.5 * base.rate_hz else rng.uniform(0, 6)))
    got[:, axis] += rng.uniform(0.003, 0.1) * np.abs(got[:, axis]).max() * wave
    return base.x, got


def spike(base, rng):
    got = base.force.copy()
    axis = one_axis(base, rng)
    got[rng.integers(20, len(got) - 20), axis] += rng.choice([-1, 1]) * rng.uniform(0.05, 2) * np.abs(got[:, axis]).max()
    return base.x, got


def noise(base, rng):
    got = base.force.copy()
    axis = one_axis(base, rng)
    got[:, axis] += rng.uniform(0.003, 0.1) * np.abs(got[:, axis]).max() * rng.standard_normal(len(got))
    return base.x, got


def trajectory(base, rng):
    """Elsewhere: farther, moved, or with a tremor."""
    way = rng.integers(3)
    if way == 0:
        return base.rendered(moved=lambda x: x * rng.uniform(1.02, 1.2))
    if way == 1:
        by = rng.uniform(-0.1, 0.1, base.x.shape[1]) * np.abs(base.x).max(axis=0)
        return base.rendered(moved=lambda x: x + by)
    tremor = 0.02 * np.sin(2 * np.pi * 9 * base.times(len(base.x)))[:, None] * np.abs(base.x).max(axis=0)
    return base.rendered(moved=lambda x: x + tremor)


PARAMETERS = {"kelvin": ["k1", "k2", "b"], "two arms": ["k1", "k2", "k3", "tau3"], "exponential": ["a", "b"],
              "Hunt-Crossley": ["k", "damping", "n"], "six axes": ["k", "kr", "b", "friction"]}


def parameters(base, rng):
    import inspect
    name = rng.choice(PARAMETERS[base.name])
    default = inspect.signature(base.law).parameters[name].default
    return base.rendered(**{str(name): default * rng.choice([rng.uniform(0.8, 0.98), rng.uniform(1.01, 1.25)])})


def state(base, rng):
    """What the law remembers at its first tick, or forgets within a contact."""
    if base.name == "two arms" and rng.random() < 0.5:
        return base.rendered(state=rng.choice([-1, 1]) * rng.uniform(0.1, 1.0))
    pressed = np.flatnonzero(base.force[:, 0] > 0.5 * base.force.max())
    return base.rendered(forgets=int(rng.choice(pressed)))


CHANGES = {"sign": sign, "axes": axes, "rotation": rotation, "unit": unit, "gain": gain, "offset": offset, "drift": drift, "lag": lag,
           "lost": lost, "doubled": doubled, "silence": silence, "rate": rate, "saturation": saturation, "vibration": vibration,
           "spike": spike, "noise": noise, "trajectory": trajectory, "parameters": parameters, "state": state}


def can_be_made(name, base):
    if name in ("axes", "rotation"):
        return base.force.shape[1] == 6
    if name == "state":
        return base.name in ("kelvin", "two arms")
    return base.law is not None or name not in ("trajectory", "parameters")


def is_at_its_row(finding, base, got):
    """Whether samples are missing or there twice where it says: taken out or put in there, all is as it came. Of several
    places only the first: until there nothing has changed."""
    numbers, force = finding["numbers"], base.force
    row, count, first = (int(numbers[key]) for key in ("row", "count", "first_row"))
    same = lambda a, b: len(a) == len(b) and np.abs(a - b).max(initial=0.0) <= 1e-6 * np.abs(force).max()
    if numbers["places"] > 1:
        return same(force[:first], got[:first])
    if finding["change"] == "lost":
        return all(same(np.delete(force, slice(at, at + count), axis=0), got) for at in (first, row))
    return all(same(np.insert(force, at, force[at], axis=0), got) for at in (first, row))


# Whether a name that was not injected makes the same difference.


def left_over(expected, got, predicted, rows=slice(None)):
    difference = (got - expected)[rows]
    return np.linalg.norm((got - predicted)[rows]) / max(np.linalg.norm(difference), 1e-300)


def nearest(columns, expected, got):
    weights = np.linalg.lstsq(columns, got - expected, rcond=1e-10)[0]
    return left_over(expected, got, expected + columns @ weights)


def in_contact(expected, got):
    tiny = 1e-9 * max(np.abs(expected).max(), np.abs(got).max())
    return (np.maximum(np.abs(expected), np.abs(got)) > tiny).astype(float)


def of_motion(base, axis, expected, got):
    """Powers of depth and speed, and what low passes of them remember."""
    own = range(base.x.shape[1])
    columns = [np.ones(len(expected)), expected]
    for a in own:
        x = (base.x[:, a] - base.x[:, a].mean()) / base.x[:, a].std()
        v = np.gradient(x) * base.rate_hz
        v = v / v.std()
        columns += [x, v]
        if a != axis and len(base.x[0]) == base.force.shape[1]:
            continue
        columns += [x**2, x**3, v * abs(v), x * v, x * x * v, x * expected, v * expected, np.tanh(10 * v)]
        for seconds in (0.003, 0.01, 0.03, 0.1, 0.3, 1.0):
            kept, memory = np.exp(-1 / seconds / base.rate_hz), np.zeros((2, len(x)))
            gate = in_contact(expected, got)
            state = np.zeros(2)
            for i in range(len(x)):
                state = gate[i] * (kept * state + (1 - kept) * np.array([x[i], v[i]]))
                memory[:, i] = state
            columns += list(memory)
    return np.stack(columns, axis=1) * in_contact(expected, got)[:, None]


def makes_the_same(finding, base, x, got):
    """Whether what a finding says makes the difference of its channels, within the bound."""
    change, numbers = finding["change"], finding["numbers"]
    if change == "trajectory":
        rows = min(len(x), len(base.x))
        return np.abs(x[:rows] - base.x[:rows]).max() > 1e-9 * np.ptp(base.x)
    if len(got) != len(base.force):
        if change == "rate":
            at = np.clip(np.arange(len(got)) * numbers["speed"], 0, len(base.force) - 1)
            predicted = np.stack([np.interp(at, np.arange(len(base.force)), column) for column in base.force.T], axis=1)
            short = min(len(got), len(base.force))
            return left_over(base.force[:short], got[:short], predicted[:short]) <= BOUND
        return False
    if change in ("axes", "rotation"):
        first = min(finding["channels"]) // 3 * 3
        e, g = base.force[:, first:first + 3], got[:, first:first + 3]
        turn = linalg.orthogonal_procrustes(e, g)[0]
        return left_over(e, g, e @ turn) <= BOUND
    return all(makes_the_same_in(change, numbers, base, axis, base.force[:, axis], got[:, axis]) for axis in finding["channels"])


def makes_the_same_in(change, numbers, base, axis, e, g):
    rows = np.arange(len(e))
    t = rows / base.rate_hz
    if change in ("sign", "gain", "unit"):
        return left_over(e, g, numbers["factor"] * e) <= BOUND
    if change == "offset":
        return left_over(e, g, e + numbers["offset"]) <= BOUND
    if change == "drift":
        return left_over(e, g, e + numbers["at_start"] + numbers["per_s"] * t) <= BOUND
    if change == "lag":
        edge = int(abs(numbers["ticks"])) + 20
        inside = slice(edge, len(e) - edge)
        ways = [left_over(e, g, shifted(e[:, None], numbers["ticks"], way)[:, 0], inside) for way in ("lines", "cubic", "phases")]
        return min(ways) <= BOUND
    if change == "rate":
        return left_over(e, g, np.interp(np.clip(rows * numbers["speed"], 0, len(e) - 1), rows, e)) <= 1.5 * BOUND
    if change == "saturation":
        return left_over(e, g, np.clip(e, numbers.get("low", -np.inf), numbers.get("high", np.inf))) <= BOUND
    if change == "silence":
        predicted = e.copy()
        predicted[int(numbers["row"]):int(numbers["end"])] = 0
        return left_over(e, g, predicted) <= BOUND
    if change == "spike":
        return np.count_nonzero(np.abs(g - e) > 1e-9 * np.abs(e).max()) <= 5
    if change == "repeated":
        differ = np.flatnonzero(np.abs(g - e) > 1e-9 * np.abs(e).max())
        return np.abs(g[differ] - g[differ - 1]).max() <= 1e-9 * np.abs(e).max()
    if change == "vibration":
        turn = 2 * np.pi * numbers["hz"] * t
        for gate in (np.ones(len(e)), in_contact(e, g)):
            if nearest(np.stack([np.cos(turn), np.sin(turn)], axis=1) * gate[:, None], e, g) <= BOUND:
                return True
        return False
    if change == "stuck":
        return np.ptp(g[int(numbers["row"]):int(numbers["end"])]) <= 1e-9 * np.abs(e).max()
    if change == "parameters":
        return nearest(of_motion(base, axis, e, g), e, g) <= 1.1 * BOUND
    if change == "state":
        begin = int(numbers["row"])
        for gate in (np.ones(len(e)), in_contact(e, g)):
            for times in (1, 2):
                def left(logs):
                    columns = np.exp(-np.maximum(rows - begin, 0)[:, None] / np.exp(logs)) * (rows >= begin)[:, None]
                    return nearest(columns * gate[:, None], e, g)
                start = np.log(numbers["ms"] * 1e-3 * base.rate_hz) - np.arange(times)
                if optimize.minimize(left, start, method="Nelder-Mead").fun <= BOUND:
                    return True
        return False
    return False
