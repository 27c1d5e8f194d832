# peers: python3-numpy python3-scipy
# targets: kerf
"""Forces that are changed on purpose, by hundreds: does `kerf compare` name what was done? The changes, the laws
that are changed, and the check whether another name makes the same difference are NumPy's and SciPy's. `scripts/benchmark
diagnosis NAME...` makes the changes of these names alone, and prints what went wrong."""

import collections
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

import diagnosis_bases
import diagnosis_changes
from sections import replace_section

AXES = ["x", "y", "z", "rx", "ry", "rz"]
REPEATS = 3
SEED = int(os.environ.get("KERF_SEED", 1))


def table(file, base, x, force):
    heads = ["time [s]"] + ["%s [m]" % AXES[a] for a in range(x.shape[1])]
    heads += ["%s [%s]" % (AXES[a], unit) for a, unit in enumerate(base.units)]
    rows = np.column_stack([base.times(len(force)), x, force])
    pattern = ",".join(["%.17g"] * rows.shape[1])
    file.write_text(",".join(heads) + "\n" + "\n".join([pattern % tuple(row) for row in rows.tolist()]) + "\n")


def diagnosed(kerf, folder, expected, base, x, got):
    other = folder / "got.csv"
    table(other, base, x, got)
    run = subprocess.run([kerf, "compare", expected, other, "--relative", "1e-9", "--json"], capture_output=True, text=True)
    if run.returncode != 1:
        sys.exit("a change was not seen (exit status %d): %s" % (run.returncode, run.stderr))
    answer = json.loads(run.stdout)
    for one in answer["names"]:
        one["channels"] = [AXES.index(name) for name in one["channels"]]
    return answer


class TwoChanges:
    """What has no name of its own. Where they are in two channels, or one is much larger, a name is right; else none is
    better than a wrong one."""

    made = ()

    def __call__(self, base, rng):
        self.made = tuple(rng.choice(["offset", "drift", "gain", "saturation", "noise"], 2, replace=False))
        x, once = diagnosis_changes.CHANGES[self.made[0]](base, rng)
        again = diagnosis_bases.Base(base.name, base.rate_hz, base.units, x, force=once)
        return diagnosis_changes.CHANGES[self.made[1]](again, rng)


def count(kerf, bases, chosen):
    counts = collections.defaultdict(collections.Counter)
    changes = {**diagnosis_changes.CHANGES, "two at once": TwoChanges()}
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for number, base in enumerate(bases):
            expected = folder / ("expected-%d.csv" % number)
            table(expected, base, base.x, base.force)
            for kind, (name, change) in enumerate(changes.items()):
                if (chosen and name not in chosen) or not (name == "two at once" or diagnosis_changes.can_be_made(name, base)):
                    continue
                for repeat in range(REPEATS):
                    x, got = change(base, np.random.default_rng([SEED, number, kind, repeat]))
                    answer = diagnosed(kerf, folder, expected, base, x, got)
                    judge(counts[name], getattr(change, "made", (name,)), base, x, got, answer, chosen)
    return counts


def judge(counter, made, base, x, got, answer, tell):
    names = [one["change"] for one in answer["names"]]
    wrong = [one for one in answer["names"] if one["change"] not in made and not diagnosis_changes.makes_the_same(one, base, x, got)]
    if made[0] in ("lost", "doubled"):
        wrong += [one for one in answer["names"] if one["change"] == made[0] and not diagnosis_changes.is_at_its_row(one, base, got)]
    right = len(wrong) < len(names) or (len(made) > 1 and not names)
    counter["made"] += 1
    counter["named"] += all(one in names for one in made)
    counter["right"] += right
    counter["wrong"] += bool(wrong)
    counter["unexplained"] += not answer["names"]
    counter["names"] += len(answer["names"])
    if tell and (not right or wrong):
        print(base.name, base.rate_hz, made, answer["sentences"], [one["change"] for one in wrong])


def million_rows(kerf):
    """The verb as a whole, tables of a million rows in, best of five."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        t = np.arange(1000000) * 1e-3
        force = 3 * np.maximum(0, np.sin(4.4 * t))
        for name, factor in (("a", 1.0), ("b", 1.001)):
            np.savetxt(folder / (name + ".csv"), np.column_stack([t, factor * force]), "%.9g", ",", header="time [s],x [N]", comments="")
        for name in "ab":
            subprocess.run([kerf, "import", folder / (name + ".csv"), "--map", "time=1[s],position=2[m],force=2[N]", "-o",
                            folder / (name + ".h5")], check=True, capture_output=True)
        best = {}
        for kind in ("h5", "csv"):
            for _ in range(5):
                begin = time.perf_counter()
                subprocess.run([kerf, "compare", folder / ("a." + kind), folder / ("b." + kind)], check=True, capture_output=True)
                best[kind] = min(best.get(kind, 1e9), time.perf_counter() - begin)
    return best


def main():
    house, chosen = pathlib.Path(sys.argv[1]), sys.argv[2:]
    kerf = house / "build/release/bin/kerf"
    measured = list(diagnosis_bases.measured(house / "../shared/data")) or list(diagnosis_bases.measured(house / "data"))
    bases = list(diagnosis_bases.laws()) + (measured or list(diagnosis_bases.made()))
    begin = time.perf_counter()
    counts = count(kerf, bases, chosen)
    seconds = time.perf_counter() - begin
    lines = ["| change | made | named | right | wrong | unexplained | names each |", "|---|---|---|---|---|---|---|"]
    total = collections.Counter()
    for name, one in counts.items():
        if name != "two at once":
            total.update(one)
        if one["made"]:
            lines.append("| %s | %d | %d | %d | %d | %d | %.1f |" %
                         (name, one["made"], one["named"], one["right"], one["wrong"], one["unexplained"], one["names"] / one["made"]))
    if chosen:
        print("\n".join(lines))
        return
    lines.insert(0, "%d changes to %s, by NumPy; each pair as tables through `kerf compare`, which knows nothing but the numbers.\n" %
                 (total["made"], ", ".join("%s (%.0f Hz)" % (base.name, base.rate_hz) for base in bases)))
    best = million_rows(kerf)
    lines += ["", "*Right*: the change that was made is among the names, or another that NumPy finds to leave at most a twentieth of the "
              "difference. *Wrong*: a name was given that is neither, or samples are said to be lost or doubled at another tick. Of all single changes %.1f %% right, %.1f %% wrong, %.1f %% named as "
              "they were made. *Two at once*, offset, drift, gain, saturation or noise, have no name of their own: no name is right there, too."
              % tuple(100 * total[key] / total["made"] for key in ("right", "wrong", "named")),
              "", "A million rows of one channel, the whole program: recordings %.2f s, tables %.2f s (best of five). "
              "The table above took %.0f s." % (best["h5"], best["csv"], seconds)]
    replace_section(house / "docs/benchmarks.md", "diagnosis", "Names for what changed between forces", "\n".join(lines))
    print("\n".join(lines))


main()
