"""Makes motion.csv and forces.csv, one motion seen by two clocks, and prints what NumPy and SciPy find of them.

python3 make.py (NumPy 1.24, SciPy 1.10 of Debian 12). Truth: t = 3.2174 s + (1 + 400e-6) t_forces.
"""

import numpy as np
from scipy import interpolate, optimize, signal

SHIFT, SKEW = 3.2174, 400e-6
random = np.random.default_rng(20260131)
knots = np.arange(-2.0, 40.0, 0.35)
motion = interpolate.CubicSpline(knots, 5.0 + 3.0 * random.standard_normal(knots.size))  # mm, as a hand wanders


def force(x):
    return 0.4 + 0.15 * x + 0.02 * x * x  # N


t = 100.0 + np.arange(1200) / 50.0  # s by the clock of the motion, which began at 100
x = motion(t - 100.0) + 0.05 * random.standard_normal(t.size)
u = np.arange(900) / 60.0  # s by the clock of the forces
seen = 1.03 * motion(SHIFT + (1.0 + SKEW) * u) + 0.7 + 0.05 * random.standard_normal(u.size)
f = force(motion(SHIFT + (1.0 + SKEW) * u))
with open("motion.csv", "w", encoding="utf-8") as file:
    file.write("t_s,x_mm\n" + "".join("%.3f,%.4f\n" % row for row in zip(t, x)))
with open("forces.csv", "w", encoding="utf-8") as file:
    file.write("t_s,wire_mm,F_N\n" + "".join("%.6f,%.4f,%.5f\n" % row for row in zip(u, seen, f)))

t, x = np.loadtxt("motion.csv", delimiter=",", skiprows=1).T
u, seen, f = np.loadtxt("forces.csv", delimiter=",", skiprows=1).T
t -= t[0]
grid = np.arange(0.0, u[-1], 0.02)
b = np.interp(grid, u, seen)
n = b.size
# The correlation coefficient at each whole lag with full overlap.
sums = np.convolve(x, np.ones(n), "valid")
squares = np.convolve(x * x, np.ones(n), "valid")
products = signal.correlate(x, b - b.mean(), "valid")
r = products / np.sqrt((squares - sums * sums / n) * n * b.var())
start = grid[1] * np.argmax(r)
print("coarse: shift %.2f s, correlation %.4f" % (start, r.max()))
spline = interpolate.UnivariateSpline(t, x, w=np.full(t.size, 1.0 / 0.05), s=t.size)  # smoothed by its known noise
fit = optimize.least_squares(lambda p: spline(p[0] + (1.0 + p[1]) * u) - p[2] * seen - p[3], [start, 0.0, 1.0, 0.0], x_scale=[0.01, 1e-4, 0.1, 0.1])
errors = np.sqrt(np.diag(np.linalg.inv(fit.jac.T @ fit.jac)) * 2.0 * fit.cost / (u.size - 4))
print("shift %.5f +- %.5f s, skew %.1f +- %.1f ppm" % (fit.x[0], errors[0], 1e6 * fit.x[1], 1e6 * errors[1]))
