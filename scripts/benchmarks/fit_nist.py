"""The eight nonlinear regressions of higher difficulty of NIST StRD: digits and times, against SciPy."""

import json
import statistics
import subprocess
import time
import warnings

import numpy
from scipy.optimize import least_squares

TURNS = 5
DIGITS = 8.0

MODELS = {
    "MGH09": lambda b, x: b[0] * (x * x + b[1] * x) / (x * x + b[2] * x + b[3]),
    "Thurber": lambda b, x: (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / (1.0 + x * (b[4] + x * (b[5] + x * b[6]))),
    "BoxBOD": lambda b, x: b[0] * (1.0 - numpy.exp(-b[1] * x)),
    "Rat42": lambda b, x: b[0] / (1.0 + numpy.exp(b[1] - b[2] * x)),
    "MGH10": lambda b, x: b[0] * numpy.exp(b[1] / (x + b[2])),
    "Eckerle4": lambda b, x: b[0] / b[1] * numpy.exp(-0.5 * ((x - b[2]) / b[1]) ** 2),
    "Rat43": lambda b, x: b[0] / (1.0 + numpy.exp(b[1] - b[2] * x)) ** (1.0 / b[3]),
    "Bennett5": lambda b, x: b[0] * (b[1] + x) ** (-1.0 / b[2]),
}


def read(path):
    values, rows = {}, []
    for line in path.read_text().splitlines():
        cells = line.split(",")
        if line.startswith("#") or cells[0] == "x":
            continue
        if cells[0][0].isalpha():
            values[cells[0]] = numpy.array([float(cell) for cell in cells[1:]])
        else:
            rows.append([float(cell) for cell in cells])
    return values, numpy.array(rows)


def digits(found, certified):
    with numpy.errstate(divide="ignore"):
        return float(numpy.clip(-numpy.log10(numpy.abs(found - certified) / numpy.abs(certified)), 0.0, 11.0).min())


def with_scipy(folder, name, start):
    """Tolerances as tight as they go, central differences, scales from the Jacobian: what a user would turn to."""
    values, rows = read(folder / (name.lower() + ".csv"))
    model = MODELS[name]
    seconds = []
    found = None
    for _ in range(TURNS):
        begin = time.perf_counter()
        try:
            with warnings.catch_warnings(), numpy.errstate(all="ignore"):
                warnings.simplefilter("ignore")
                found = least_squares(lambda b: model(b, rows[:, 0]) - rows[:, 1], values["start_%d" % start], jac="3-point",
                                      method="trf", x_scale="jac", ftol=1e-15, xtol=1e-15, gtol=1e-15, max_nfev=5000).x
        except ValueError:  # residuals that are not finite
            found = None
        seconds.append(time.perf_counter() - begin)
    return (digits(found, values["certified"]) if found is not None else 0.0), statistics.median(seconds)


def part(house):
    folder = house / "tests/fitting/nist"
    program = str(house / "build/release/bin/kerf_fit_benchmark")
    kerf = json.loads(subprocess.run([program, "nist", str(folder), str(TURNS)], check=True, capture_output=True,
                                     text=True).stdout)
    lines = ["**NIST StRD, nonlinear, higher difficulty**: digits of the worst parameter (of 11 certified) and the time, from "
             "either start. Kerf begins at the start and at scaled copies of it; SciPy is `least_squares` with `trf`, central "
             "differences, `x_scale=\"jac\"` and tolerances of 1e-15, from the start alone.", "",
             "| problem | start | Kerf: digits | of the sum of squares | ms | SciPy: digits | ms |", "|---|---|---|---|---|---|---|"]
    least = 11.0
    solved = 0
    for row in kerf:
        theirs, seconds = with_scipy(folder, row["problem"], row["start"])
        least = min(least, row["digits"], row["digits_of_squares"])
        solved += theirs >= DIGITS
        lines.append("| %s | %d | %.1f | %.1f | %.2f | %.1f | %.1f |" % (
            row["problem"], row["start"], row["digits"], row["digits_of_squares"], 1e3 * statistics.median(row["seconds"]),
            theirs, 1e3 * seconds))
    return "\n".join(lines + ["", "Kerf's worst is %.1f digits, %.0f asked for: %s. SciPy has %.0f digits or more in %d of %d." % (
        least, DIGITS, "met" if least >= DIGITS else "missed", DIGITS, solved, len(kerf))])
