"""The laws written anew, from their equations (docs/laws.md, models/include): each a sum of columns that are linear in some
parameters and depend on others, which a peer's search has to find.
"""

import numpy
from scipy.linalg import solve_banded
from scipy.signal import lfilter
from scipy.special import gamma

LEAST_STIFFNESS = 1e-9
NO_BOUND = -numpy.inf


class Law:
    """F = sum c_i column_i(q), not below zero where the law only pushes.

    `linear` and `nonlinear` name the parameters; `least` are the bounds of c from below, `ranges` those of q. Searches see
    the logarithm of what is positive.
    """

    nonlinear, ranges, pushes = [], [], False

    def __init__(self, series, options):
        self.series = series
        self.options = options

    @property
    def names(self):
        return self.linear + self.nonlinear

    def force(self, values):
        c, q = values[:len(self.linear)], values[len(self.linear):]
        force = self.columns(q) @ c
        return numpy.maximum(force, 0.0) if self.pushes else force


def decaying(series, rate, source):
    """f[n] = a[n] f[n-1] + source[n], f[0] = source[0], a = exp(-rate dt)."""
    decay = numpy.exp(-rate * series.dt)
    if series.uniform:
        return lfilter([1.0], [1.0, -decay[1]], source)
    return solve_banded((1, 0), numpy.array([numpy.ones_like(decay), numpy.append(-decay[1:], 0.0)]), source)


class Maxwell(Law):
    pushes = True

    def __init__(self, series, options, arms):
        super().__init__(series, options)
        self.linear = ["parallel_stiffness"] + ["stiffness[%d]" % i for i in range(arms)]
        self.nonlinear = ["relaxation_time[%d]" % i for i in range(arms)]
        self.least = [LEAST_STIFFNESS] * (arms + 1)
        self.ranges = [(1e-6, 1e6)] * arms
        self.inside = numpy.maximum(series.x, 0.0)
        self.travel = numpy.diff(self.inside, prepend=self.inside[0])

    def arm(self, time):
        """Of unit stiffness; penetration is linear within a tick."""
        share = self.series.dt / time
        return decaying(self.series, 1.0 / time, -numpy.expm1(-share) / share * self.travel)

    def columns(self, q):
        return numpy.column_stack([self.inside] + [self.arm(time) for time in q])


class Springpot(Law):
    """The sum of 40 decays that models/springpot.h documents; its reference time is an option."""

    linear, least = ["stiffness", "fractional_stiffness"], [LEAST_STIFFNESS] * 2
    nonlinear, ranges, pushes = ["order"], [(0.01, 0.99)], True
    rates = 1e6 * numpy.exp(-0.75 * numpy.arange(41))

    def __init__(self, series, options):
        super().__init__(series, options)
        self.inside = numpy.maximum(series.x, 0.0)
        self.travel = numpy.diff(self.inside, prepend=self.inside[0])
        self.prepare()

    def prepare(self):
        share = [rate * self.series.dt for rate in self.rates[:-1]]
        self.bent = numpy.column_stack([decaying(self.series, rate, -numpy.expm1(-s) / s * self.travel)
                                        for rate, s in zip(self.rates, share)])

    def kernel(self, order):
        scale = numpy.sin(numpy.pi * order) * 0.75 / numpy.pi
        moved = self.inside - self.inside[0]
        slow = self.rates[-1] ** order / -numpy.expm1(-0.75 * order)
        fast = (1e6 * numpy.exp(0.75)) ** (order - 1.0) / -numpy.expm1(-0.75 * (1.0 - order))
        return scale * (self.bent @ self.rates[:-1] ** order + slow * moved + fast * self.travel / self.series.dt)

    def columns(self, q):
        reference = self.options.get("reference_time", 1.0)
        return numpy.column_stack([self.inside, reference ** q[0] * self.kernel(q[0])])


