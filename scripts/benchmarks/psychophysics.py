# peers: python3-numpy python3-scipy psignifit
# targets: kerf_psychophysics_benchmark
"""The statistics of blind sessions against SciPy and psignifit, and how often their intervals hold the truth."""

import json
import math
import pathlib
import subprocess
import sys

import numpy
from scipy import integrate, optimize, special, stats

from sections import replace_section

EXPERIMENTS = 1000


def rows_of(program, *arguments):
    out = subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout
    return [json.loads(line) for line in out.splitlines()]


def binomial_error(row):
    """SciPy's own two-sided test takes probabilities as equal within 1e-7, as Kerf's does."""
    k, n, chance = row["k"], row["n"], row["chance"]
    found = [row["two_sided"], row["greater"], row["less"], *row["exact"], *row["wilson"]]
    tests = [stats.binomtest(k, n, chance, alternative=side) for side in ("two-sided", "greater", "less")]
    exact = tests[0].proportion_ci(0.95, "exact")
    wilson = tests[0].proportion_ci(0.95, "wilson")
    theirs = [test.pvalue for test in tests] + [exact.low, exact.high, wilson.low, wilson.high]
    return max(abs(a - b) for a, b in zip(found, theirs))


def proportion_correct(task, m, d):
    phi, cdf = stats.norm.pdf, stats.norm.cdf
    if task == "forced_choice":
        return integrate.quad(lambda x: phi(x - d) * cdf(x) ** (m - 1), d - 9, d + 9, epsabs=1e-13, limit=500)[0]
    if task == "oddity":
        shift = d * math.sqrt(2 / 3)
        return 2 * integrate.quad(lambda x: phi(x) * (cdf(shift - x * math.sqrt(3)) + cdf(-shift - x * math.sqrt(3))),
                                  0, 9, epsabs=1e-13, limit=500)[0]
    a, b = {"abx_independent": (d / math.sqrt(2), d / 2), "abx_differencing": (d / math.sqrt(2), d / math.sqrt(6)),
            "same_different": (d / 2, d / 2)}[task]
    return cdf(a) * cdf(b) + cdf(-a) * cdf(-b)


class Likelihood:
    """Written from the equations, in other parameters than Kerf's: location and log of the slope."""

    def __init__(self, row):
        self.row = row
        levels = numpy.array(row["levels"])
        self.x = numpy.log(levels[:, 0]) if row["logarithmic"] else levels[:, 0]
        self.k, self.n = levels[:, 1], levels[:, 2]
        span = self.x.max() - self.x.min()
        self.bounds = [(None, None), (math.log(0.05 / span), math.log(1000 / span)),
                       (0, 0) if row["lapse_fixed"] else (0, 0.06), (0, 0.9) if row["overdispersed"] else (0, 0)]

    def shape(self, z):
        name = self.row["shape"]
        if name == "weibull":
            return -numpy.expm1(-numpy.exp(numpy.minimum(z, 50.0)))
        return special.expit(z) if name == "logistic" else special.ndtr(z)

    def quantile(self, lapse):
        p = (self.row["criterion"] - self.row["guess"]) / (1 - self.row["guess"] - lapse)
        name = self.row["shape"]
        if name == "weibull":
            return math.log(-math.log1p(-p))
        return special.logit(p) if name == "logistic" else special.ndtri(p)

    def loss(self, at):
        location, log_slope, lapse, rho = at
        guess = self.row["guess"]
        p = numpy.clip(guess + (1 - guess - lapse) * self.shape(math.exp(log_slope) * (self.x - location)), 1e-12, 1 - 1e-12)
        if rho < 1e-7:
            return -numpy.sum(self.k * numpy.log(p) + (self.n - self.k) * numpy.log1p(-p))
        nu = (1 - rho) / rho
        return -numpy.sum(special.betaln(self.k + p * nu, self.n - self.k + (1 - p) * nu)
                          - special.betaln(p * nu, (1 - p) * nu))

    def best(self, threshold=None):
        """Least loss; with a threshold, over curves that reach the criterion there. From seven starts by Nelder and Mead."""
        def loss(free):
            log_slope, lapse, rho = free[-3:]
            location = free[0] if threshold is None else threshold - self.quantile(lapse) / math.exp(log_slope)
            return self.loss((location, log_slope, lapse, rho))
        bounds = self.bounds if threshold is None else self.bounds[1:]
        least = None
        for log_slope in (-0.5, 0.5, 1.0, 1.7, 3.0, 4.5, 6.0):
            start = [log_slope, sum(self.bounds[2]) / 2, 0.03 if self.row["overdispersed"] else 0.0]
            if threshold is None:
                start.insert(0, float(numpy.average(self.x)))
            start = [value if low is None else min(max(value, low), high) for value, (low, high) in zip(start, bounds)]
            found = optimize.minimize(loss, start, method="Nelder-Mead", bounds=bounds,
                                      options={"xatol": 1e-9, "fatol": 1e-11, "maxiter": 8000, "maxfev": 8000})
            found = optimize.minimize(loss, found.x, method="Nelder-Mead", bounds=bounds,
                                      options={"xatol": 1e-9, "fatol": 1e-11, "maxiter": 8000, "maxfev": 8000})
            if least is None or found.fun < least.fun:
                least = found
        return least

    def errors(self):
        """Of the log-likelihood, of the threshold (relative), and of the loss at both ends of the interval."""
        row = self.row
        best = self.best()
        location, log_slope, lapse, _ = best.x
        theirs = location + self.quantile(lapse) / math.exp(log_slope)
        axis = math.log if row["logarithmic"] else float
        parameters = 2 + (not row["lapse_fixed"]) + row["overdispersed"]
        wanted = (stats.f.ppf(0.95, 1, len(self.k) - parameters) if row["overdispersed"] else stats.chi2.ppf(0.95, 1))
        ends = [abs(2 * (self.best(axis(row[end])).fun - best.fun) - wanted) for end in ("lower", "upper")]
        here = (location, log_slope, lapse, best.x[3])
        kerf = self.loss((axis(row["alpha"]), math.log(row["beta"]), row["lapse"], row["rho"]))
        return kerf - self.loss(here), abs(axis(row["threshold"]) - theirs), max(ends)


