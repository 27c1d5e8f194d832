# peers: python3-scipy
# targets: kerf kerf-reader
"""How often the intervals of `kerf identify` hold the truth of simulated axes, and whether what does not fit is said not to, and named.

    scripts/benchmark identify [--plain 200] [--others 50] [--wrong 30] [--workers 2]

Rows stay in build/benchmarks/identify.jsonl: a study that was stopped goes on where it ended, as long as the sources of the numbers are the same.
"""

import argparse
import pathlib
import statistics
import sys

from identify_draws import RIGHT, WRONG, rows_of, sources_of
from population import LEAST, MOST, exact
from sections import replace_section

NUMBERS = ("mass", "viscous", "coulomb", "stiffness", "constant_force", "delay_s", "delay_jitter_s", "motor_constant", "saturation")
FREQUENCY = ("mass", "viscous", "stiffness", "delay_s")


def tally(rows, name, of=lambda found: found):
    """Of a number: how often it was told and held, its bias as a share of the values, errors as shares of the interval, and half intervals."""
    errors, truths, shares, halves, held, silent = [], [], [], [], 0, 0
    for row in rows:
        truth = row["truth"].get(name)
        if truth is None or row["found"] is None or "mass" not in row["found"]:
            continue
        value = of(row["found"]).get(name)
        value = value[0] if isinstance(value, list) else value
        if value is None or value["value"] is None:
            silent += 1
            continue
        half = 0.5 * (value["upper"] - value["lower"])
        held += value["lower"] <= truth <= value["upper"]
        errors.append(value["value"] - truth)
        truths.append(abs(truth))
        shares.append((value["value"] - truth) / max(2.0 * half, 1e-300))
        halves.append(half / (abs(truth) or 1.0))
    return {"trials": len(errors), "held": held, "silent": silent, "bias": sum(errors) / (sum(truths) or len(errors) or 1), "shares": shares, "halves": halves}


def line(kind, name, tallied, zero=False):
    trials, held = tallied["trials"], tallied["held"]
    lower, upper = exact(held, trials)
    # What is zero is held by every interval from 0: half of those that miss cannot.
    said = "" if zero else " **low**" if upper < LEAST else " **high**" if lower > MOST else ""
    mean, share = tallied["bias"], statistics.mean(tallied["shares"])
    biased = " **biased**" if not zero and abs(mean) > 0.01 and abs(share) > 0.1 else ""
    value = ("%+.2g us" % (1e6 * mean), "%.2g us" % (1e6 * statistics.median(tallied["halves"]))) if zero else (
        "%+.2g %%" % (100.0 * mean), "%.2g %%" % (100.0 * statistics.median(tallied["halves"])))
    return "| %s | %s | %d of %d, %.1f %%%s | %.1f to %.1f %% | %s%s | %+.2f | %s | %d |" % (
        kind, name, held, trials, 100.0 * held / trials, said, 100.0 * lower, 100.0 * upper, value[0], biased, share, value[1], tallied["silent"])


def right_table(rows):
    lines = ["| axes | number | held by its interval | exact 99.9 % interval | bias, of the value | bias, of the interval | half interval, median | told unknown |",
             "|---|---|---|---|---|---|---|---|"]
    for kind in RIGHT:
        of_kind = [row for row in rows if row["kind"] == kind]
        # Each number is judged where it is the point, and all of them on plain axes.
        for name in NUMBERS if kind == "plain" else ("mass", "coulomb", "constant_force", "delay_s",
                                                     {"jitter": "delay_jitter_s", "motor constant": "motor_constant"}.get(kind, kind)):
            tallied = tally(of_kind, name)
            if tallied["trials"]:
                lines.append(line(kind, name, tallied, zero=kind == "plain" and name == "delay_jitter_s"))
        for name in FREQUENCY if kind == "plain" else ():
            tallied = tally(of_kind, name, lambda found: found.get("frequency", {}))
            if tallied["trials"]:
                lines.append(line(kind, name + ", frequency domain", tallied))
    return lines


