# peers: rt-tests stress-ng
# targets: kerf kerf_push_benchmark
"""The loop at 1 kHz, recording 43 channels, against cyclictest (a thread that only sleeps), by turns.

Idle and with the other cores loaded. Rounds of so many seconds: scripts/benchmark rt [ROUNDS [SECONDS]]
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

from latencies import (EDGES_US, HEADS, Latencies, add_check, add_cyclictest, check_command, cyclictest_command, last_processor)
from sections import replace_section

RATES_HZ = (1000, 2000, 4000, 5000, 8000, 10000)


def run_cyclictest(seconds, latencies):
    add_cyclictest(subprocess.run(cyclictest_command(seconds, last_processor()), check=True, capture_output=True, text=True).stdout,
                   latencies)


def run_kerf(house, folder, seconds, rate_hz=1000):
    folder = pathlib.Path(folder)
    result = subprocess.run(check_command(house, folder / "kelvin.law.toml", folder / "loop.h5", seconds, rate_hz),
                            capture_output=True, text=True, env=dict(os.environ, XDG_CACHE_HOME=str(folder)))
    if result.returncode > 1:
        sys.exit(result.stderr)
    return json.loads(result.stdout)


def compare(house, folder, rounds, seconds):
    kerf, peer, pushes = Latencies(), Latencies(), []
    for turn in range(rounds):
        order = ("peer", "kerf") if turn % 2 == 0 else ("kerf", "peer")
        for who in order:
            if who == "peer":
                run_cyclictest(seconds, peer)
            else:
                check = run_kerf(house, folder, seconds)
                add_check(check, kerf)
                pushes.append(1e3 * check["record_us"]["p99"])
    return kerf, peer, pushes


def loaded(action):
    others = sorted(os.sched_getaffinity(0) - {last_processor()}) or [last_processor()]
    load = subprocess.Popen(["stress-ng", "--quiet", "--cpu", str(len(others)), "--taskset", ",".join(map(str, others))])
    try:
        return action()
    finally:
        load.terminate()
        load.wait()


def main():
    house = pathlib.Path(sys.argv[1])
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 8
    seconds = int(sys.argv[3]) if len(sys.argv) > 3 else 8
    with tempfile.TemporaryDirectory() as folder:
        first = run_kerf(house, folder, 1)  # measures the floor
        conditions = {"idle": compare(house, folder, rounds, seconds),
                      "other cores loaded": loaded(lambda: compare(house, folder, rounds, seconds))}
        push = json.loads(subprocess.run([str(house / "build/release/bin/kerf_push_benchmark")], check=True,
                                         capture_output=True).stdout)
        rates = {rate: run_kerf(house, folder, 10, rate)["missed"] for rate in RATES_HZ}

    lines = ["Wake latency, from the deadline to the moment at which the thread runs, %d rounds of %d s each, by turns. "
             "Kerf renders a Kelvin law on `sim:pose6?truth=on` and records 43 channels; cyclictest (`-m -p 80`) does "
             "nothing. Both at SCHED_FIFO 80 on the last processor." % (rounds, seconds), "", HEADS]
    for condition, (kerf, peer, _) in conditions.items():
        lines += [kerf.figures("Kerf, " + condition), peer.figures("cyclictest, " + condition)]
    lines.append("")
    for condition, (kerf, peer, pushes) in conditions.items():
        lines.append("- %s: Kerf's p50 is %.3f of cyclictest's, its p99 %.2f, its p99.9 %.2f. A push to the recorder in that loop, "
                     "once a millisecond and into cold memory, took %.0f ns at p99." % (
                         condition.capitalize(), kerf.percentile(0.5) / peer.percentile(0.5),
                         kerf.percentile(0.99) / peer.percentile(0.99),
                         kerf.percentile(0.999) / peer.percentile(0.999), max(pushes)))
    lines.append("- A push of a row of 6 axes and 16 channels, 100,000 a second while another thread empties the ring: "
                 "%.0f ns at the median, %.0f ns at p99, %.0f ns at p99.9 (of which reading the clock takes %.0f ns)." % (
                     push["p50_ns"], push["p99_ns"], push["p999_ns"], push["clock_p50_ns"]))
    quiet = [rate for rate in RATES_HZ if rates[rate] == 0]
    lines.append("- Missed deadlines in 10 s, by rate: %s. Fastest rate without one: %s." % (
        ", ".join("%d Hz: %d" % item for item in rates.items()), "%d Hz" % max(quiet) if quiet else "none"))
    floor = first["floor"]
    lines.append("- An empty loop of Kerf's missed %d of %d deadlines here; it learned to spin for %.0f us." % (
        floor["missed"], floor["ticks"], floor["spin_us"]))
    lines += ["", "Ticks by wake latency [us]:", "",
              "| what | " + " | ".join("< %d" % edge for edge in EDGES_US) + " | more |",
              "|---" * (len(EDGES_US) + 2) + "|"]
    for condition, (kerf, peer, _) in conditions.items():
        for name, latencies in (("Kerf", kerf), ("cyclictest", peer)):
            lines.append("| %s, %s | %s |" % (name, condition, " | ".join(map(str, latencies.distribution()))))
    body = "\n".join(lines)
    print(body)
    replace_section(house / "docs/benchmarks.md", "rt", "The loop at 1 kHz against cyclictest", body)


main()
