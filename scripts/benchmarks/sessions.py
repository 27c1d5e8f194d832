# peers: python3-numpy python3-scipy r-base-core r-cran-lme4 r-cran-jsonlite
# targets: kerf_people_study kerf_looks_study
"""Tests of people over simulated studies: false alarms, equivalence, coverage and power; numbers against lme4, glm and SciPy."""

import json
import pathlib
import subprocess
import sys

import numpy
from scipy import stats

from population import alarm, rows_of, told
from sections import replace_section

ALARMS = 10000
EQUIVALENCE = 4000
COVERAGE = 1000
POWER = 4000
LOOKS = 10000
ORACLE = 20


def share(count, trials):
    return "%.1f" % (100.0 * count / trials)


def repeated(program, what, studies, is_outside):
    """Cells outside the band are run again with ten times the studies."""
    rows = rows_of(program, what, str(studies))
    outside = [number for number, row in enumerate(rows) if is_outside(row)]
    if outside:
        for number, row in zip(outside, rows_of(program, what, str(10 * studies), *map(str, outside)), strict=True):
            rows[number] = row
    return rows


def alarm_table(rows):
    lines = ["**False alarms** [%] at 5 %: nothing to find on the average of people, whose logits (of answers right or for the first; "
             "worths of samples) have a standard deviation between them. By the main test, over subjects, and by the test of pooled answers "
             "that it replaced. **more**: the exact 99.9 % interval of the share lies above 5 %.", "",
             "| design | subjects | " + " | ".join("sd %d: people" % sd + " | answers" for sd in (0, 1, 2)) + " |", "|---|---|" + "---|" * 6]
    for design, subjects in dict.fromkeys((row["design"], row["subjects"]) for row in rows):
        cells = [row for row in rows if row["design"] == design and row["subjects"] == subjects]
        values = [value for row in cells for value in (alarm(row["people"], row["studies"]), alarm(row["answers"], row["studies"]))]
        lines.append("| %s, %d trials | %d | %s |" % (design, cells[0]["trials"], subjects, " | ".join(values)))
    return lines + ["", "%d studies a cell, cells with **more** repeated with ten times as many." % min(row["studies"] for row in rows)]


def equivalence_table(rows):
    lines = ["**\"d' is below 1\"** of ABX, how often it is said [%]: some hear at a d', the others guess.", "",
             "| subjects | of whom hear | at d' | trials each | of people | of pooled answers |", "|---|---|---|---|---|---|"]
    for row in rows:
        lines.append("| %d | %d | %g | %d | %s | %s |" % (row["subjects"], row["hearing"], row["d_prime"], row["trials"],
                                                        share(row["people"], row["studies"]), share(row["answers"], row["studies"])))
    return lines


def coverage_table(rows):
    lines = ["**Coverage** [%%] of the 95 %% intervals of the mixed model, %d studies a cell: observers who lapse in 2 %% of the trials; sd 1 is half a JND "
             "between PSEs and a factor of 1.28 between JNDs, sd 2 twice that (of the logarithm). Low or high: the exact 99.9 %% interval of "
             "the share does not touch 93 to 97 %%." % min(row["studies"] for row in rows), "",
             "| design | subjects | sd | trials a level | JND told | JND | PSE |", "|---|---|---|---|---|---|---|"]
    for row in rows:
        lines.append("| %s | %d | %g | %d | %s | %s | %s |" % (row["design"], row["subjects"], row["sd"], row["trials"],
                                                           share(row["told"], row["studies"]), told(row["jnd"], row["told"]),
                                                           "" if row["pse"] < 0 else told(row["pse"], row["told"])))
    return lines


def power_table(rows):
    lines = ["**Power** [%] of two intervals, 12 trials each, over subjects whose logits of being right have this mean and standard deviation.", "",
             "| mean logit | sd | 8 subjects | 12 | 24 |", "|---|---|---|---|---|"]
    for effect, sd in dict.fromkeys((row["effect"], row["sd"]) for row in rows):
        values = [share(row["people"], row["studies"]) for row in rows if row["effect"] == effect and row["sd"] == sd]
        lines.append("| %g | %g | %s |" % (effect, sd, " | ".join(values)))
    return lines


