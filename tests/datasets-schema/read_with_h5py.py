"""What h5py, which knows nothing of Kerf, sees in a recording. Exits with a traceback where it sees another thing.

read_with_h5py.py layout FILE: the recording of sample_recording.h with 5 rows, written at once.
read_with_h5py.py follow FILE ROWS: a recording that is still written, until it has so many rows.
"""

import sys
import time

import h5py
import numpy as np

MATRICES = ["position", "velocity", "force_commanded", "force_measured"]
TIMES = ["wake_latency", "read_time", "compute_time", "write_time"]


def equal(found, expected):
    assert found == expected, f"found {found!r}, expected {expected!r}"


def check_root(file):
    equal(file.attrs["schema"], "kerf.recording")
    equal(int(file.attrs["schema_version"]), 1)
    equal(file.attrs["created"], "2026-01-31T12:00:00Z")
    equal(file.attrs["software"], "kerf 0.1.0")
    equal(file.attrs["uuid"], "0b5f1e0a-54bb-4c5e-9d55-6cf3f4d33c11")
    equal(file.attrs["status"], "complete")
    equal(file.attrs["source"], "cut.txt, SHA-256 00ff")
    equal(int(file.attrs["start_ns"]), 1769860800123456789)
    equal(file.attrs["start_clock"], "local")
    equal(file["device"].attrs["uri"], "sim:scissors?seed=3")
    equal(file["device"].attrs["maker"], "Schärfe")
    equal(float(file["device"].attrs["resolution_rad"]), 0.00098)
    equal(file["scene"].attrs["toml"], 'tissue = "Gewebe µ"\n')


def check_samples(samples, rows):
    equal(list(samples.attrs["axes"]), ["theta", "x_s"])
    equal(list(samples.attrs["force_units"]), ["N·m", "N"])
    equal(list(samples.attrs["levers"]), [0.0369, 1.0])
    equal(set(samples), {"time", "tick", "flags", "channels", *MATRICES, *TIMES})
    units = {"position": ["rad", "m"], "velocity": ["rad/s", "m/s"]}
    for name in MATRICES:
        equal((samples[name].shape, samples[name].dtype), ((rows, 2), np.dtype("<f8")))
        equal(list(samples[name].attrs["units"]), units.get(name, ["N·m", "N"]))
    types = {"time": "<f8", "tick": "<u8", "flags": "<u4", **dict.fromkeys(TIMES, "<f4")}
    for name, dtype in types.items():
        equal((samples[name].shape, samples[name].dtype), ((rows,), np.dtype(dtype)))
        equal(samples[name].attrs["units"], "1" if name in ("tick", "flags") else "s")
    equal(samples["velocity"].attrs["derived"], "quadratic over 20 ms")
    meanings = samples["flags"].attrs["flag_meanings"].split()
    equal(list(samples["flags"].attrs["flag_masks"]), [1 << bit for bit in range(len(meanings))])
    equal(meanings[0], "missed_deadline")
    channel = samples["channels/µ temperature"]
    equal((channel.shape, channel.dtype, channel.attrs["units"]), ((rows,), np.dtype("<f8"), "K"))


def check_scales(file):
    samples = file["samples"]
    datasets = [samples[name] for name in MATRICES + TIMES + ["tick", "flags"]]
    for dataset in datasets + list(samples["channels"].values()):
        equal(dataset.dims[0].keys(), ["time"])
        equal(dataset.dims[0]["time"], samples["time"])
    for name in ("closing_mean", "opening_mean"):
        equal(file["cycles"][name].dims[0].keys(), ["grid"])
    for name in ("closing", "opening"):
        equal(file["cycles"][name].dims[1].keys(), ["grid"])
    equal(samples["position"].dims[1].label, "axis")


def check_tables(file):
    events = file["events"]
    equal(events.dtype.names, ("time", "kind", "text"))
    equal(list(events.attrs["units"]), ["s", "1", "1"])
    equal(events[1]["kind"].decode(), "gap")
    equal(events[1]["text"].decode(), "7 ticks – the device was silent")
    phases = file["cycles/phases"]
    equal([phases.dtype[name].str for name in phases.dtype.names], ["<u4", "|u1", "<u8", "<u8"])
    equal(phases.dtype.names, ("cycle", "phase", "begin", "end"))
    equal(list(phases["phase"]), [3, 1])
    equal(file["cycles/grid"].attrs["units"], "rad")
    equal(file["cycles/closing"].attrs["units"], "N·m")
    equal(file["cycles/closing"].shape, (2, 3))
    equal(bool(np.isnan(file["cycles/closing"][0, 2])), True)
    equal(float(file["cycles"].attrs["closing_direction"]), -1.0)


def check_edits(changes):
    names = ("edit", "cycle", "phase", "row_before", "row_after", "time", "author", "kind", "text")
    equal(changes.dtype.names, names)
    equal([changes.dtype[name].str for name in names[:5]], ["<u4", "<u4", "|u1", "<i8", "<i8"])
    equal(changes.attrs["units"], "1")
    equal([int(it) for it in changes["edit"]], [1, 1, 2])
    equal([int(it) for it in changes["row_after"]], [2, -1, 3])
    equal([it.decode() for it in changes["author"]], ["Anna Ω", "Anna Ω", "Bo"])
    equal([it.decode() for it in changes["kind"]], ["begin", "left_out", "split"])
    equal(changes[2]["time"].decode(), "2026-02-02T09:00:00Z")


def check_layout(path):
    with h5py.File(path, "r") as file:
        check_root(file)
        check_samples(file["samples"], 5)
        check_scales(file)
        check_tables(file)
        check_edits(file["cycle_edits/changes"])
        np.testing.assert_array_equal(file["samples/tick"][:], [0, 1, 2, 10, 11])
        # numpy has a sine of its own, which may round otherwise
        np.testing.assert_allclose(file["samples/position"][:, 1], np.sin(3.0 * np.arange(5.0)), rtol=1e-15)


def follow(path, rows):
    with h5py.File(path, "r", libver="latest", swmr=True) as file:
        equal(file.attrs["status"], "recording")
        times, positions = file["samples/time"], file["samples/position"]
        equal(positions.dims[0]["time"], times)
        print("open", len(times), flush=True)
        deadline = time.monotonic() + 60.0
        while len(times) < rows:
            assert time.monotonic() < deadline, f"{len(times)} rows after a minute"
            time.sleep(0.01)
            times.refresh()
        positions.refresh()
        np.testing.assert_array_equal(times[:rows], np.arange(rows) / 1000.0)
        np.testing.assert_array_equal(positions[:rows, 0], np.arange(float(rows)))


if __name__ == "__main__":
    if sys.argv[1] == "layout":
        check_layout(sys.argv[2])
    else:
        follow(sys.argv[2], int(sys.argv[3]))
