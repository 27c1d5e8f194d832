# peers: python3-scipy
# targets: kerf_population_study
"""How often the intervals of a study over many recordings hold the truth, and how often its tests alarm, over simulated drawers."""

import json
import math
import pathlib
import subprocess
import sys

from scipy.stats import beta

from sections import replace_section

COVERAGE = 4000
ALARMS = 10000
POWER = 2000
LEAST, MOST = 0.93, 0.97


def rows_of(program, *arguments):
    out = subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout
    return [json.loads(line) for line in out.splitlines()]


def exact(held, trials, level=0.999):
    """Clopper and Pearson's interval of a share."""
    tail = 0.5 * (1.0 - level)
    lower = beta.ppf(tail, held, trials - held + 1) if held > 0 else 0.0
    upper = beta.ppf(1.0 - tail, held + 1, trials - held) if held < trials else 1.0
    return lower, upper


def told(held, trials):
    lower, upper = exact(held, trials)
    return "%.1f%s" % (100.0 * held / trials, " **low**" if upper < LEAST else " (high)" if lower > MOST else "")


def alarm(count, trials, level=0.05):
    """Too many: the exact interval lies above the level."""
    return "%.1f%s" % (100.0 * count / trials, " **more**" if exact(count, trials)[0] > level else "")


def coverage_table(rows):
    lines = ["**Coverage** of the 95 %% intervals [%%] over %d simulated drawers a cell: logarithms, spread 0.1 between recordings, standard "
             "errors of 0.025 to 0.075. Low or high: the exact 99.9 %% interval of the share does not touch %.0f to %.0f %%." % (
                 rows[0]["trials"], 100 * LEAST, 100 * MOST), "",
             "| between specimens | specimens | drawer | mean | spread between specimens | between recordings | next specimen | "
             "difference of tissues | of speeds |", "|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        within = told(row["within"], row["trials"]) if row["has_within"] else "not known"
        values = [told(row[key], row["trials"]) for key in ("mean", "between_held", "next", "tissues", "speeds")]
        between = values[1] if row["has_within"] else values[1] + ", both together"
        lines.append("| %g | %d | %s | %s | %s | %s | %s | %s | %s |" % (row["between"], row["specimens"], row["cell"], values[0], between,
                                                                  within, *values[2:]))
    return lines


def alarm_table(rows):
    lines = ["**False alarms** [%%] at 5 %% over %d studies a cell of 3 tissues x 2 speeds, nine comparisons each. More: the exact 99.9 %% "
             "interval lies above 5 %%." % rows[0]["trials"], "",
             "| between specimens | specimens | drawer | any \"differ\" in a study | one test of tissues | one test of speeds |",
             "|---|---|---|---|---|---|"]
    return lines + ["| %g | %d | %s | %s |" % (row["between"], row["specimens"], row["cell"], " | ".join(
        alarm(row[key], row["trials"]) for key in ("any", "tissues", "speeds"))) for row in rows]


def power_table(rows):
    lines = ["**Power** [%%] over %d studies a cell: the first tissue and the second speed differ from the others by a ratio; \"differ\" after "
             "Holm over nine comparisons, in brackets one test alone." % rows[0]["trials"], "",
             "| ratio | between specimens | specimens | tissues | speeds |", "|---|---|---|---|---|"]
    for row in rows:
        share = {key: 100.0 * row[key] / row["trials"] for key in ("told_tissues", "tissues", "told_speeds", "speeds")}
        lines.append("| %s | %g | %d | %.0f (%.0f) | %.0f (%.0f) |" % (row["cell"].split()[1], row["between"], row["specimens"],
                                                              *share.values()))
    return lines


def least_table():
    lines = ["**What can be told** at all at 5 %: comparisons of two groups of n specimens each that Holm's correction leaves room for.", "",
             "| specimens a group | least p | comparisons |", "|---|---|---|"]
    for n in range(2, 9):
        least = 2.0 / math.comb(2 * n, n)
        lines.append("| %d | %.2g | %d |" % (n, least, math.floor(0.05 / least)))
    return lines


def body_of(coverage, alarms, power):
    return "\n".join([*coverage_table(coverage), "", *alarm_table(alarms), "", *power_table(power), "", *least_table()])


def main():
    house = pathlib.Path(sys.argv[1])
    program = str(house / "build/release/bin/kerf_population_study")
    body = body_of(rows_of(program, "coverage", str(COVERAGE)), rows_of(program, "alarms", str(ALARMS)), rows_of(program, "power", str(POWER)))
    print(body)
    replace_section(house / "docs/benchmarks.md", "population", "Statistics of studies over many recordings", body)


if __name__ == "__main__":
    main()
