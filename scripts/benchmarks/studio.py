# peers:
# targets: kerf_live_benchmark
"""What `kerf studio` costs: scripts/benchmark studio [TURNS [SECONDS]]"""

import pathlib
import sys

from sections import replace_section
from studio_loop import loop_section


def main():
    house = pathlib.Path(sys.argv[1])
    turns = max(9, int(sys.argv[2])) if len(sys.argv) > 2 else 11
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 10.0
    body = loop_section(house, turns, seconds)
    print(body)
    replace_section(house / "docs/benchmarks.md", "studio", "A loop that is watched", body)


main()
