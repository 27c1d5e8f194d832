"""How often the 95 % intervals hold what they should, over 2,000 simulated recordings a cell. A cell whose exact 99.9 %
interval does not touch 93 to 97 % is repeated with ten times as many, drawn anew. Each cell is kept in build/coverage/ as it
comes, by the program that made it: a study that was interrupted goes on where it was.
"""

import hashlib
import json
import os
import subprocess
import tempfile

from scipy.stats import beta

TRIALS = 2000
AGAIN = 10
LEAST, MOST = 0.93, 0.97
SECONDS = (2, 10)


def exact(held, trials, level=0.999):
    """Clopper and Pearson's interval of a share."""
    tail = 0.5 * (1.0 - level)
    lower = beta.ppf(tail, held, trials - held + 1) if held > 0 else 0.0
    upper = beta.ppf(1.0 - tail, held + 1, trials - held) if held < trials else 1.0
    return lower, upper


def study(house, trials, *more):
    """Rows of the program, made now or before."""
    program = house / "build/release/bin/kerf_coverage_study"
    maker = hashlib.sha256(program.read_bytes()).hexdigest()[:12]
    kept = house / "build/coverage" / ("-".join(map(str, (maker, trials, *more))) + ".json")
    if not kept.exists():
        kept.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=kept.parent) as folder:
            path = folder + "/cell.json"
            subprocess.run([str(program), str(trials), path, *map(str, more)], check=True, capture_output=True)
            os.replace(path, kept)
    with open(kept) as file:
        return json.load(file)["rows"]


def verdict(held, trials):
    lower, upper = exact(held, trials)
    return "low" if upper < LEAST else "high" if lower > MOST else "in"


def cells_of(house, seconds):
    """Cells in order: rows of one study, those again that were too low."""
    cells = []
    for number in (row["cell"] for row in study(house, 0, seconds)):
        rows = [dict(row, trials=TRIALS) for row in study(house, TRIALS, seconds, 0, number)]
        if any(verdict(row["held"], TRIALS) == "low" for row in rows):
            rows = [dict(row, trials=AGAIN * TRIALS) for row in study(house, AGAIN * TRIALS, seconds, TRIALS, number)]
        cells.append(rows)
    return cells


def told(row):
    share = "%.1f" % (100.0 * row["held"] / row["trials"])
    mark = {"low": " **low**", "high": " (high)", "in": ""}[verdict(row["held"], row["trials"])]
    return "%s %s%s" % (row["parameter"].replace("_stiffness", ""), share, mark)


def table(cells):
    lines = ["**Coverage** of the 95 %% intervals [%%] over %d simulated recordings a cell, at 1 kHz, 0.02 N of noise, by the whole way of a "
             "fit. \"Cycles\": strokes by a hand, each a cycle. \"On\": the law misfits, and the target is what it fits best "
             "without noise. Low or high: the exact 99.9 %% interval of the share does not touch %.0f to %.0f %%; what was low was "
             "repeated with ten times as many, and it is those that are shown." % (TRIALS, 100.0 * LEAST, 100.0 * MOST), "",
             "| law and path | noise | recording | coverage |", "|---|---|---|---|"]
    for rows in cells:
        lines.append("| %s | %s | %.0f s | %s |" % (rows[0]["scenario"], rows[0]["noise"], rows[0]["duration_s"],
                                                  ", ".join(told(row) for row in rows)))
    verdicts = [verdict(row["held"], row["trials"]) for rows in cells for row in rows]
    flicker = [verdict(row["held"], row["trials"]) for rows in cells for row in rows if row["noise"] == "pink"]
    return lines + ["", "Of %d intervals %d are low, %d of them under flicker noise, and %d high." % (
        len(verdicts), verdicts.count("low"), flicker.count("low"), verdicts.count("high"))]


def part(house):
    return "\n".join(table([cell for seconds in SECONDS for cell in cells_of(house, seconds)]))
