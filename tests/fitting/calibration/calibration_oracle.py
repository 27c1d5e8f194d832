"""Makes calibration_oracle.h: calibrations by NumPy and SciPy, apart from the code that they check.

python3 tests/fitting/calibration/calibration_oracle.py > tests/fitting/calibration/calibration_oracle.h

Restricted likelihood by scipy.optimize over dense determinants, generalised least squares by dense inverses, the covariance of the
inverse by central differences of numpy.linalg.pinv, Satterthwaite's degrees of freedom by central differences of the variance.
"""

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.stats import t as student


def reml(y, X, B):
    n, p = X.shape

    def minus_log(log_s2):
        V = np.exp(log_s2) * np.eye(n) + B
        W = np.linalg.inv(V)
        N = X.T @ W @ X
        P = W - W @ X @ np.linalg.inv(N) @ X.T @ W
        return np.linalg.slogdet(V)[1] + np.linalg.slogdet(N)[1] + y @ P @ y

    rest = y - X @ np.linalg.lstsq(X, y, rcond=None)[0]
    start = np.log(rest @ rest / (n - p))
    return float(np.exp(minimize_scalar(minus_log, bounds=(start - 15, start + 2), method="bounded", options={"xatol": 1e-10}).x))


def gls(y, X, V):
    W = np.linalg.inv(V)
    C = np.linalg.inv(X.T @ W @ X)
    return C @ X.T @ W @ y, C @ X.T @ W


def calibrate(F, Y, time, G):
    """F n x m, Y n x N, G (n m) x q; no hysteresis, no temperature, one tare."""
    n, m = F.shape
    N = Y.shape[1]
    X = np.column_stack([F, np.ones(n), time - time.max()])
    p = X.shape[1]
    A = np.linalg.lstsq(X, Y, rcond=None)[0][:m].T
    for _ in range(2 if G.shape[1] else 1):
        E = [np.array([A[i] @ G[h * m:(h + 1) * m] for h in range(n)]).reshape(n, -1) for i in range(N)]
        s2 = [reml(Y[:, i], X, E[i] @ E[i].T) for i in range(N)]
        fits = [gls(Y[:, i], X, s2[i] * np.eye(n) + E[i] @ E[i].T) for i in range(N)]
        A = np.array([b[:m] for b, _ in fits])
    L = [estimator for _, estimator in fits]
    nu = []
    for i in range(N):
        V = s2[i] * np.eye(n) + E[i] @ E[i].T
        W = np.linalg.inv(V)
        P = W - W @ X @ np.linalg.inv(X.T @ W @ X) @ X.T @ W
        nu.append(s2[i] ** 2 * np.trace(P @ P))

    def inverse(M):
        if M.shape[0] == M.shape[1]:
            return np.linalg.inv(M)
        W = np.diag(1.0 / np.array(s2))
        return np.linalg.inv(M.T @ W @ M) @ M.T @ W

    def half(gradient):  # N x p
        noise = [s2[i] * np.sum((gradient[i] @ L[i]) ** 2) for i in range(N)]
        loads = sum(gradient[i] @ L[i] @ E[i] for i in range(N))
        v = sum(noise) + (np.sum(loads ** 2) if G.shape[1] else 0.0)
        free = v ** 2 / sum(noise[i] ** 2 / nu[i] for i in range(N))
        return student.ppf(0.975, free) * np.sqrt(v)

    C = inverse(A)
    widths = np.zeros_like(C)
    for k in range(m):
        for c in range(N):
            gradient = np.zeros((N, p))
            for i in range(N):
                for j in range(m):
                    step = 1e-6 * np.abs(A).max()
                    up, down = A.copy(), A.copy()
                    up[i, j] += step
                    down[i, j] -= step
                    gradient[i, j] = (inverse(up)[k, c] - inverse(down)[k, c]) / (2 * step)
            widths[k, c] = half(gradient)
    bias = [b[m] for b, _ in fits]
    bias_width = [half(np.eye(N)[i][:, None] * np.eye(p)[m]) for i in range(N)]
    drift = [b[m + 1] for b, _ in fits]
    drift_width = [half(np.eye(N)[i][:, None] * np.eye(p)[m + 1]) for i in range(N)]
    return dict(matrix=C, matrix_half=widths, bias=bias, bias_half=bias_width, drift=drift, drift_half=drift_width,
                sigma=np.sqrt(s2), free=nu)


def numbers(name, values):
    flat = np.asarray(values, float).ravel()
    return "inline const std::vector<double> %s{%s};" % (name, ", ".join("%.17g" % v for v in flat))


def case(name, F, Y, time, G):
    out = calibrate(F, Y, time, G)
    lines = ["namespace %s {" % name, "inline constexpr std::size_t components = %d;" % F.shape[1],
             "inline constexpr std::size_t signals = %d;" % Y.shape[1], numbers("loads", F), numbers("values", Y),
             numbers("times", time), numbers("load_error", G)]
    lines += [numbers(key, value) for key, value in out.items()]
    return "\n".join(lines) + "\n}  // namespace %s\n" % name


def main():
    rng = np.random.default_rng(20)
    n = 16
    time = np.arange(n) * 30.0
    F = np.zeros((n, 2))
    F[[2, 3, 4, 5], 0] = [5, 10, 5, -10]
    F[[7, 8, 9, 10], 1] = [0.2, 0.4, 0.2, -0.4]
    F[[12, 13, 14]] = [[10, 0.4], [5, -0.2], [-10, 0.2]]
    A = np.array([[0.25, 0.4], [-0.01, 5.0]])
    q = 2  # two weights, each wrong by a share of its own: 0.2 % and 0.1 %
    G = np.zeros((n * 2, q))
    for h in range(n):
        heavy = abs(F[h, 0]) == 10 or abs(F[h, 1]) == 0.4
        G[2 * h:2 * h + 2, 0 if heavy else 1] = F[h] * (0.002 if heavy else 0.001)
    true = F + (G @ rng.normal(size=q)).reshape(n, 2)
    Y = true @ A.T + np.array([0.1, -0.2]) + np.outer(time - time.max(), [1e-5, -2e-5]) + 2e-3 * rng.normal(size=(n, 2))
    print("#pragma once\n\n// Made by calibration_oracle.py with NumPy %s; not to be edited.\n\n#include <cstddef>\n#include <vector>\n" % np.__version__)
    print("namespace kerf::fitting::calibration::oracle {\n// clang-format off")
    print(case("square", F, Y, time, G))
    A3 = np.array([[0.25, 0.4], [-0.01, 5.0], [0.2, -2.0]])
    Y3 = F @ A3.T + np.array([0.1, -0.2, 0.3]) + np.outer(time - time.max(), [1e-5, -2e-5, 0]) + [1e-3, 2e-3, 4e-3] * rng.normal(size=(n, 3))
    print(case("wide", F, Y3, time, np.zeros((n * 2, 0))))
    print("// clang-format on\n}  // namespace kerf::fitting::calibration::oracle")


if __name__ == "__main__":
    main()
