# peers: python3-numpy python3-scipy python3-lmfit r-base-core r-cran-segmented
# targets: kerf kerf_fit_benchmark kerf_segmented_benchmark kerf_coverage_study
"""Fits against SciPy, lmfit and R, by turns in one run. Without arguments every part runs and the section is
written; `scripts/benchmark fit speed nist` runs and prints only the parts that are named.
"""

import pathlib
import sys
import time

import fit_coverage
import fit_folder
import fit_laws
import fit_nist
import fit_segments
import fit_speed
from sections import replace_section

PARTS = {
    "speed": fit_speed.part,
    "laws": fit_laws.part,
    "nist": fit_nist.part,
    "segments": fit_segments.part,
    "folder": fit_folder.part,
    "coverage": fit_coverage.part,
}


def main():
    house, named = pathlib.Path(sys.argv[1]), sys.argv[2:]
    unknown = [name for name in named if name not in PARTS]
    if unknown:
        sys.exit("no part is called %s; parts: %s" % (", ".join(unknown), " ".join(PARTS)))
    texts = []
    for name in named or PARTS:
        begin = time.perf_counter()
        texts.append(PARTS[name](house))
        print("%s\n\n(%s: %.0f s)\n" % (texts[-1], name, time.perf_counter() - begin), flush=True)
    if not named:
        replace_section(house / "docs/benchmarks.md", "fit", "Fits against SciPy, lmfit and R", "\n\n".join(texts))


main()
