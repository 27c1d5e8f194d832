# peers:
# targets: kerf
"""What `kerf regress` adds to a hundred renderers of 10 ms each, and what a tick costs in lockstep.

scripts/benchmark renderers [--rounds 5]; beside Kerf the same commands are started one after the other by Python's
subprocess, and both are held against the time that the commands themselves wait.
"""

import argparse
import json
import os
import pathlib
import resource
import statistics
import subprocess
import tempfile
import time

from sections import replace_section

CASES, TICKS, LONG_TICKS = 100, 1000, 18000
RENDERER = r"""
#include <stdio.h>
#include <unistd.h>
int main(int count, char** arguments) {
  usleep(10000);
  FILE* in = fopen(arguments[1], "r");
  FILE* out = fopen(arguments[2], "w");
  char line[512];
  if (count != 3 || in == NULL || out == NULL || fgets(line, sizeof line, in) == NULL) return 2;
  fputs("time[s],fx[N]\n", out);
  double now, x;
  while (fscanf(in, "%*d,%lf,%lf,%*[^\n]", &now, &x) == 2) fprintf(out, "%.9g,%.17g\n", now, x);
  return fclose(out);
}
"""
MOTION = """
[[case.motion]]
axis = "x"
kind = "strokes"
from = { value = 0, unit = "mm" }
to = { value = 20, unit = "mm" }
"""
HEAD = """[defaults]
exact = true
seconds = { value = %d, unit = "s" }
axes = [%s]
"""


def children_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def timed(command, **options):
    begin, used = time.perf_counter(), children_s()
    run = subprocess.run(command, stdout=subprocess.PIPE, check=True, **options)
    return time.perf_counter() - begin, children_s() - used, run.stdout


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("house", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    kerf = str(arguments.house / "build/release/bin/kerf")
    examples = arguments.house / "examples/regress/renderers"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "wait.c").write_text(RENDERER)
        subprocess.run(["cc", "-O2", "wait.c", "-o", "wait"], cwd=folder, check=True)
        subprocess.run(["c++", "-O2", "-ffp-contract=off", examples / "lockstep.cpp", "-o", "lockstep"], cwd=folder,
                       check=True)
        (folder / "many.toml").write_text(HEAD % (TICKS / 1000, '{ name = "x" }') + "".join(
            '\n[[case]]\nname = "%d"\nrenderer = { command = ["./wait", "{trajectory}", "{forces}"] }%s' % (i, MOTION)
            for i in range(CASES)))
        (folder / "long.toml").write_text(HEAD % (LONG_TICKS / 1000, '{ name = "x" }, { name = "y" }') + "".join(
            '\n[[case]]\nname = "%s"\nrenderer = { command = [%s], lockstep = "%s" }%s' % (*one, MOTION) for one in (
                ("C++, streams", '"./lockstep"', "streams"),
                ("Python, streams", '"python3", "%s"' % (examples / "lockstep.py"), "streams"),
                ("Python, socket", '"python3", "%s", "--socket", "{socket}"' % (examples / "lockstep.py"), "socket"))))
        for suite in ("many.toml", "long.toml"):
            subprocess.run([kerf, "regress", "update", suite, "--reason", "first", "--yes"], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL)
        subprocess.run([kerf, "regress", "trajectory", "many.toml", "0", "-o", "t.csv"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        rows = {"Kerf": [], "Kerf, -j 2": [], "a bare loop": []}
        steps = {}
        for _ in range(arguments.rounds):
            rows["Kerf"].append(timed([kerf, "regress", "run", "many.toml"], cwd=folder)[:2])
            rows["Kerf, -j 2"].append(timed([kerf, "regress", "run", "many.toml", "-j", "2"], cwd=folder)[:2])
            begin, used = time.perf_counter(), children_s()
            for _ in range(CASES):
                subprocess.run(["./wait", "t.csv", "f.csv"], cwd=folder, check=True)
            rows["a bare loop"].append((time.perf_counter() - begin, children_s() - used))
            for case in json.loads(timed([kerf, "regress", "run", "long.toml", "--json"], cwd=folder)[2])["cases"]:
                steps.setdefault(case["name"], []).append(case["seconds"])
    waited = CASES * 0.01
    lines = ["| %d commands of 10 ms, %d rows each | wall time [s] | smallest | over the %g s of waiting | processor time [s] |"
             % (CASES, TICKS, waited), "|---|---|---|---|---|"]
    for what, runs in rows.items():
        wall = statistics.median(run[0] for run in runs)
        lines.append("| %s | %.2f | %.2f | %.2f | %.2f |" % (
            what, wall, min(run[0] for run in runs), wall - waited, statistics.median(run[1] for run in runs)))
    lines += ["", "| %d ticks of two axes in lockstep | the whole case [s] | smallest | us a tick |" % LONG_TICKS,
              "|---|---|---|---|"]
    for what, runs in steps.items():
        lines.append("| %s | %.2f | %.2f | %.1f |" % (
            what, statistics.median(runs), min(runs), 1e6 * statistics.median(runs) / LONG_TICKS))
    lines += ["", "Medians of %d rounds. The bare loop starts the same commands one after the other from Python and reads nothing; "
              "processor time is that of Kerf and of the commands together. Load average of the machine: %.0f."
              % (arguments.rounds, os.getloadavg()[0])]
    replace_section(arguments.house / "docs/benchmarks.md", "renderers", "Renderers that are no laws of Kerf",
                    "\n".join(lines))
    print("\n".join(lines))


main()
