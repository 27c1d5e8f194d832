# peers: python3-h5py python3-numpy
# targets: kerf kerf_reader kerf_recording_benchmark kerf_live_benchmark kerf_page_checks
"""What stands behind `kerf studio`: each studio_*.py beside this one measures one thing and writes its section.

All of them, or one: scripts/benchmark studio [loop]
"""

import importlib
import pathlib
import sys

from sections import replace_section


def main():
    house = pathlib.Path(sys.argv[1])
    parts = sys.argv[2:] or sorted(path.stem[len("studio_"):] for path in pathlib.Path(__file__).parent.glob("studio_*.py"))
    for part in parts:
        title, body = importlib.import_module("studio_" + part).measure(house)
        print(body)
        replace_section(house / "docs/benchmarks.md", "studio-" + part, title, body)


main()
