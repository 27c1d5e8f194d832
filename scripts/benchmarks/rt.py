# peers: rt-tests stress-ng
# targets: kerf kerf_push_benchmark
"""The loop at 1 kHz, recording 43 channels, against cyclictest (a thread that only sleeps), by turns.

Idle and with the other cores loaded. Rounds of so many seconds: scripts/benchmark rt [ROUNDS [SECONDS]]
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from sections import replace_section

EDGES_US = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 10000)
RATES_HZ = (1000, 2000, 4000, 5000, 8000, 10000)
LAW = """model = "kelvin"
axis = "x"
[contact]
position = { value = 0, unit = "m" }
direction = "increasing"
[parameters]
parallel_stiffness = { value = 300, unit = "N/m" }
series_stiffness = { value = 500, unit = "N/m" }
damping = { value = 50, unit = "N·s/m" }
"""


class Latencies:
    """Wake latencies as counts by upper edge [us], pooled over rounds."""

    def __init__(self):
        self.counts = {}
        self.worst = 0.0
        self.ticks = 0
        self.missed = 0

    def add(self, edges, counts, worst):
        for edge, count in zip(edges, counts):
            self.counts[edge] = self.counts.get(edge, 0) + count
        self.worst = max(self.worst, worst)

    def percentile(self, share):
        total = sum(self.counts.values())
        seen = 0
        for edge in sorted(self.counts):
            seen += self.counts[edge]
            if seen >= share * total:
                return min(edge, self.worst)
        return self.worst

    def distribution(self):
        row = [0] * (len(EDGES_US) + 1)
        for edge, count in self.counts.items():
            row[sum(edge > limit for limit in EDGES_US)] += count
        return row


def last_processor():
    return max(os.sched_getaffinity(0))


def run_cyclictest(seconds, latencies):
    # The histogram's last line is in microseconds: what lies above is counted as overflow.
    deepest = 20000
    output = subprocess.run(
        ["cyclictest", "-m", "-p", "80", "-i", "1000", "-l", str(1000 * seconds), "-t", "1", "-a",
         str(last_processor()), "-q", "-h", str(deepest)], check=True, capture_output=True, text=True).stdout
    rows = [tuple(map(int, line.split())) for line in output.splitlines() if re.fullmatch(r"\d+\s+\d+", line.strip())]
    worst = float(re.search(r"# Max Latencies:\s*(\d+)", output).group(1))
    overflow = int(re.search(r"# Histogram Overflows:\s*(\d+)", output).group(1))
    # A latency of "17" is between 17 and 18 us.
    latencies.add([row[0] + 1 for row in rows] + [deepest + 1], [row[1] for row in rows] + [overflow], worst + 1)
    latencies.ticks += 1000 * seconds


def run_kerf(house, folder, seconds, rate_hz=1000):
    law = pathlib.Path(folder, "kelvin.law.toml")
    law.write_text(LAW)
    result = subprocess.run(
        [str(house / "build/release/bin/kerf"), "check", str(law), "--device", "sim:pose6?truth=on", "--seconds",
         str(seconds), "--rate", str(rate_hz), "--record", folder + "/loop.h5", "--force", "--json"],
        capture_output=True, text=True, env=dict(os.environ, XDG_CACHE_HOME=folder))
    if result.returncode > 1:
        sys.exit(result.stderr)
    return json.loads(result.stdout)


def add_kerf(check, latencies):
    histogram = check["histograms"]["wake_us"]
    latencies.add(histogram["edges"][1:], histogram["counts"], check["wake_us"]["max"])
    latencies.ticks += check["ticks"]
    latencies.missed += check["missed"]


def compare(house, folder, rounds, seconds):
    kerf, peer, pushes = Latencies(), Latencies(), []
    for turn in range(rounds):
        order = ("peer", "kerf") if turn % 2 == 0 else ("kerf", "peer")
        for who in order:
            if who == "peer":
                run_cyclictest(seconds, peer)
            else:
                check = run_kerf(house, folder, seconds)
                add_kerf(check, kerf)
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


def figures(name, latencies):
    return "| %s | %.1f | %.1f | %.1f | %.0f | %s of %d |" % (
        name, latencies.percentile(0.5), latencies.percentile(0.99), latencies.percentile(0.999), latencies.worst,
        latencies.missed if name.startswith("Kerf") else "-", latencies.ticks)


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
             "nothing. Both at SCHED_FIFO 80 on the last processor." % (rounds, seconds), "",
             "| what | p50 [us] | p99 | p99.9 | worst | missed |", "|---|---|---|---|---|---|"]
    for condition, (kerf, peer, _) in conditions.items():
        lines += [figures("Kerf, " + condition, kerf), figures("cyclictest, " + condition, peer)]
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
