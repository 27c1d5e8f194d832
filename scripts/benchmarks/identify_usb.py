# peers: python3-numpy python3-h5py
# targets: kerf kerf-reader kerf-emulate
"""What `kerf identify` finds of emulated devices over USB, in the guest of scripts/usb-machine and in virtual time.

    scripts/benchmark identify_usb

The tip of each is moved by its motors alone (hand=off), by a closed form of its own. The truth of the delay is what was set and
what the bus and the driver take, told by the emulator's trace: from the frame whose encoders a tick read to the frame that carried
the force of that tick.
"""

import argparse
import csv
import json
import pathlib
import shutil
import statistics
import subprocess
import sys

import h5py
import numpy

from sections import replace_section

DEVICES = {"falcon": ("falcon:0", "falcon?firmware=loaded&homed=on"), "woody": ("hid:1234:0006", "woody?generation=v2")}
DELAYS_MS = (0.4, 1.7)
TRUTH = {"mass": 0.15, "viscous": 1.0, "coulomb": 0.1}
COMMAND = ("identify", "--axis", "z", "--free", "--yes", "--max-force", "2", "--travel", "0.016", "--seconds", "10", "--period", "0.5",
           "--band", "4", "100", "--json")
IN_GUEST = """
export XDG_DATA_HOME="$3"
"$1/kerf-emulate" "$4" --attach >"$3/emulated.txt" 2>&1 &
for wait in $(seq 100); do "$1/kerf" devices | grep -q "$2" && break; sleep 0.1; done
"$1/kerf" "${@:5}" -o "$3/found" >"$3/identify.json" 2>"$3/errors.txt"
status=$?
kill %1
exit $status
"""


def measure(house, folder, device, delay_ms):
    """identify.json of a device whose delay was set; what it does stays in the folder."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    uri, emulated = DEVICES[device]
    truth = "&".join(f"{name}={TRUTH[name]}{unit}" for name, unit in (("mass", "kg"), ("viscous", "Ns/m"), ("coulomb", "N")))
    emulated += f"&hand=off&{truth}&delay={delay_ms}ms&trace={folder}/trace.csv"
    verb, *options = COMMAND
    subprocess.run([house / "scripts/usb-machine", "--virtual-time", "--seconds", "1800", "--", "bash", "-c", IN_GUEST, "bash",
                    house / "build/release/bin", uri, folder, emulated, verb, uri, *options], check=True)
    return json.loads((folder / "identify.json").read_text())


def on_the_way(folder):
    """Seconds from reading to acting, mean and spread, and the metres of a count, by the emulator's trace."""
    with open(folder / "trace.csv", newline="") as file:
        head, *rows = csv.reader(file)
    rows = [row for row in rows if len(row) == len(head)]
    if "event" in head:
        rows = [row for row in rows if row[1] == "report"]
    motors, counts = ([i for i, name in enumerate(head) if name.startswith(begin)][:3] for begin in (("motor_", "mA_"), ("encoder_", "enc_")))
    time = numpy.array([float(row[0]) for row in rows])
    height = numpy.array([float(row[head.index("z_m" if "z_m" in head else "z")]) for row in rows])
    motor = numpy.array([[float(row[i]) for i in motors] for row in rows])
    count = numpy.array([[float(row[i]) for i in counts] for row in rows])
    with h5py.File(folder / "found/z.h5") as file:
        seen = file["samples/position"][:, 2]
        force = file["samples/force_commanded"][:, 2]
    begin, end = len(seen) // 5, len(seen) - 100
    shift = min(range(len(time) - len(seen)), key=lambda k: numpy.square(height[begin + k : end + k] - seen[begin:end]).sum())

    def unexplained(lag):
        sent = motor[begin + shift + lag : end + shift + lag]
        sent = numpy.column_stack([sent, sent * height[begin + shift : end + shift, None], numpy.ones(len(sent))])
        return numpy.square(force[begin:end] - sent @ numpy.linalg.lstsq(sent, force[begin:end], rcond=None)[0]).sum()

    lag = min(range(6), key=unexplained)
    late = time[begin + shift + lag : end + shift + lag] - time[begin + shift : end + shift]
    most = count[begin + shift : end + shift].std(axis=0).argmax()  # of encoders that move together, or the one that moves
    slope = numpy.polyfit(count[begin + shift : end + shift, most], height[begin + shift : end + shift], 1)[0]
    return statistics.fmean(late), statistics.pstdev(late), abs(float(slope))


def interval(number, factor=1.0, digits=3):
    if not number or number["value"] is None:
        return "unknown"
    return "%.*f (%.*f to %.*f)" % (digits, factor * number["value"], digits, factor * number["lower"], digits, factor * number["upper"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("house", type=pathlib.Path)
    given = parser.parse_args()
    table = ["| device | delay set [ms] | and on the way | together | found | step at the middle [um] | found | mass [kg] | viscous friction [N·s/m] | Coulomb friction [N] | misses [%] |",
             "|---|---|---|---|---|---|---|---|---|---|---|"]
    for device in DEVICES:
        for delay_ms in DELAYS_MS:
            folder = given.house / f"build/benchmarks/identify-usb/{device}-{delay_ms}"
            axis = measure(given.house, folder, device, delay_ms)["axes"][0]
            if axis["problem"]:
                sys.exit(f"{device} with {delay_ms} ms: {axis['problem']}")
            late_s, spread_s, step_m = on_the_way(folder)
            step = axis["encoder_step"] or axis["local_step"]
            table.append("| %s | %g | %.3f ± %.3f | %.3f | %s | %.2f | %s | %s | %s | %s | %.2g |" % (
                device, delay_ms, 1e3 * late_s, 1e3 * spread_s, 1e3 * late_s + delay_ms, interval(axis["delay_s"], 1e3),
                1e6 * step_m, interval(step, 1e6, 2), interval(axis["mass"], digits=4), interval(axis["viscous"]), interval(axis["coulomb"], digits=4),
                100.0 * axis["validation_error"]))
            print(table[-1], flush=True)
    body = ("Emulated devices on a USB of their own (`scripts/usb-machine`, virtual time), each with another delay: mass %(mass)g kg, viscous friction "
            "%(viscous)g N·s/m, Coulomb friction %(coulomb)g N. `kerf " % TRUTH + " ".join(COMMAND[:1] + ("URI",) + COMMAND[1:-1])
            + "`; in brackets intervals of 95 %.\n\n" + "\n".join(table))
    replace_section(given.house / "docs/benchmarks.md", "identify_usb", "Devices identified over USB", body)


if __name__ == "__main__":
    main()