def psignifit_errors(row):
    """Of Debian's psignifit 2.5.6: how far Kerf's log-likelihood is below its own, and the thresholds apart (as above). It prints six digits."""
    mine = Likelihood(row)
    is_weibull = row["shape"] == "weibull"  # which psignifit has over the level itself, and the others over what they are given
    data = "".join("%.17g %d %d\n" % (math.exp(x) if is_weibull else x, k, n) for x, k, n in zip(mine.x, mine.k, mine.n))
    lapse = "#fix_lambda %.17g" % row["lapse"] if row["lapse_fixed"] else "#lambda_limits 0 0.06"
    shape = {"weibull": "weibull", "logistic": "logistic", "gaussian": "cumulative gaussian"}[row["shape"]]
    asked = "#shape %s\n#n_intervals 1\n#fix_gamma %.17g\n%s\n#matrix_format xrn\n#runs 0\n#verbose false\n#write_pa_est -\n" % (
        shape, row["guess"], lapse)
    out = subprocess.run(["psignifit"], input="#data\n" + data + asked, check=True, capture_output=True, text=True).stdout
    alpha, beta, _, lapse = (float(number) for number in out.replace(",", " ").split())
    location, slope = (math.log(alpha), beta) if is_weibull else (alpha, 1.0 / beta)
    axis = math.log if row["logarithmic"] else float
    kerf = mine.loss((axis(row["alpha"]), math.log(row["beta"]), row["lapse"], 0.0))
    theirs = location + mine.quantile(lapse) / slope
    return kerf - mine.loss((location, math.log(slope), lapse, 0.0)), abs(axis(row["threshold"]) - theirs)


def main():
    house = pathlib.Path(sys.argv[1])
    program = str(house / "build/release/bin/kerf_psychophysics_benchmark")
    numbers = rows_of(program, "numbers")
    binomial = [binomial_error(row) for row in numbers if row["kind"] == "binomial"]
    tasks = [row for row in numbers if row["kind"] == "task"]
    forth = [abs(row["pc"] - proportion_correct(row["task"], row["intervals"], row["d"])) for row in tasks]
    back = [abs(row["d"] - row["back"]) for row in tasks]
    fits = rows_of(program, "fits")
    errors = numpy.array([Likelihood(row).errors() for row in fits])
    theirs = numpy.array([psignifit_errors(row) for row in fits if not row["overdispersed"]])
    times = sorted(row["seconds"] for row in fits if not row["overdispersed"])
    pooled = sorted(row["seconds"] for row in fits if row["overdispersed"])
    lines = ["| against SciPy, and psignifit 2.5.6 | cases | largest difference |", "|---|---|---|",
             "| exact tests, intervals of Clopper-Pearson and Wilson | %d | %.1e |" % (len(binomial), max(binomial)),
             "| proportion correct of d', eight tasks | %d | %.1e |" % (len(tasks), max(forth)),
             "| d' there and back | %d | %.1e |" % (len(tasks), max(back)),
             "| psychometric functions: log-likelihood below SciPy's best | %d | %.1e |" % (len(fits), errors[:, 0].max()),
             "| threshold (relative; absolute on a linear axis) | %d | %.1e |" % (len(fits), errors[:, 1].max()),
             "| twice the loss of log-likelihood at the ends of the 95 %% intervals | %d | %.1e |" % (len(fits), errors[:, 2].max()),
             "| psychometric functions without overdispersion: log-likelihood below psignifit's (it prints six digits) | %d | %.1e |" % (
                 len(theirs), theirs[:, 0].max()),
             "| threshold against psignifit's (relative; absolute on a linear axis): median | %d | %.1e |" % (
                 len(theirs), numpy.median(theirs[:, 1])),
             "| the same: largest | %d | %.1e |" % (len(theirs), theirs[:, 1].max()),
             "", "A fit with its intervals: %.2f ms (median), %.0f ms with overdispersion (36 rows)." % (
                 1e3 * times[len(times) // 2], 1e3 * pooled[len(pooled) // 2]), "",
             "**Coverage** of the 95 %% intervals over %d simulated experiments a row (one standard error: 0.7 %%), and false alarms at "
             "5 %%." % EXPERIMENTS, "", "| experiment | threshold (JND) | slope |", "|---|---|---|"]
    study = rows_of(program, "coverage", str(EXPERIMENTS))
    lines += ["| %s | %.1f %% | %.1f %% |" % (row["name"], 100 * row["threshold"], 100 * row["slope"])
              for row in study if row["kind"] == "coverage"]
    lines += ["", "| equal laws | false alarms |", "|---|---|"]
    lines += ["| %s | %.1f %% |" % (row["name"], 100 * row["share"]) for row in study if row["kind"] == "alarms"]
    body = "\n".join(lines)
    print(body)
    replace_section(house / "docs/benchmarks.md", "psychophysics", "Statistics of blind sessions", body)


if __name__ == "__main__":
    main()
