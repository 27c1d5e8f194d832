"""Makes the files of this folder: python3 make.py (with openpyxl, NumPy, SciPy, gzip and iconv of Debian 12)."""

import datetime
import subprocess

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

scipy.io.savemat("punch.mat", {"t": time, "run": {"x": position, "f": force.astype(np.float32), "gain": 3.0, "who": "nobody"},
                               "counts": np.arange(80, dtype=np.int16).reshape(40, 2), "short": np.arange(7.0)}, do_compression=True)
scipy.io.savemat("plain.mat", {"t": time[:, None], "x": position[:, None], "f": force[:, None]}, do_compression=False)
