"""Posterior intervals of a threshold on a dense grid, which posterior_test.cpp holds the library to.

Trapezoids in ln(threshold), ln(slope) and the lapse rate over the whole prior (posterior.h), by NumPy and SciPy.
With half the steps the ends move by less than 1e-4; where some lapse rates do not reach the criterion, the last ones
count most and the grid of lapses is the finer. A case of very many answers has a box of thresholds.

    python3 posterior.py     # some minutes: lower end, median, upper end
"""

import numpy
from scipy.integrate import cumulative_trapezoid
from scipy.special import expit, ndtr, ndtri

SHAPES = {
    "weibull": (lambda z: -numpy.expm1(-numpy.exp(numpy.minimum(z, 50.0))), lambda p: numpy.log(-numpy.log1p(-p))),
    "logistic": (expit, lambda p: numpy.log(p / (1.0 - p))),
    "gaussian": (ndtr, ndtri),
}
BEYOND = numpy.log(10.0)


def ends(levels, shape="weibull", guess=0.5, lapse=None, largest_lapse=0.06, criterion=None, confidence=0.95,
         counts=(1601, 241, 81), box=None):
    below, quantile = SHAPES[shape]
    criterion = guess + 0.5 * (1.0 - guess) if criterion is None else criterion
    at = numpy.log([level[0] for level in levels])
    right = numpy.array([level[1] for level in levels], float)
    wrong = numpy.array([level[2] for level in levels], float) - right
    (u0, u1), (s0, s1) = box or ((at.min() - BEYOND, at.max() + BEYOND), (numpy.log(0.5), numpy.log(10.0)))
    u, s = numpy.linspace(u0, u1, counts[0]), numpy.linspace(s0, s1, counts[1])
    lapses = numpy.linspace(0.0, largest_lapse, counts[2]) if lapse is None else numpy.array([lapse])
    lapses = lapses[criterion < 1.0 - lapses - 1e-12]
    weights = numpy.ones(len(lapses))
    if len(lapses) > 1:
        weights[[0, -1]] = 0.5
    slopes = numpy.exp(s)
    trap = numpy.ones(len(s))
    trap[[0, -1]] = 0.5
    density, largest = numpy.zeros(len(u)), -numpy.inf
    for rate, weight in zip(lapses, weights):
        shift = quantile((criterion - guess) / (1.0 - guess - rate))
        log = numpy.zeros((len(u), len(s)))
        for x, k, m in zip(at, right, wrong):
            psi = guess + (1.0 - guess - rate) * below(slopes * (x - u[:, None]) + shift)
            if k:
                log += k * numpy.log(numpy.maximum(psi, 1e-150))
            if m:
                log += m * numpy.log(numpy.maximum(1.0 - psi, 1e-150))
        if log.max() > largest:
            density *= numpy.exp(largest - log.max())
            largest = log.max()
        density += weight * (numpy.exp(log - largest) @ trap)
    if box:
        assert max(density[0], density[-1]) < 1e-9 * density.max()
    mass = cumulative_trapezoid(density, u, initial=0.0)
    mass /= mass[-1]
    tail = 0.5 * (1.0 - confidence)
    return [float(numpy.exp(numpy.interp(share, mass, u))) for share in (tail, 0.5, 1.0 - tail)]


STAIRCASE = [(0.4, 3, 3), (0.2828, 4, 4), (0.2, 7, 8), (0.1414, 9, 11), (0.1, 8, 13), (0.0707, 4, 8), (0.05, 1, 3)]
FEW = [(0.05, 8, 15), (0.1, 12, 15), (0.2, 15, 15)]
YES_NO = [(1.0, 2, 20), (1.5, 5, 20), (2.0, 11, 20), (3.0, 16, 20), (4.0, 19, 20)]
THREE = [(0.02, 11, 30), (0.04, 15, 30), (0.08, 22, 30), (0.16, 29, 30)]
MANY = [(0.02, 10365, 20000), (0.05, 12076, 20000), (0.08, 14425, 20000), (0.12, 17222, 20000), (0.2, 19425, 20000),
        (0.4, 19599, 20000)]
CASES = {
    "staircase": (STAIRCASE, {}),
    "few": (FEW, {}),
    "few, 68 %": (FEW, {"confidence": 0.68}),
    "yes or no, logistic": (YES_NO, {"shape": "logistic", "guess": 0.0}),
    "three, gaussian": (THREE, {"shape": "gaussian", "guess": 1.0 / 3.0, "criterion": 0.8}),
    "known lapses": (STAIRCASE, {"lapse": 0.02}),
    "criterion that some lapses do not reach": (STAIRCASE, {"criterion": 0.93, "largest_lapse": 0.1, "counts": (1601, 241, 2561)}),
    "many": (MANY, {"box": ((-2.60, -2.20), (numpy.log(0.5), numpy.log(10.0))), "counts": (801, 1601, 121)}),
}

if __name__ == "__main__":
    for name, (levels, how) in CASES.items():
        print(name, *("%.8g" % end for end in ends(levels, **how)), flush=True)
