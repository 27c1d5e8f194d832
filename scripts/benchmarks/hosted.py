# peers: python3-numpy python3-h5py
# targets: kerf kerf-reader kerf-emulate kerf-device-host
"""Devices in a process of their own against their emulators: rows, gaps, ages and positions of a recording, what they cost the loop, and how
long a force goes on after the program was killed.

Each is recorded at 1 kHz; by turns the same loop with a simulated device, which has no process."""

import argparse
import csv
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

from sections import replace_section

DEVICES = [  # what is played, how it is opened
    ("plug-in of `kerf device new`", "slider?link=%s", "plugin:%s?port=%s"),
    ("WoodenHaptics V4", "woody-v4?link=%s", "woody-v4:%s"),
    ("Inverse3", "inverse3?port=18090", "inverse3:127.0.0.1?port=18090"),
    ("2DIY", "2diy?link=%s", "2diy:%s"),
    ("Hapkit", "hapkit?link=%s", "hapkit:%s"),
]
LAW = """model = "kelvin"
axis = "x"
position_unit = "m"
force_unit = "N"
contact = { position = { value = 1, unit = "m" }, direction = "decreasing" }
[parameters]
parallel_stiffness = { value = 0.3, unit = "N/m" }
series_stiffness = { value = 0.001, unit = "N/m" }
damping = { value = 0.001, unit = "N·s/m" }
"""  # a force of 0.3 N everywhere


def recorded(program, device, seconds, out):
    subprocess.run([str(program), "record", "--device", device, "--seconds", str(seconds), "-o", str(out)], check=True, capture_output=True)
    with h5py.File(out) as file:
        rows = {name: file["samples"][name][:] for name in ("time", "position", "wake_latency", "read_time", "write_time")}
        for name in file["samples"].get("channels", {}):
            rows[name] = file["samples"]["channels"][name][:]
        rows["missing"] = float(file["device"].attrs.get("reports_missing", 0.0)) if "device" in file else 0.0
    return rows


def force_after_kill(program, device, folder, trace):
    """How long after SIGKILL the emulator's motors still had a force [ms]."""
    law = folder / "everywhere.law.toml"
    law.write_text(LAW)
    running = subprocess.Popen([str(program), "record", "--device", device, "--law", str(law), "--seconds", "20", "-o", str(folder / "killed.h5")],
                               stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    time.sleep(2.5)
    killed_ns = time.monotonic_ns()
    os.kill(running.pid, signal.SIGKILL)
    running.wait()
    time.sleep(1.0)
    with open(trace) as lines:
        rows = [row for row in csv.reader(lines) if len(row) >= 6 and row[2] != "frame"][1:]
    held = [row for row in rows if int(row[1]) < killed_ns and float(row[3]) != 0.0]
    zero = [int(row[1]) for row in rows if int(row[1]) >= killed_ns and float(row[3]) == 0.0]
    return (zero[0] - killed_ns) / 1e6 if held and zero else float("nan")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("house", type=pathlib.Path)
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--kills", type=int, default=10)
    given = parser.parse_args()
    programs = (given.house / "build/release/bin").resolve()
    program = programs / "kerf"
    lines = ["| device | rows of %d | readings missing | age of a reading [ms]: median | 99 %% | wake-up late by [us], 99.9 %%: with it | simulated | read and write "
             "of a tick [us], 99.9 %%: with it | simulated | killed: force goes on for [ms], median | longest of %d |" % (1000 * given.seconds, given.kills),
             "|---" * 11 + "|"]
    with tempfile.TemporaryDirectory() as folder:
        here = pathlib.Path(folder)
        subprocess.run([str(program), "device", "new", "slider", "-o", str(here / "slider")], check=True, capture_output=True)
        subprocess.run([str(program), "device", "build", str(here / "slider/slider.c"), "-o", str(here / "slider.so")], check=True, capture_output=True)
        for name, played, uri in DEVICES:
            link = str(here / "port")
            played = played % link if "%s" in played else played
            device = uri % (here / "slider.so", link) if uri.count("%s") == 2 else uri % link if "%s" in uri else uri

            def emulated(trace):
                process = subprocess.Popen([str(programs / "kerf-emulate"), "%s%strace=%s" % (played, "&" if "?" in played else "?", trace)],
                                           stderr=subprocess.DEVNULL)
                time.sleep(0.7)
                return process

            emulator = emulated(here / "trace.csv")
            try:
                rows = recorded(program, device, given.seconds, here / "with.h5")
            finally:
                emulator.terminate()
                emulator.wait()
            alone = recorded(program, "sim:axis", given.seconds, here / "without.h5")
            for file in ("with.h5", "without.h5"):
                (here / file).unlink()
            ends = []
            for _ in range(given.kills):
                emulator = emulated(here / "killed.csv")
                try:
                    ends.append(force_after_kill(program, device, here, here / "killed.csv"))
                finally:
                    emulator.terminate()
                    emulator.wait()
                for left in here.glob("killed.h5*"):
                    left.unlink()
            late = [1e6 * numpy.percentile(one["wake_latency"], 99.9) for one in (rows, alone)]
            ticks = [1e6 * numpy.percentile(one["read_time"] + one["write_time"], 99.9) for one in (rows, alone)]
            age = 1e3 * rows["report_age"]
            lines.append("| %s | %d | %d | %.2f | %.2f | %.0f | %.0f | %.1f | %.1f | %.1f | %.1f |" % (
                name, len(rows["time"]), rows["missing"], numpy.median(age), numpy.percentile(age, 99), *late, *ticks, numpy.median(ends), max(ends)))
            print(lines[-1], flush=True)
    body = "\n".join(["Each by the wall clock, its emulator on the same machine, on which it competes for the processors; the simulated device is `sim:axis`, whose physics are "
                      "in the read. Killed: by SIGKILL while a force of 0.3 N acts, to the first row of the emulator's trace in which its motors have none.", "", *lines])
    replace_section(given.house / "docs/benchmarks.md", "hosted", "Devices in a process of their own", body)
    return 0


if __name__ == "__main__":
    sys.exit(main())
