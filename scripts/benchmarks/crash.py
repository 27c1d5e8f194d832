# peers: python3-numpy
"""kill -9 at random moments of a recording by the wall clock: what is left, what is lost, and is it closed again.

scripts/benchmark crash [KILLS]
"""

import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

import numpy

from sections import replace_section


def kill_once(kerf, folder, moment, environment):
    """Returns the seconds of loop time that the file does not hold, and its rows."""
    recording = pathlib.Path(folder, "r.h5")
    partial = pathlib.Path(folder, "r.h5.partial")
    process = subprocess.Popen([kerf, "record", "--device", "sim:pose6?truth=on", "--seconds", "60", "-o", recording],
                               env=environment, stderr=subprocess.DEVNULL)
    while not partial.exists():
        time.sleep(0.0005)
    begin = time.monotonic()  # the file is there before the first tick
    time.sleep(moment)
    killed = time.monotonic()
    process.send_signal(signal.SIGKILL)
    process.wait()

    for command in ("validate", "repair", "validate"):
        what = recording if recording.exists() else partial
        result = subprocess.run([kerf, command, what], capture_output=True, text=True)
        if result.returncode != 0:
            sys.exit("%s after a kill at %.3f s: %s" % (command, moment, result.stderr))
    info = json.loads(subprocess.run([kerf, "info", recording, "--json"], check=True, capture_output=True).stdout)
    recording.unlink()
    return killed - begin - info["samples"] * 1e-3, info["samples"]


def main():
    house = pathlib.Path(sys.argv[1])
    kills = int(sys.argv[2]) if len(sys.argv) > 2 else 100
    kerf = str(house / "build/release/bin/kerf")
    random.seed(1)
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, XDG_CACHE_HOME=folder)
        law = pathlib.Path(folder, "law.toml")
        law.write_text('model = "kelvin"\naxis = "x"\n[contact]\nposition = { value = 0, unit = "m" }\n'
                       'direction = "increasing"\n[parameters]\nparallel_stiffness = { value = 1, unit = "N/m" }\n'
                       'series_stiffness = { value = 1, unit = "N/m" }\ndamping = { value = 1, unit = "N·s/m" }\n')
        # Measures the floor once, so that no recording has to learn how early to wake up.
        subprocess.run([kerf, "check", law, "--device", "sim:pose6", "--seconds", "0.1"], env=environment,
                       stderr=subprocess.DEVNULL)
        lost, rows = zip(*(kill_once(kerf, folder, random.uniform(0.02, 3.0), environment) for _ in range(kills)))
    body = ("%d recordings of 43 channels at 1 kHz, each killed with SIGKILL at a random moment of its first three "
            "seconds. Every file validated as it was left, was closed by `kerf repair`, and validated again.\n\n"
            "Time between the last sample in the file and the kill (start-up and missed deadlines included): median %.3f s, "
            "95 %% %.3f s, largest %.3f s. %d of the files held no sample yet; the shortest after it held %d." % (
                kills, numpy.median(lost), numpy.percentile(lost, 95), max(lost), rows.count(0),
                min([count for count in rows if count > 0], default=0)))
    print(body)
    replace_section(house / "docs/benchmarks.md", "crash", "kill -9 at %d random moments" % kills, body)


main()
