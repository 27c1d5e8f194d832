"""How often the 95 % intervals cover the truth, over 500 simulated recordings a row."""

import json
import subprocess
import tempfile

TRIALS = 500
LEAST, MOST = 0.93, 0.97


def part(house):
    with tempfile.TemporaryDirectory() as folder:
        path = folder + "/coverage.json"
        subprocess.run([str(house / "build/release/bin/kerf_coverage_study"), str(TRIALS), path], check=True,
                       capture_output=True)
        with open(path) as file:
            study = json.load(file)
    table, outside = {}, 0
    for row in study["rows"]:
        key = (row["scenario"], row["noise"], row["duration_s"])
        table.setdefault(key, []).append("%s %.1f %%" % (row["parameter"], 100.0 * row["coverage"]))
        outside += not LEAST <= row["coverage"] <= MOST
    lines = ["**Coverage of the 95 %% intervals** over %d simulated recordings a row, at 1 kHz. The share itself is known to "
             "%.1f %% (one standard error)." % (TRIALS, 100.0 * (0.95 * 0.05 / TRIALS) ** 0.5), "",
             "| law and path | noise | recording | coverage |", "|---|---|---|---|"]
    for (scenario, noise, duration_s), cells in table.items():
        lines.append("| %s | %s | %.0f s | %s |" % (scenario, noise, duration_s, ", ".join(cells)))
    return "\n".join(lines + ["", "Outside %.0f to %.0f %%: %d of %d." % (
        100.0 * LEAST, 100.0 * MOST, outside, len(study["rows"]))])
