# peers: python3-scipy
# targets: kerf_calibration_study
"""How often the intervals of `kerf calibrate` hold the truth, and how far off it is in the mean, over simulated sensors."""

import json
import pathlib
import subprocess
import sys

from scipy.stats import beta

from sections import replace_section

SENSORS = 2000
LEAST, MOST = 0.93, 0.97


def exact(held, trials, level=0.999):
    """Clopper and Pearson's interval of a share."""
    tail = 0.5 * (1.0 - level)
    lower = beta.ppf(tail, held, trials - held + 1) if held > 0 else 0.0
    upper = beta.ppf(1.0 - tail, held + 1, trials - held) if held < trials else 1.0
    return lower, upper


def coverage(part, trials):
    """Least and most over the numbers, and how many lie outside."""
    if part is None:
        return "not fitted"
    shares = [100.0 * held / trials for held in part["held"]]
    outside = sum(exact(held, trials)[1] < LEAST or exact(held, trials)[0] > MOST for held in part["held"])
    return "%.1f to %.1f%s" % (min(shares), max(shares), ", **%d of %d outside**" % (outside, len(shares)) if outside else "")


def bias(part):
    """The largest bias: in shares of the half width and of the value, whichever allows it (a tenth, 1 %)."""
    worst = max(zip(part["bias_of_half_width"], part["bias_of_value"]), key=lambda one: min(abs(one[0]) / 0.1, abs(one[1]) / 0.01))
    return "%.3f, %.2g %%" % (abs(worst[0]), 100.0 * abs(worst[1]))


def body_of(rows):
    trials = rows[0]["sensors"]
    lines = ["**Coverage** of the 95 %% intervals [%%] over %d simulated sensors a row, least and most over the numbers of a column. Outside: the "
             "exact 99.9 %% interval of the share does not touch %.0f to %.0f %%. Six components, six signals, 84 holds: three weights up and down, both "
             "ways along and about each axis; cross-talk 3 %%, repeatability 0.5 mV of 8 V, weights off by 0.05 %%, drift, temperature." % (
                 trials, 100 * LEAST, 100 * MOST), "",
             "| sensors | matrix (36) | bias (6) | drift (6) | per kelvin (6) | hysteresis (6) | repeatability found | largest bias of the matrix: of "
             "the half width, of the value |", "|---|---|---|---|---|---|---|---|"]
    for row in rows:
        values = [coverage(row[key], trials) for key in ("matrix", "bias", "drift", "per_kelvin", "hysteresis")]
        lines.append("| %s | %s | %.3f mV | %s |" % (row["cell"], " | ".join(values), 1e3 * row["repeatability"], bias(row["matrix"])))
    lines += ["", "Those outside are cross-talk of the axis that is loaded first, from a play in its middle: [preload](calibrating.md#limits)."]
    return "\n".join(lines)


def main():
    house = pathlib.Path(sys.argv[1])
    program = str(house / "build/release/bin/kerf_calibration_study")
    out = subprocess.run([program, str(SENSORS)], check=True, capture_output=True, text=True).stdout
    body = body_of([json.loads(line) for line in out.splitlines()])
    print(body)
    replace_section(house / "docs/benchmarks.md", "calibrate", "Calibration of force sensors", body)


if __name__ == "__main__":
    main()
