"""Makes the files of this folder: python3 make.py (with openpyxl, NumPy, SciPy, h5py, hdf5storage, LibreOffice, gzip and iconv of Debian 12)."""

import datetime
import pathlib
import subprocess

import h5py
import hdf5storage
import numpy as np
import openpyxl
import scipy.io

time = np.arange(40) / 100.0
position = 0.01 * np.sin(7.0 * time)  # m
force = 300.0 * position + 0.1  # N

with open("punch.txt", "w", encoding="utf-8") as text:
    text.write("time\tposition\tforce\ns\tm\tN\n")
    for row in zip(time, position, force):
        text.write("%r\t%r\t%r\n" % tuple(map(float, row)))
subprocess.run("gzip -n -9 -c punch.txt > punch.txt.gz; (head -20 punch.txt | gzip -n; tail -n +21 punch.txt | gzip -n) > members.txt.gz;"
               "iconv -t UTF-16 punch.txt > punch-utf16.txt; iconv -t UTF-16BE punch.txt > punch-utf16be.txt", shell=True, check=True)

book = openpyxl.Workbook()
notes = book.active
notes.title = "Notes"
notes["A1"] = "The hand of the author"
hidden = book.create_sheet("Old")
hidden.sheet_state = "hidden"
hidden.append([1, 2, 3])
run = book.create_sheet("Run 1")
run.append(["Punch of a sheet"])
run.merge_cells("A1:C1")
run.append(["time", "position", "force", "sum", "at"])
run.append(["s", "m", "N", "1", "s"])
for t, x, f in zip(time, position, force):
    row = run.max_row + 1
    # One in four forces was typed with a decimal comma; sums are formulas that nobody has computed.
    written = str(float(f)).replace(".", ",") if row % 4 == 0 else float(f)
    run.append([float(t), float(x), written, "=A%d+B%d" % (row, row), datetime.datetime(2026, 1, 31, 12) + datetime.timedelta(seconds=float(t))])
run["C20"] = "slipped"
run["C21"] = "#N/A"
second = book.create_sheet("Run 2")
for t in time[:10]:
    second.append([float(t), 0.001 * float(t), 2.0])
book.save("punch.xlsx")
subprocess.run(["soffice", "--headless", "--convert-to", "xls", "punch.xlsx"], check=True)  # which computes the formulas

scipy.io.savemat("punch.mat", {"t": time, "run": {"x": position, "f": force.astype(np.float32), "gain": 3.0, "who": "nobody"},
                               "counts": np.arange(80, dtype=np.int16).reshape(40, 2), "short": np.arange(7.0)}, do_compression=True)
scipy.io.savemat("plain.mat", {"t": time[:, None], "x": position[:, None], "f": force[:, None]}, do_compression=False)


def as_matlab_writes(_, item):
    """A class as MATLAB writes it: a text that ends by a zero (NULLTERM). h5py and hdf5storage pad it with zeros, which matio does not read."""
    text = item.attrs.get("MATLAB_class")
    if text is None:
        return
    kind = h5py.h5t.C_S1.copy()
    kind.set_size(len(text))
    del item.attrs["MATLAB_class"]
    h5py.h5a.create(item.id, b"MATLAB_class", kind, h5py.h5s.create(h5py.h5s.SCALAR)).write(np.array(text), mtype=kind)


pathlib.Path("punch73.mat").unlink(missing_ok=True)
hdf5storage.savemat("punch73.mat", {"t": time, "run": {"x": position, "f": force.astype(np.float32), "gain": 3.0, "who": "nobody"},
                                    "counts": np.arange(80, dtype=np.int16).reshape(40, 2), "ticks": 2**53 - 390 + 10 * np.arange(40, dtype=np.int64),
                                    "stamps": 1769860800000000001 + np.arange(40, dtype=np.int64), "touches": force > 1.0},
                    format="7.3", oned_as="column", store_python_metadata=False)
with h5py.File("punch73.mat", "r+") as file:
    objects = file.create_dataset("objects", data=np.array([[0xDD000000, 2, 1, 1, 1, 1]], np.uint32))  # as a table refers to what it holds
    objects.attrs["MATLAB_class"] = np.bytes_("table")
    objects.attrs["MATLAB_object_decode"] = np.int32(3)
    file.visititems(as_matlab_writes)
