# peers: python3-scipy
# targets: kerf_people_study
"""Same or different over simulated people, some of whom lean to "same": false alarms and power of the test by flipped signs."""

import pathlib
import sys

from population import exact, rows_of
from sections import replace_section

ALARMS = 10000
POWER = 2000
LEVEL = 0.05
SUBJECTS = (8, 12, 24)
SDS = (0, 1, 2)


def off_level(row):
    """The exact interval of the share lies below the level ("less") or above ("more")."""
    lower, upper = exact(row["people"], row["studies"])
    return "less" if upper < LEVEL else "more" if lower > LEVEL else ""


def share(row):
    return "%.1f" % (100.0 * row["people"] / row["studies"])


def cells(rows, text):
    """One line for each d' and leaning."""
    lines = ["| d' | leaning | \"different\" where they are, are not | " +
             " | ".join("sd %d: %d people" % (sd, n) if n == SUBJECTS[0] else "%d" % n for sd in SDS for n in SUBJECTS) + " |",
             "|---|---|---|" + "---|" * (len(SDS) * len(SUBJECTS))]
    for d_prime, bias in dict.fromkeys((row["d_prime"], row["bias"]) for row in rows):
        own = {(row["sd"], row["subjects"]): row for row in rows if (row["d_prime"], row["bias"]) == (d_prime, bias)}
        rates = own[SDS[0], SUBJECTS[0]]
        lines.append("| %g | %g | %.0f %%, %.0f %% | %s |" % (d_prime, bias, 100.0 * rates["hit"], 100.0 * rates["false_alarm"],
                                                       " | ".join(text(own[sd, n]) for sd in SDS for n in SUBJECTS)))
    return lines


def alarm_lines(rows):
    def text(row):
        side = off_level(row)
        return share(row) + (" **%s**" % side if side else "")

    count = {side: sum(off_level(row) == side for row in rows) for side in ("less", "more")}
    return ["**False alarms** [%%] at 5 %%: nobody feels a difference on the average of people; %d trials each, half of them different, %d studies a cell. "
            "Leaning to \"same\" as by `--bias`. sd: of people's logits of being right, so that some feel one and some answer against it. "
            "**less**, **more**: the exact 99.9 %% interval of the share lies below, above 5 %%: %d and %d of %d cells." % (
                rows[0]["trials"], rows[0]["studies"], count["less"], count["more"], len(rows)), "", *cells(rows, text)]


def power_lines(rows):
    return ["**Power** [%%]: people who go by the likelihood ratio, %d trials each, lapses in 2 %%, %d studies a cell; sd as above." % (
        rows[0]["trials"], rows[0]["studies"]), "", *cells(rows, share)]


def main(house, scale=1.0):
    program = str(house / "build" / "release" / "bin" / "kerf_people_study")
    alarms = rows_of(program, "words", str(max(10, int(scale * ALARMS))))
    power = rows_of(program, "words-power", str(max(10, int(scale * POWER))))
    body = "\n".join([*alarm_lines(alarms), "", *power_lines(power)])
    print(body)
    replace_section(house / "docs" / "benchmarks.md", "same-different", "Same or different: what holds for people", body)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), *map(float, sys.argv[2:]))
