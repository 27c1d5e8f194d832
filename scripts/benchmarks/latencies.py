"""Wake latencies of a loop of Kerf's and of cyclictest, a thread that only sleeps, in the same figures."""

import os
import re

EDGES_US = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 10000)
DEEPEST_US = 20000  # of cyclictest's histogram; what lies above is counted as overflow
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

    def later_than(self, edge_us):
        return sum(count for edge, count in self.counts.items() if edge > edge_us)

    def distribution(self):
        row = [0] * (len(EDGES_US) + 1)
        for edge, count in self.counts.items():
            row[sum(edge > limit for limit in EDGES_US)] += count
        return row

    def figures(self, name):
        """A row of a table under HEADS."""
        return "| %s | %.1f | %.1f | %.1f | %.0f | %s of %d |" % (
            name, self.percentile(0.5), self.percentile(0.99), self.percentile(0.999), self.worst,
            "-" if self.missed is None else self.missed, self.ticks)


HEADS = "| what | p50 [us] | p99 | p99.9 | worst | missed |\n|---|---|---|---|---|---|"


def last_processor():
    return max(os.sched_getaffinity(0))


def check_command(house, law, record, seconds, rate_hz=1000):
    """A loop that renders a Kelvin law, which it writes to `law`, and records 43 channels to `record`."""
    law.write_text(LAW)
    return [str(house / "build/release/bin/kerf"), "check", str(law), "--device", "sim:pose6?truth=on", "--seconds", str(seconds),
            "--rate", str(rate_hz), "--record", str(record), "--force", "--json"]


def add_check(check, latencies):
    histogram = check["histograms"]["wake_us"]
    latencies.add(histogram["edges"][1:], histogram["counts"], check["wake_us"]["max"])
    latencies.ticks += check["ticks"]
    latencies.missed += check["missed"]


def cyclictest_command(seconds, processor):
    """Sleeps to the next millisecond, as urgent as a loop of Kerf's, and does nothing."""
    return ["cyclictest", "-m", "-p", "80", "-i", "1000", "-l", str(1000 * seconds), "-t", "1", "-a", str(processor), "-q", "-h",
            str(DEEPEST_US)]


def add_cyclictest(output, latencies):
    rows = [tuple(map(int, line.split())) for line in output.splitlines() if re.fullmatch(r"\d+\s+\d+", line.strip())]
    worst = float(re.search(r"# Max Latencies:\s*(\d+)", output).group(1))
    overflow = int(re.search(r"# Histogram Overflows:\s*(\d+)", output).group(1))
    # A latency of "17" is between 17 and 18 us.
    latencies.add([row[0] + 1 for row in rows] + [DEEPEST_US + 1], [row[1] for row in rows] + [overflow], worst + 1)
    latencies.ticks += sum(row[1] for row in rows) + overflow
    latencies.missed = None  # it has no deadline
