"""What the studio's page costs the browser: first paint, long tasks, memory over ten minutes of scope."""

import json
import statistics
import subprocess


def ratio(wake, percentile):
    """Median over the turns of what the turn had with the browser and without."""
    return statistics.median(one[percentile] / other[percentile]
                             for one, other in zip(wake["with"], wake["without"]) if other[percentile] > 0)


def measure(house, seconds=600):
    build = house / "build/release"
    run = subprocess.run(["node", str(house / "tests/bench/studio/page/budget.mjs"), str(build / "bin/kerf"),
                          str(build / "tests/bench/studio/page/node_modules"), str(seconds)], check=True, capture_output=True, text=True)
    found = json.loads(run.stdout)
    watched = found["watched"]
    rows = [
        ("Page, compressed [kB]", "%.0f" % (found["bytes"] / 1e3), "150"),
        ("First contentful paint, median of 9 [ms]", "%.0f" % found["first_paint_ms"], "300"),
        ("The slowest of them [ms]", "%.0f" % found["slowest_paint_ms"], "300"),
        ("The slowest tab of a recording, median of 9 [ms]", "%.0f (%s)" % max((ms, tab) for tab, ms in found["tab_ms"].items()), "100"),
        ("5,000 recordings listed, from the page's start [ms]", "%.0f" % found["list_ms"], "500"),
        ("Tasks over 50 ms in %.0f s of scope" % watched["seconds"], "%d" % watched["long_tasks"], "0"),
        ("The longest of them [ms]", "%.0f" % watched["longest_task_ms"], "50"),
        ("Layout shift", "%.3g" % watched["layout_shift"], "0"),
        ("Memory in use, first and last [MB]", "%.2f, %.2f" % (watched["heap_mb"][0], watched["heap_mb"][-1]), "no growth"),
    ]
    lines = ["Headless Chromium on the machine that runs the loop, drawing in software; the scope of `sim:scissors` at 1 kHz, "
             "%.0f frames a second, memory after a collection every minute." % watched["frames_per_second"], "",
             "| what | measured | budget |", "|---|---|---|"]
    lines += ["| %s | %s | %s |" % row for row in rows]
    wake = found["wake"]
    lines += ["", "- The loop's wake latency with the scope open in that browser, on the loop's own machine, and with the "
              "page closed, medians of %d turns of 10 s: p50 %.3g and %.3g us (ratio %.2f), p99.9 %.3g and %.3g us (ratio %.2f)." % (
                  len(wake["with"]), *(it for percentile in ("p50", "p999") for it in (
                      statistics.median(one[percentile] for one in wake["with"]),
                      statistics.median(one[percentile] for one in wake["without"]), ratio(wake, percentile))))]
    lines += ["", "- Memory over time: " + ", ".join("%.2f" % it for it in watched["heap_mb"]) + " MB."]
    return "The studio's page in a browser", "\n".join(lines)
