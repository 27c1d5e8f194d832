#!/usr/bin/env python3
"""What came of the sweep of coverage.py: coverage_pictures.py FOLDER

Reads targets.merged and coverage.merged in FOLDER; writes coverage.pictures.toml, which `kerf report --pictures` draws, and
prints a table: of each law and condition the least and the largest share of intervals that hold what the fit without noise
found, over its parameters.
"""

import json
import math
import pathlib
import sys

import h5py
import numpy

CONDITIONS = [
    ("noise 0.02 N", lambda law, name, noise: name == law and noise == 0.02),
    ("noise 0.1 N", lambda law, name, noise: name == law and noise == 0.1),
    ("20 Hz", lambda law, name, noise: name == f"{law}-coarse"),
    ("encoder 5 mrad", lambda law, name, noise: name == f"{law}-encoder"),
    ("another law", lambda law, name, noise: not name.startswith(law)),
]


def texts(file, name):
    return [row[0].decode() for row in file["values"][name][:]]


def stem(recording):
    return pathlib.PurePath(recording).stem


def parameters(table):
    return [name[: -len("_lower")] for name in table if name.endswith("_lower")]


def conditions_of(law, table, recordings):
    """Of each condition its rows, with the recording and the noise that it is."""
    codes, noises = table["recording"][:], table["noise"][:]
    found = []
    for title, is_it in CONDITIONS:
        pairs = {(code, noise) for code, noise in zip(codes.tolist(), noises.tolist())}
        for code, noise in sorted(pairs):
            if is_it(law, stem(recordings[code]), noise):
                found.append((title, recordings[code], noise, (codes == code) & (noises == noise)))
    return found


def binomial_tail(count, trials, chance):
    """P(X <= count)"""
    k = numpy.arange(count + 1)
    logs = [math.lgamma(trials + 1) - math.lgamma(i + 1) - math.lgamma(trials - i + 1) for i in k]
    return float(numpy.exp(logs + k * math.log(chance) + (trials - k) * math.log1p(-chance)).sum())


def acceptance(trials, chance=0.95, confidence=0.999):
    """Shares that so many trials give with that confidence, if each has the chance: exact."""
    tail = (1 - confidence) / 2
    low = next(k for k in range(trials + 1) if binomial_tail(k, trials, chance) > tail)
    high = next(k for k in range(trials, -1, -1) if 1 - binomial_tail(k - 1, trials, chance) > tail)
    return low / trials, high / trials


def main(folder):
    folder = pathlib.Path(folder)
    targets = h5py.File(folder / "targets.merged/sweep.h5")
    coverage = h5py.File(folder / "coverage.merged/sweep.h5")
    recordings, known = texts(coverage, "recording"), texts(targets, "recording")
    toml = "version = 1\n"
    rows = []
    for law in sorted(name for name in coverage if name != "values"):
        table, target = coverage[law], targets[law]
        names = [name for name in parameters(table) if numpy.isfinite(table[name + "_std_error"][:]).any()]
        toml += f'\n[[picture]]\nkind = "shares"\nname = "coverage-{law}"\ntable = "{law}"\nnominal = 0.95\n'
        toml += f'title = "{law}: how often 95 % intervals hold what the fit without noise found"\n'
        row = [law]
        for title, recording, noise, is_it in conditions_of(law, table, recordings):
            at = [known[code] == recording for code in target["recording"][:]].index(True)
            shares = []
            for name in names:
                if not (table[name + "_std_error"][:][is_it] > 0).any():
                    continue  # held, not searched
                value = float(target[name][at])
                lower, upper = table[name + "_lower"][:][is_it], table[name + "_upper"][:][is_it]
                there = numpy.isfinite(lower) | numpy.isfinite(upper)
                toml += (
                    f'[[picture.shares]]\nname = "{name}"\nat = "{title}"\n'
                    f'share = "{name}_lower <= {value!r} & {name}_upper >= {value!r}"\n'
                    f"where = {{ recording = {json.dumps([recording])}, noise = [{noise!r}] }}\n"
                )
                if there.any():
                    held = (lower[there] <= value) & (upper[there] >= value)
                    shares.append((held.mean(), name, int(there.sum())))
            row.append((title, stem(recording), shares, int(is_it.sum())))
        rows.append(row)
    (folder / "coverage.pictures.toml").write_text(toml)
    band = acceptance(1540)
    print(f"of 1540 trials at 0.95, 99.9 % of the time {band[0]:.3f} to {band[1]:.3f}\n")
    print("| law | " + " | ".join(title for title, _ in CONDITIONS) + " |")
    print("|---" * (len(CONDITIONS) + 1) + "|")
    for law, *cells in rows:
        line = [f"`{law}`"]
        for title, recording, shares, fits in cells:
            if not shares:
                line.append("no interval")
                continue
            least, most = min(shares), max(shares)
            text = f"{100 * least[0]:.1f}" if least is most else f"{100 * least[0]:.1f} (`{least[1]}`) to {100 * most[0]:.1f}"
            fewest = min(shares, key=lambda one: one[2])
            if fewest[2] < fits:
                text += f"; of `{fewest[1]}` {fewest[2]} of {fits} fits have one"
            if title == CONDITIONS[-1][0]:
                text += f" (`{recording}`)"
            line.append(text)
        print("| " + " | ".join(line) + " |")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
