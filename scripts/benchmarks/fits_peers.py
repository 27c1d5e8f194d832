"""Least squares as a user of SciPy and lmfit would write them: scans and several starts over the parameters that are not linear
(variable projection), a polish of all, white intervals, profiles by lmfit.conf_interval.
"""

import signal
import time
import warnings

import numpy
from scipy.optimize import least_squares, lsq_linear
from scipy.stats import t as student

STARTS = 4
SCANNED = 48
POLISHED = 2
TIGHT = {"ftol": 1e-15, "xtol": 1e-15, "gtol": 1e-15, "x_scale": "jac"}
PROFILE_S = 8


def projected(law, q):
    """The linear parameters that go best with q, and the residuals."""
    columns, force = law.columns(q), law.series.force
    size = numpy.maximum(numpy.sqrt((columns**2).sum(axis=0)), 1e-300)
    least = numpy.array(law.least)
    triangle = numpy.linalg.qr(numpy.column_stack([columns / size, force]), mode="r")
    r, right = triangle[:-1, :-1], triangle[:-1, -1]
    c = numpy.linalg.lstsq(r, right, rcond=None)[0] / size
    if (c < least).any():
        lower = numpy.where(numpy.isfinite(least), least * size, -numpy.inf)
        c = numpy.maximum(lsq_linear(r, right, (lower, numpy.inf), method="bvls", tol=1e-15).x / size, least)
    return c, columns @ c - force


class Search:
    """Over the logarithms of what is positive."""

    def __init__(self, law):
        self.law = law
        self.bounds = numpy.log(numpy.array(law.ranges).reshape(-1, 2)).T
        self.logarithmic = numpy.array([least > 0.0 for least in law.least] + [True] * len(law.nonlinear))
        self.lower = numpy.concatenate([numpy.where(self.logarithmic[:len(law.least)], numpy.log(numpy.maximum(law.least, 1e-300)),
                                                    law.least), self.bounds[0]])
        self.upper = numpy.concatenate([[numpy.inf] * len(law.least), self.bounds[1]])

    def starts(self, random):
        """Of several times a scan would be long: one decade apart from each other, and at random."""
        lower, upper = self.bounds
        count = len(lower)
        if count == 1:
            scanned = numpy.linspace(lower[0], upper[0], SCANNED)
            squares = [(projected(self.law, numpy.exp([q]))[1] ** 2).sum() for q in scanned]
            return [scanned[[i]] for i in numpy.argsort(squares)[:POLISHED]]
        dt, duration = numpy.median(self.law.series.dt), numpy.ptp(self.law.series.time)
        lower, upper = numpy.log(dt), numpy.log(2.0 * duration)
        spread = lower + (upper - lower) * (numpy.arange(count) + 0.5) / count
        return [spread] + [numpy.sort(random.uniform(lower, upper, count)) for _ in range(STARTS - 1)]

    def values(self, at):
        at = numpy.clip(at, self.lower, self.upper)
        return numpy.where(self.logarithmic, numpy.exp(numpy.where(self.logarithmic, numpy.minimum(at, 50.0), 0.0)), at)

    def residual(self, at):
        return self.law.force(self.values(at)) - self.law.series.force

    def run(self):
        """The parameters, their sum of squares and the point of the search."""
        law, found = self.law, []
        if not law.nonlinear:
            c, residual = projected(law, [])
            return c, float(residual @ residual)
        for start in self.starts(numpy.random.default_rng(1)):
            inner = least_squares(lambda q: projected(law, numpy.exp(q))[1], numpy.clip(start, *self.bounds), bounds=self.bounds,
                                  max_nfev=60, **TIGHT)
            q = numpy.exp(inner.x)
            found.append(numpy.concatenate([projected(law, q)[0], q]))
        squares = lambda values: float(((law.force(values) - law.series.force) ** 2).sum())
        found.sort(key=squares)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            at = numpy.where(self.logarithmic, numpy.log(numpy.abs(found[0])), found[0])
        inside = numpy.clip(at, self.lower + 1e-12, self.upper - 1e-12)
        polished = least_squares(self.residual, inside, jac="3-point", bounds=(self.lower, self.upper), max_nfev=100, **TIGHT)
        best = min(found[0], self.values(polished.x), key=squares)
        return best, squares(best)


def white_interval(law, values, name):
    """Student's, from central differences."""
    place = law.names.index(name)
    columns = []
    for i, value in enumerate(values):
        step = 1e-5 * max(abs(value), 1e-12)
        up, down = values.copy(), values.copy()
        up[i] += step
        down[i] -= step
        columns.append((law.force(up) - law.force(down)) / (2.0 * step))
    columns = numpy.array(columns).T
    size = numpy.sqrt((columns**2).sum(axis=0))
    if not (size > 0.0).all():
        return None
    scaled = columns / size
    freedom = len(columns) - len(values)
    residual = law.force(values) - law.series.force
    inverse = numpy.linalg.pinv(scaled.T @ scaled, rcond=1e-14)
    error = numpy.sqrt(inverse[place, place] * (residual @ residual) / freedom) / size[place]
    half = student.ppf(0.975, freedom) * error
    return values[place] - half, values[place] + half


class TooLong(Exception):
    pass


def stop(*_):
    raise TooLong


def with_lmfit(law, values, name):
    """lmfit's own fit from a fifth beside the peer's, its sum of squares and its profile interval, where it comes to one in time."""
    import lmfit

    parameters = lmfit.Parameters()
    keys = ["p%d" % i for i in range(len(values))]
    bounds = [(least, numpy.inf) for least in law.least] + law.ranges
    for key, value, (least, most) in zip(keys, values, bounds):
        beside = 1.2 * value if 1.2 * value < most else 0.5 * (least + most)
        parameters.add(key, value=max(beside, least + 1e-12), min=least, max=most)
    residual = lambda p: law.force(numpy.array([p[key].value for key in keys])) - law.series.force
    squares, interval = numpy.inf, None
    signal.signal(signal.SIGALRM, stop)
    signal.alarm(PROFILE_S)
    try:
        with warnings.catch_warnings(), numpy.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            fitter = lmfit.Minimizer(residual, parameters)
            result = fitter.minimize(method="leastsq", ftol=1e-15, xtol=1e-15)
            squares = float((residual(result.params) ** 2).sum())
            if all(result.params[key].stderr for key in keys):
                key = keys[law.names.index(name)]
                rows = lmfit.conf_interval(fitter, result, p_names=[key], sigmas=[0.95])[key]
                interval = (float(rows[0][1]), float(rows[-1][1]))
    except (TooLong, ValueError, lmfit.MinimizerException, numpy.linalg.LinAlgError, ZeroDivisionError, AttributeError):
        pass
    finally:
        signal.alarm(0)
    if interval and not all(numpy.isfinite(interval)):
        interval = None
    return squares, interval


def searched(law):
    """Values, sum of squares and seconds of SciPy's search."""
    begin = time.perf_counter()
    values, squares = Search(law).run()
    return {"values": values, "squares": squares, "seconds": time.perf_counter() - begin}


def with_interval(law, found, name):
    """The same with lmfit's sum of squares if that is less, an interval of the parameter, and whose it is."""
    by_lmfit, interval = with_lmfit(law, found["values"], name)
    whose = "lmfit, profile"
    if interval is None:
        interval, whose = white_interval(law, found["values"], name), "SciPy, white"
    return {**found, "squares": min(found["squares"], by_lmfit), "interval": interval, "whose": whose,
            "by": "lmfit" if by_lmfit < found["squares"] else "SciPy"}
