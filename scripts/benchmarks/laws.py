# peers: libbenchmark-dev libbullet-dev
# targets: kerf kerf_law_benchmark
"""What one tick of every law costs, and the lattice against Bullet's soft body, by turns in one run."""

import json
import pathlib
import subprocess
import sys

from sections import replace_section

REPETITIONS = 9
# Law, what is measured, largest median [ns]
TARGETS = [
    ("kelvin", "kelvin", 20),
    ("exponential", "exponential", 20),
    ("maxwell_2_arms", "maxwell, 2 arms", 30),
    ("springpot", "springpot", 100),
    ("hunt_crossley", "hunt_crossley", 40),
    ("friction", "friction", 30),
    ("precontact", "precontact", 20),
    ("fracture", "fracture", 20),
    ("scissors_analytic", "scissors_analytic", 20),
    ("piecewise", "piecewise, 2 segments and 2 branches", 25),
    ("recording_1000", "recording, table of 1,000 points", 25),
    ("fuzzy_kelvin_9_rules", "fuzzy_kelvin, 9 rules", 120),
    ("blade_exact_4_polygons", "blade `exact`, 4 polygons", 600),
    ("blade_strips_16_4_polygons", "blade `strips(16)`, 4 polygons", None),
    ("blade_paper_16_4_polygons", "blade `paper`, 16 strips, 4 polygons", None),
    ("orthogonal_consistent", "orthogonal on the Premium, `consistent`", 1500),
    ("orthogonal_paper", "orthogonal on the Premium, `paper`", 1500),
    ("scissors_mesh_100x100", "scissors_mesh, 100 x 100 nodes, 4 sub-steps", 8 * 4 * 100 * 100),
    ("scissors_mesh_142x142", "scissors_mesh, 142 x 142 nodes (20,164), 4 sub-steps", 1e6),
    ("cut_side_100x100", "one cut of a lattice of 100 x 100", 100e3),
]


def medians(house):
    program = house / "build/release/bin/kerf_law_benchmark"
    command = [program, "--benchmark_format=json", "--benchmark_min_time=0.2",
               "--benchmark_repetitions=%d" % REPETITIONS, "--benchmark_enable_random_interleaving=true"]
    runs = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["benchmarks"]
    # Interleaved repetitions are named ".../repeats:9"; manual time adds its own ending.
    return {run["run_name"].split("/")[0]: run["real_time"] for run in runs if run.get("aggregate_name") == "median"}


def main():
    house = pathlib.Path(sys.argv[1])
    median = medians(house)
    lines = ["Medians of %d repetitions, interleaved at random, one core, through the registry as the loop calls it." % REPETITIONS, "",
             "| law | one tick, median | at most |", "|---|---|---|"]
    missed = []
    for name, what, most in TARGETS:
        lines.append("| %s | %s | %s |" % (what, as_time(median[name]), as_time(most) if most else ""))
        if most and median[name] > most:
            missed.append(what)
    lattice, bullet = median["lattice_100x100"], median["soft_body_100x100"]
    lines += ["", "**Lattice against Bullet's soft body**, 100 x 100 nodes, springs along sides and both diagonals, one coupling "
              "or force, one iteration of Bullet a step: %s against %s, **%.0f times as fast** (at least 30 asked for); "
              "%.2f ns a node and sub-step alone, %.2f ns in the law (at most 8). Bullet's links keep their length as the "
              "nodes turn; the lattice is linear, for small displacements."
              % (as_time(lattice), as_time(bullet), bullet / lattice, lattice / 1e4, median["scissors_mesh_100x100"] / 4e4)]
    lines += ["", "Above their limit: %s." % (", ".join(missed) if missed else "none")]
    replace_section(house / "docs/benchmarks.md", "laws", "What a tick of each law costs", "\n".join(lines))
    print("\n".join(lines))


def as_time(nanoseconds):
    if nanoseconds >= 1e6:
        return "%.2g ms" % (nanoseconds / 1e6)
    if nanoseconds >= 1e4:
        return "%.0f us" % (nanoseconds / 1e3)
    if nanoseconds >= 1e3:
        return "%.2f us" % (nanoseconds / 1e3)
    return "%.1f ns" % nanoseconds if nanoseconds < 100 else "%.0f ns" % nanoseconds


main()
