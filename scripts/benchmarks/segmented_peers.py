"""Cases for piecewise-linear fits, and pwlf's algorithm on them: the sum of squares as a function of the breakpoints,
minimised by differential evolution with its default settings and a polish (SciPy), written anew since Debian does not package pwlf.
"""

import math
import time

import numpy
from scipy.optimize import differential_evolution


def cases():
    """Name, position, force: curves that bend gently, sharply, twice in one place, jump, or are nothing but noise."""
    random = numpy.random.default_rng(6)
    x = numpy.linspace(0.0, 1.0, 400)
    made = {
        "three kinks": numpy.interp(x, [0.0, 0.2, 0.55, 0.7, 1.0], [0.0, 0.1, 1.5, 0.4, 0.9]),
        "two kinks close together": numpy.interp(x, [0.0, 0.48, 0.53, 1.0], [0.0, 0.4, 1.4, 1.6]),
        "a bend": numpy.sin(9.0 * x) * numpy.exp(x),
        "a jump": numpy.where(x > 0.62, 1.5, 0.0) + x * x,
        "a break of tissue": numpy.where(x < 0.5, 4.0 * x * x, 0.3 + 0.2 * x),
        "noise": numpy.zeros_like(x),
    }
    for name, force in made.items():
        yield name, x, force + 0.05 * random.standard_normal(x.size)
    few = numpy.sort(random.uniform(0.0, 1.0, 40))
    yield "40 scattered points", few, numpy.abs(few - 0.4) + 0.02 * random.standard_normal(few.size)


def sum_of_squares(breakpoints, x, y):
    knots = numpy.sort(breakpoints)
    columns = numpy.column_stack([numpy.ones_like(x), x] + [numpy.maximum(x - knot, 0.0) for knot in knots])
    solution, _, _, _ = numpy.linalg.lstsq(columns, y, rcond=None)
    residual = columns @ solution - y
    return float(residual @ residual)


def as_pwlf(x, y, count):
    """Sum of squares and seconds."""
    begin = time.perf_counter()
    bounds = [(float(x[0]), float(x[-1]))] * count
    found = differential_evolution(sum_of_squares, bounds, args=(x, y), popsize=50, maxiter=1000, tol=1e-3, atol=1e-4,
                                   polish=True, seed=1)
    return (found.fun if math.isfinite(found.fun) else math.inf), time.perf_counter() - begin
