"""What watching a loop costs it: alone, with its rows tapped, with a viewer of sixty frames a second, and beside damaged files."""

import json
import pathlib
import statistics
import subprocess
import tempfile

MODES = ("alone", "tap", "viewer", "damaged", "law")
NAMES = {"alone": "nobody watching, no tap", "tap": "rows tapped and kept, nobody watching",
         "viewer": "a viewer who takes 60 frames a second",
         "damaged": "one damaged recording of a minute after the other is opened by its process",
         "law": "the law compiled into the loop, as `kerf check` has it"}
PERCENTILES = ("p50", "p999", "max")


def run(program, *arguments):
    return json.loads(subprocess.run([str(program), *map(str, arguments)], check=True, capture_output=True).stdout)


def by_turns(program, turns, seconds, recording):
    rounds = {mode: [] for mode in MODES}
    for turn in range(turns):
        first = turn % len(MODES)
        for mode in MODES[first:] + MODES[:first]:
            rounds[mode].append(run(program, mode, seconds, *([recording] if mode == "damaged" else [])))
    return rounds


def median(rounds, what, percentile):
    return statistics.median(it[what][percentile] for it in rounds)


def median_ratio(rounds, mode, what, percentile):
    """Median over the turns of what the turn had with and without."""
    ratios = [watched[what][percentile] / alone[what][percentile]
              for watched, alone in zip(rounds[mode], rounds["alone"]) if alone[what][percentile] > 0]
    return statistics.median(ratios) if ratios else 1.0


def measure(house, turns=11, seconds=10.0):
    program = house / "build/release/bin/kerf_live_benchmark"
    with tempfile.TemporaryDirectory() as folder:
        recording = pathlib.Path(folder, "minute.h5")
        run(program.parent / "kerf", "record", "--device", "sim:scissors", "--seconds", 60, "--virtual", "-o", recording, "--json")
        rounds = by_turns(program, turns, seconds, recording)
    cost = run(program, "cost")
    lines = ["`sim:scissors` and a Kelvin law at 1 kHz by the wall clock, %d turns of %g s each, in rotation; medians over "
             "the turns, ratios to the first row in the same turn, whose law can be changed too." % (turns, seconds), "",
             "| loop | wake p50 [us] | ratio | p99.9 | ratio | worst | ratio | cycle p50 [us] | ratio | missed |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    for mode in MODES:
        cells = [NAMES[mode]]
        for what, percentile in [("wake_us", it) for it in PERCENTILES] + [("cycle_us", "p50")]:
            cells.append("%.3g" % median(rounds[mode], what, percentile))
            cells.append("%.2f" % median_ratio(rounds, mode, what, percentile))
        cells.append("%d" % sum(it["missed"] for it in rounds[mode]))
        lines.append("| %s |" % " | ".join(cells))
    lines += ["", "- What the page takes, off the loop's processor, of %d traces: a frame of 16 ms %.0f us, a frame of 600 "
              "columns of 10 ms, as who catches up gets, %.1f ms; 60 s in 1200 columns %.1f ms, of 4 traces %.1f ms." % (
                  cost["traces"], cost["frame_16_ms_us"], cost["frame_600_columns_us"] / 1e3,
                  cost["view_60_s_us"] / 1e3, cost["view_60_s_4_traces_us"] / 1e3)]
    return "A loop that is watched", "\n".join(lines)
