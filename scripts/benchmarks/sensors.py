# peers: python3-numpy python3-h5py
# targets: kerf kerf-reader kerf-emulate
"""Streaming force sensors against their emulators: rows, losses, wrenches and times of a recording, and what a sensor costs the loop.

Each is recorded beside `sim:pose6` at 1 kHz while it loses frames; by turns the same loop without it."""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

from sections import replace_section

LOSS = "loss=0.01"
NEAR = 3000  # frames that a sensor's first number may be off from that of its trace
SENSORS = [  # what is played, how it is opened, what it loses
    ("Net F/T, 1 kHz", "net-ft?http=18080&port=18081&%s" % LOSS, "net-ft:127.0.0.1?http=18080&port=18081", ""),
    ("Net F/T, 7 kHz", "net-ft?http=18080&port=18081&rate=7000Hz&%s" % LOSS, "net-ft:127.0.0.1?http=18080&port=18081", ""),
    ("EtherDAQ", "onrobot?port=18081&%s" % LOSS, "onrobot:127.0.0.1?port=18081", ""),
    ("LabJack T7", "t7?port=18080&stream_port=18081", "t7:127.0.0.1?port=18080&stream_port=18081&calibration=%s", "drop@3:50"),
    ("Bota", "bota?link=%s&%s", "bota:%s", ""),
    ("OptoForce", "optoforce?link=%s&%s", "optoforce:%s?counts=100,100,100,2000,2000,2000", ""),
    ("FT300", "ft300?link=%s", "ft300:%s", ""),
]


def recorded(house, arguments, out):
    program = house / "build/release/bin/kerf"
    command = [str(program), "record", "--device", "sim:pose6?noise=off", "--json", "-o", str(out), *arguments]
    subprocess.run(command, check=True, capture_output=True, text=True)
    with h5py.File(out) as file:
        samples = file["samples"]
        rows = {name: samples[name][:] for name in ("time", "force_measured", "wake_latency", "flags")}
        for name in samples.get("channels", {}):
            rows[name] = samples["channels"][name][:]
    return rows


def trace_of(file):
    table = numpy.genfromtxt(file, delimiter=",", skip_header=1)
    # The last read-out alone: numbers begin anew with each.
    begins = numpy.flatnonzero(table[:, 0] == 1)
    table = table[begins[-1] if len(begins) else 0:]
    wrench = table[:, -7:-1]
    return {"number": table[:, 0], "host_ns": table[:, -8], "wrench": wrench, "left": table[:, -1]}


def judged(rows, trace, seconds):
    """Where frames stand in the trace is found by the wrenches of some, most of which have to agree: what acts comes again backwards."""
    known = numpy.isfinite(rows["force_measured"][:, 0]) & numpy.isfinite(rows["force_scan"])
    at = numpy.flatnonzero(known)
    scale = numpy.array([1, 1, 1, 20, 20, 20])
    offsets = []
    for row in at[::max(1, len(at) // 60)]:
        scan = int(rows["force_scan"][row])
        # What acts comes again after some ten seconds: near its number alone.
        first = max(0, scan - NEAR)
        near = numpy.abs((trace["wrench"][first:scan + NEAR] - rows["force_measured"][row]) * scale).max(axis=1)
        if len(near) > 0:
            offsets.append(first + int(numpy.argmin(near)) - scan)
    offset = max(set(offsets), key=offsets.count)
    index = rows["force_scan"][at].astype(int) + offset
    inside = (index >= 0) & (index < len(trace["left"]))
    at, index = at[inside], index[inside]
    error = numpy.abs(trace["wrench"][index] - rows["force_measured"][at])
    lost_before = numpy.cumsum(trace["left"] == 0)
    lost = lost_before[index] - lost_before[index[0]]
    told = rows["force_lost"][at] - rows["force_lost"][at[0]]
    taken = rows["time"][at] - rows["force_age"][at]
    late = taken - 1e-9 * (trace["host_ns"][index] - trace["host_ns"][index[0]])
    late -= numpy.median(late)
    return {"rows": len(rows["time"]), "without": int((~known).sum()), "lost": int(lost[-1]), "told": int(told[-1]),
            "wrong_rows": int((lost != told).sum()), "force": error[:, :3].max(), "torque": error[:, 3:].max(),
            "time": numpy.percentile(numpy.abs(late), 99), "age": numpy.median(rows["force_age"][at]), "expected": seconds * 1000}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("house", type=pathlib.Path)
    parser.add_argument("--seconds", type=int, default=60)
    given = parser.parse_args()
    bin_folder = given.house / "build/release/bin"
    lines = ["| sensor | rows of %d | without a force | frames lost | told lost | rows that tell another number | largest error [mN, mN·m] | times, 99 %% "
             "within [ms] | age, median [ms] | wake-up late by [us], 99.9 %%: with it | without |" % (1000 * given.seconds), "|---" * 11 + "|"]
    for name, device, uri, faults in SENSORS:
        with tempfile.TemporaryDirectory() as folder:
            here = pathlib.Path(folder)
            link = str(here / "port")
            played = device % (link, LOSS) if device.count("%s") == 2 else device % link if "%s" in device else device
            played += "&trace=%s" % (here / "trace.csv")
            opened = uri % (given.house / "examples/u6.calibration.toml" if "t7:" in uri else link) if "%s" in uri else uri
            emulator = subprocess.Popen([str(bin_folder / "kerf-emulate"), played, *(["--fault", faults] if faults else [])],
                                        stderr=subprocess.DEVNULL)
            time.sleep(0.5)
            try:
                with_it = recorded(given.house, ["--sensor", opened, "--seconds", str(given.seconds)], here / "with.h5")
            finally:
                emulator.terminate()
                emulator.wait()
            alone = recorded(given.house, ["--seconds", str(given.seconds)], here / "without.h5")
            found = judged(with_it, trace_of(here / "trace.csv"), given.seconds)
            late = [1e6 * numpy.percentile(rows["wake_latency"], 99.9) for rows in (with_it, alone)]
            lines.append("| %s | %d | %d | %d | %d | %d | %.3f, %.4f | %.2f | %.2f | %.0f | %.0f |" % (
                name, found["rows"], found["without"], found["lost"], found["told"], found["wrong_rows"], 1e3 * found["force"],
                1e3 * found["torque"], 1e3 * found["time"], 1e3 * found["age"], *late))
            print(lines[-1], flush=True)
    body = "\n".join(["Each beside `sim:pose6` at 1 kHz, its emulator on the same machine; one frame of a hundred never leaves (of the T7 50 in a row, of the FT300, "
                      "whose frames have no count, none). Errors: the wrench of a row against that of its frame; half a count is 0.0005 mN of the Net F/T, "
                      "0.05 mN of the EtherDAQ, 5 mN of the others that count. Times: `time - force_age` against the moment of the reading, but for what all "
                      "have alike.", "", *lines])
    replace_section(given.house / "docs/benchmarks.md", "sensors", "Force sensors that stream", body)
    return 0


if __name__ == "__main__":
    sys.exit(main())
