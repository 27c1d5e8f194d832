"""A folder of measured recordings imported, segmented, fitted with every law and reported by the program."""

import concurrent.futures
import statistics
import subprocess
import tempfile
import time

TURNS = 3
AT_MOST_S = 10.0
COLUMNS = "time=5[ms],position=4[deg],force=2[gf]"


def part(house):
    recordings = sorted((house / "data/meniscus").glob("*.txt")) or sorted((house.parent / "shared/data/meniscus").glob("*.txt"))
    if not recordings:
        return "**A folder of recordings**: left out, there are no files in data/meniscus; scripts/fetch-data brings them."
    program = str(house / "build/release/bin/kerf")
    steps = {"import": [], "segment": [], "fit": [], "report": []}
    messages = set()
    for _ in range(TURNS):
        seconds = dict.fromkeys(steps, 0.0)
        with tempfile.TemporaryDirectory() as folder:
            names = {text: "%s/%s" % (folder, text.stem) for text in recordings}
            results = folder + "/results"
            commands = {
                "import": [["import", str(text), "--map", COLUMNS, "-o", name + ".h5"] for text, name in names.items()],
                "segment": [["segment", name + ".h5"] for name in names.values()],
                "fit": [["fit", "--batch", folder, "--jobs", "2", "--models", "all", "-o", results]],
                "report": [["report", name + ".h5", "--fits", results + name[len(folder):], "-o", name + ".html"]
                           for name in names.values()],
            }
            for step, calls in commands.items():
                begin = time.perf_counter()
                with concurrent.futures.ThreadPoolExecutor(2) as two:
                    run = lambda call: subprocess.run([program, *call], capture_output=True, text=True)
                    for call, done in zip(calls, two.map(run, calls)):
                        if done.returncode != 0:
                            messages.add("%s ended with %d: %s" % (" ".join(call[:2]), done.returncode, last_line(done)))
                seconds[step] = time.perf_counter() - begin
        for step, values in steps.items():
            values.append(seconds[step])
    medians = {step: statistics.median(values) for step, values in steps.items()}
    total = statistics.median([sum(values) for values in zip(*steps.values())])
    lines = ["**A folder of measured recordings** (`data/meniscus` of `scripts/fetch-data`, %d files), two at a time, from text to report, "
             "every law fitted with cross-validation; medians of %d turns:" % (len(recordings), TURNS), "",
             "| step | seconds |", "|---|---|"]
    lines += ["| %s | %.2f |" % (step, median) for step, median in medians.items()]
    lines += ["| in all | %.2f |" % total, "", "At most %.0f s asked for: %s." % (
        AT_MOST_S, "met" if total <= AT_MOST_S and not messages else "missed")]
    return "\n".join(lines + ["- " + message for message in sorted(messages)])


def last_line(done):
    lines = (done.stderr or done.stdout).strip().splitlines()
    return lines[-1] if lines else "no word"
