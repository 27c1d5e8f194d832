#!/usr/bin/env python3
"""examples/data/punch.txt is what the command beside it makes, to the last byte. Arguments: the folder, the program kerf."""
import subprocess
import sys
import tempfile
from pathlib import Path

folder, kerf = Path(sys.argv[1]), sys.argv[2]
with tempfile.TemporaryDirectory() as made:
    # Debian's Python, which has h5py.
    subprocess.run(["/usr/bin/python3", folder / "make_punch.py", kerf, Path(made) / "punch.txt"], check=True)
    if (Path(made) / "punch.txt").read_bytes() != (folder / "punch.txt").read_bytes():
        sys.exit("examples/data/punch.txt is not what make_punch.py makes: run it again if the simulation changed on purpose")
