# peers: python3-numpy python3-h5py
"""Importing 1 M rows x 5 columns of text: Kerf against numpy.loadtxt, by turns."""

import json
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

from sections import replace_section

ROWS = 1_000_000
TURNS = 7


def write_table(path):
    source = random.Random(1)
    with open(path, "w") as file:
        file.write("t,position,force,a,b\n")
        for row in range(ROWS):
            file.write("%.3f,%.6f,%.4f,%.5f,%.3f\n" % (
                row * 1e-3, source.uniform(-1, 1), source.uniform(0, 10), source.gauss(0, 3), source.uniform(0, 100)))


def run_kerf(program, text, recording):
    begin = time.perf_counter()
    result = subprocess.run(
        [program, "import", text, "--map", "time=t[s],position=position[mm],force=force[N],a=a[1],b=b[1]",
         "-o", recording, "--force", "--json"], check=True, capture_output=True)
    whole = time.perf_counter() - begin
    return json.loads(result.stdout)["parse_seconds"], whole


def run_numpy(text, target):
    begin = time.perf_counter()
    table = numpy.loadtxt(text, delimiter=",", skiprows=1)
    parse = time.perf_counter() - begin
    with h5py.File(target, "w") as file:
        for column, name in enumerate(("t", "position", "force", "a", "b")):
            file[name] = numpy.ascontiguousarray(table[:, column])
    return parse, time.perf_counter() - begin


def section(figures):
    medians = {name: statistics.median(values) for name, values in figures.items()}
    lines = ["| what | median [ms] | smallest | largest |", "|---|---|---|---|"]
    for name, values in figures.items():
        lines.append("| %s | %.0f | %.0f | %.0f |" % (name, 1e3 * medians[name], 1e3 * min(values), 1e3 * max(values)))
    parse = medians["numpy.loadtxt"] / medians["Kerf, parsing"]
    whole = medians["numpy.loadtxt and h5py"] / medians["Kerf, the whole program"]
    lines += ["", "Parsing alone: %.1f times as fast as `numpy.loadtxt`. The whole program, which also checks every time "
              "stamp, derives the velocity, takes the SHA-256 and writes the recording: %.1f times as fast as "
              "`numpy.loadtxt` and h5py writing the five columns." % (parse, whole)]
    return "\n".join(lines)


def main():
    house = pathlib.Path(sys.argv[1])
    figures = {"Kerf, parsing": [], "numpy.loadtxt": [], "Kerf, the whole program": [], "numpy.loadtxt and h5py": []}
    with tempfile.TemporaryDirectory() as folder:
        text = folder + "/table.csv"
        write_table(text)
        for _ in range(TURNS):
            parse, whole = run_kerf(str(house / "build/release/bin/kerf"), text, folder + "/kerf.h5")
            figures["Kerf, parsing"].append(parse)
            figures["Kerf, the whole program"].append(whole)
            parse, whole = run_numpy(text, folder + "/numpy.h5")
            figures["numpy.loadtxt"].append(parse)
            figures["numpy.loadtxt and h5py"].append(whole)
    body = section(figures)
    print(body)
    replace_section(house / "docs/benchmarks.md", "import",
                    "Import of 1 M rows x 5 columns (%d turns each)" % TURNS, body)


main()