def looks_table(rows):
    """Of a Bayes factor no level was promised."""
    lines = ["**Looks** at half, three quarters and all of the participants, 12 trials each, primary test at 5 %%, %d studies a cell [%%]: false alarms "
             "where nothing is to be found and the logits of people have a standard deviation; power, and how many participants it took, where their mean is 0.5 and "
             "their sd 0.5. **more**: the exact 99.9 %% interval of the share lies above 5 %%. Unpaid: 5 %% at each look." % rows[0]["studies"], "",
             "| rule | design | participants | sd 0 | sd 1 | sd 2 | power | participants it took |", "|---|---|---|---|---|---|---|---|"]
    for rule, design, subjects in dict.fromkeys((row["rule"], row["design"], row["subjects"]) for row in rows):
        cells = [row for row in rows if (row["rule"], row["design"], row["subjects"]) == (rule, design, subjects)]
        alarms = [alarm(row["shown"], row["studies"]) for row in cells if row["mean"] == 0]
        found = next(row for row in cells if row["mean"] > 0)
        lines.append("| %s | %s | %d | %s | %s | %.1f |" % (rule, design, subjects, " | ".join(alarms), share(found["shown"], found["studies"]),
                                                       found["participants"]))
    return lines


def largest_differences(house, program):
    printed = subprocess.run([program, "oracle", str(ORACLE)], check=True, capture_output=True, text=True).stdout
    ours = [json.loads(line) for line in printed.splitlines()]
    script = house / "scripts" / "benchmarks" / "people_peers.R"
    theirs = subprocess.run(["Rscript", str(script)], input=printed, check=True, capture_output=True, text=True).stdout
    worst = {}

    def note(name, difference):
        worst[name] = max(worst.get(name, 0.0), abs(difference))

    asked = [row for row in ours if row["kind"] != "flips"]
    for mine, peer in zip(asked, map(json.loads, theirs.splitlines()), strict=True):
        if mine["kind"] == "mixed":
            for key in ("threshold", "slope", "deviation"):
                note("%s of the mixed model, against lme4's, relative" % key, mine[key] / peer[key] - 1.0)
            # Above theirs is no fault.
            note("log-likelihood below that at lme4's optimum", max(0.0, peer["log_likelihood"] - mine["log_likelihood"]))
        else:
            note("worths of Bradley-Terry, against glm", numpy.max(numpy.abs(numpy.subtract(mine["differences"], peer["differences"]))))
            note("their errors over subjects, a step of Newton's for each left out, against glm fitted anew, relative",
                 numpy.max(numpy.abs(numpy.divide(mine["errors"], peer["errors"]) - 1.0)))
    for row in (row for row in ours if row["kind"] == "flips"):
        for side, key in (("greater", "p_greater"), ("two-sided", "p_two_sided")):
            peer = stats.permutation_test((numpy.array(row["values"]),), numpy.mean, permutation_type="samples", n_resamples=numpy.inf,
                                          alternative=side).pvalue
            note("p of flipped signs, against SciPy's permutation_test", row[key] - peer)
    return ["**Against others**, the largest difference over %d studies:" % ORACLE, "", "| what | difference |", "|---|---|",
            *("| %s | %.1g |" % item for item in worst.items())]


def main(house, scale=1.0):
    program = str(house / "build" / "release" / "bin" / "kerf_people_study")
    looks = rows_of(str(house / "build" / "release" / "bin" / "kerf_looks_study"), str(max(10, int(scale * LOOKS))))

    def number(studies):
        return max(10, int(scale * studies))

    alarms = repeated(program, "alarms", number(ALARMS), lambda row: "more" in alarm(row["people"], row["studies"]))
    coverage = repeated(program, "coverage", number(COVERAGE),
                        lambda row: "low" in told(row["jnd"], row["told"]) or (row["pse"] >= 0 and "low" in told(row["pse"], row["told"])))
    equivalence = rows_of(program, "equivalence", str(number(EQUIVALENCE)))
    power = rows_of(program, "power", str(number(POWER)))
    lines = [*largest_differences(house, program), "", *alarm_table(alarms), "", *equivalence_table(equivalence), "",
             *coverage_table(coverage), "", *power_table(power), "", *looks_table(looks)]
    print("\n".join(lines))
    replace_section(house / "docs" / "benchmarks.md", "sessions", "Sessions: what holds for people", "\n".join(lines))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), *map(float, sys.argv[2:]))