def judgements(rows):
    """What is said of axes that the model describes."""
    right = [row for row in rows if row["kind"] in RIGHT]
    told = [row["found"] for row in right if row["found"] is not None and "mass" in row["found"]]
    plain = [row["found"] for row in right if row["kind"] != "saturation" and row["found"] is not None and "mass" in row["found"]]
    steps = [abs(row["found"]["encoder_step"] / row["truth"]["encoder_step"] - 1.0) for row in right
             if row["found"] is not None and row["found"].get("encoder_step")]
    return [
        "Of these %d axes, %d were not measured to their end, and of %d the encoder step was told, at most %.1g from the truth. "
        "Said not to fit though nothing is missing: %d of %d. A saturation where there was none: %d of %d. The two domains said to differ: %s of %d axes." % (
            len(right), sum(row["found"] is None or bool(row["found"]["problem"]) for row in right), len(steps), max(steps),
            sum(found["fits"] is False for found in told), len(told), sum(found["saturation"] is not None for found in plain), len(plain),
            ", ".join("%s in %d" % (name, sum(any(one["name"] == name and not one["agrees"] for one in found["domains"]) for found in told))
                      for name in ("mass", "viscous", "coulomb", "stiffness", "delay")), len(told))]


def wrong_table(rows):
    lines = ["| axes with | said not to fit | named right | named as another | not named | not measured |", "|---|---|---|---|---|---|"]
    for kind in WRONG:
        of_kind = [row for row in rows if row["kind"] == kind]
        if not of_kind:
            continue
        told = [row["found"] for row in of_kind if row["found"] is not None and "mass" in row["found"]]
        refused = [found for found in told if found["fits"] is False]
        right = sum(found["missing"] == kind for found in refused)
        unnamed = sum(found["missing"] is None for found in refused)
        through = [found["validation_error"] for found in told if found["fits"] is True]
        lines.append("| %s | %d of %d%s | %d | %d | %d | %d |" % (
            kind, len(refused), len(told), "" if not through else " (the others predicted to %.2g to %.2g %%)" % (100.0 * min(through), 100.0 * max(through)),
            right, len(refused) - right - unnamed, unnamed, len(of_kind) - len(told)))
    return lines


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("house", type=pathlib.Path)
    parser.add_argument("--plain", type=int, default=200)
    parser.add_argument("--others", type=int, default=50)
    parser.add_argument("--wrong", type=int, default=30)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=1e9, help="begin no draw after so many; what there is by then is judged")
    given = parser.parse_args()
    counts = {kind: given.plain if kind == "plain" else given.others for kind in RIGHT} | {kind: given.wrong for kind in WRONG}
    # All kinds by turns, so that a study that ends early has some of each.
    wanted = sorted(((kind, number) for kind, count in counts.items() for number in range(count)), key=lambda it: (it[1] / counts[it[0]], it[0]))
    rows = rows_of(given.house / "build/benchmarks/identify.jsonl", sources_of(given.house), str(given.house / "build/release/bin/kerf"), wanted,
                   given.workers, given.seconds)
    done = {kind: sum(row["kind"] == kind for row in rows) for kind in counts}
    body = "\n".join([
        "%d axes of `sim:axis` drawn at random, every other one in a hand: mass 0.05 to 0.3 kg, viscous friction 0.1 to 2 N·s/m, Coulomb friction "
        "0.02 to 0.3 N, gravity to 0.3 N, delay 0 to 3.7 ticks, encoder steps 2 to 20 um, hands of 0.1 to 0.2 kg, 2 to 8 N·s/m, 100 to 600 N/m. "
        "%d more with a delay that jitters by 30 to 200 us (delay from one tick on), %d held with a sensor and a motor constant of 0.7 to 1.3, %d free with a "
        "motor that gives 0.5 to 0.9 N at most (Coulomb friction to 0.1 N). `kerf identify --max-force 2`, 30 s of virtual time each. Low or high: the exact "
        "99.9 %% interval of the share does not touch %.0f to %.0f %%; biased: by more than 1 %% of the value and a tenth of the interval." % (
            *(done[kind] for kind in RIGHT), 100 * LEAST, 100 * MOST), "",
        *right_table(rows), "", *judgements(rows), "",
        "Backlash of 0.1 to 0.4 mm, cogging of 0.05 to 0.2 N each 1 to 4 mm, links of 1 to 5 N/mm with half of the mass behind them:", "",
        *wrong_table(rows)])
    print(body)
    replace_section(given.house / "docs/benchmarks.md", "identify", "Devices identified", body)


if __name__ == "__main__":
    sys.exit(main())
