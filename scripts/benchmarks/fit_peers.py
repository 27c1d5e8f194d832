"""One peer's fit of one recording, in a process of its own: prints what came out and how long each fit took.

    fit_peers.py scipy|lmfit kelvin|exponential FILE TURNS
"""

import json
import sys
import time

import numpy

ROWS = 60_000
THICKNESS_M = 0.01
# A user's guess, two to three times off: the truth is (500, 800, 160) and (0.3, 2.5, 4).
STARTS = {"kelvin": {"k1": 1200.0, "k2": 350.0, "b": 400.0}, "exponential": {"alpha": 0.8, "beta": 1.1, "viscosity": 10.0}}


def kelvin(recording):
    from scipy.signal import lfilter
    time_s, depth = recording[0], recording[1]
    period = time_s[1] - time_s[0]
    inside = numpy.maximum(depth, 0.0)
    travel = numpy.diff(inside, prepend=inside[0])

    def force(_, k1, k2, b):
        decay = numpy.exp(-period * k2 / b)
        arm = lfilter([b / period * (1.0 - decay)], [1.0, -decay], travel)
        return numpy.maximum(k1 * inside + arm, 0.0)

    return force


def exponential(recording):
    depth, speed = recording[1], recording[2]
    touching = depth > 0.0

    def force(_, alpha, beta, viscosity):
        return numpy.where(touching, alpha * numpy.exp(beta / THICKNESS_M * depth) + viscosity * speed, 0.0)

    return force


def with_scipy(force, recording, start):
    from scipy.optimize import curve_fit
    values, covariance = curve_fit(force, recording[1], recording[3], p0=list(start.values()))
    return values, numpy.sqrt(numpy.diag(covariance))


def with_lmfit(force, recording, start):
    import lmfit
    parameters = lmfit.Parameters()
    for name, value in start.items():
        parameters.add(name, value=value)

    def residual(p):
        return force(None, *(p[name].value for name in start)) - recording[3]

    result = lmfit.minimize(residual, parameters)
    return ([result.params[name].value for name in start], [result.params[name].stderr for name in start])


def main():
    peer, law, path, turns = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4])
    recording = numpy.fromfile(path).reshape(4, ROWS)
    force = {"kelvin": kelvin, "exponential": exponential}[law](recording)
    fit = {"scipy": with_scipy, "lmfit": with_lmfit}[peer]
    seconds = []
    for _ in range(turns):
        begin = time.perf_counter()
        values, errors = fit(force, recording, STARTS[law])
        seconds.append(time.perf_counter() - begin)
    squares = float(numpy.sum((force(None, *values) - recording[3]) ** 2))
    print(json.dumps({"values": [float(v) for v in values], "std_errors": [float(e) for e in errors],
                      "sum_of_squares": squares, "seconds": seconds}))


main()