class ExactSpringpot(Springpot):
    """Caputo's derivative of a path that is linear between its rows, in closed form: n^2 powers."""

    def prepare(self):
        since = self.series.time[:, None] - self.series.time[None, :]
        self.since = numpy.maximum(since, 0.0)

    def kernel(self, order):
        powers = self.since ** (1.0 - order)
        slope = self.travel[1:] / self.series.dt[1:]
        return (powers[:, :-1] - powers[:, 1:]) @ slope / gamma(2.0 - order)


class Exponential(Law):
    def __init__(self, series, options):
        super().__init__(series, options)
        self.viscous, self.offset = options.get("viscous", True), options.get("offset", False)
        self.linear = ["amplitude"] + ["viscosity"] * self.viscous + ["offset"] * self.offset
        self.least = [1e-15] + [NO_BOUND] * (len(self.linear) - 1)
        self.depth = series.x / options.get("thickness", 0.1)
        self.nonlinear, self.ranges = ["exponent"], [(1e-6, min(1e3, 300.0 / self.depth.max()))]

    def columns(self, q):
        touching = self.depth > 0.0
        columns = [numpy.where(touching, numpy.exp(q[0] * numpy.maximum(self.depth, 0.0)), 0.0)]
        columns += [numpy.where(touching, self.series.v, 0.0)] * self.viscous
        return numpy.column_stack(columns + [numpy.ones_like(self.depth)] * self.offset)


class HuntCrossley(Law):
    linear, least = ["reference_force", "reference_damping"], [1e-15, NO_BOUND]
    nonlinear, ranges, pushes = ["exponent"], [(0.5, 5.0)], True

    def columns(self, q):
        depth = numpy.maximum(self.series.x, 0.0) / self.options.get("reference_depth", 0.01)
        return numpy.column_stack([depth ** q[0], self.series.v * depth ** q[0]])


class Friction(Law):
    linear, least = ["offset", "stiffness", "viscosity", "coulomb"], [NO_BOUND] * 3 + [0.0]
    nonlinear = ["presliding"]

    def __init__(self, series, options):
        super().__init__(series, options)
        self.travel = numpy.diff(series.x, prepend=series.x[0])
        self.ranges = [(1e-5 * numpy.ptp(series.x), 30.0 * numpy.ptp(series.x))]

    def columns(self, q):
        s = self.series
        decay = numpy.exp(-numpy.abs(self.travel) / q[0])
        slip = solve_banded((1, 0), numpy.array([numpy.ones_like(decay), numpy.append(-decay[1:], 0.0)]),
                            numpy.sign(self.travel) * -numpy.expm1(-numpy.abs(self.travel) / q[0]))
        return numpy.column_stack([numpy.ones_like(s.x), s.x, s.v, slip])


class Precontact(Law):
    linear, least, nonlinear = ["stiffness"], [LEAST_STIFFNESS], ["width"]

    def __init__(self, series, options):
        super().__init__(series, options)
        self.ranges = [(1e-9, 1e3)]

    def columns(self, q):
        x, w = self.series.x, q[0]
        before = numpy.where(x > -w, (x + w) ** 2 / (2.0 * w), 0.0)
        return numpy.where(x <= 0.0, before, x + 0.5 * w)[:, None]


class ScissorsAnalytic(Law):
    linear, least = ["pivot_torque", "blade_friction", "cutting_force"], [0.0] * 3

    def columns(self, _):
        s = self.series
        theta = self.options.get("contact_angle", 0.5) - s.x
        cuts = (theta >= 2.0 * numpy.arctan(1.0 / 35.0)) & (theta <= 0.7)
        half = numpy.tan(0.5 * numpy.where(cuts, theta, 0.5))
        point = 4e-3 / (half + 3.0 / 35.0) * half / numpy.sin(numpy.arctan(half))  # x_c = t(theta) / sin(theta / 2)
        way = numpy.sign(s.v)
        moving = numpy.maximum.accumulate(numpy.where(way != 0.0, numpy.arange(len(way)), 0))
        closing = way[moving] >= 0.0
        side = numpy.where(closing, 1.0, -1.0) * cuts / (0.28 / 7.58)
        return numpy.column_stack([side, side * point, numpy.where(closing & (s.x > 0.0), side * point, 0.0)])
