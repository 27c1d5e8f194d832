# peers:
"""How long a build takes from nothing, and after an edit: without ccache, of a clone of the last commit.

scripts/benchmark build
"""

import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

from sections import replace_section


def timed(command, folder):
    """Returns wall and processor time [s] of a command and all that it starts."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.monotonic()
    environment = dict(os.environ, CCACHE_DISABLE="1")
    result = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    wall = time.monotonic() - begin
    if result.returncode != 0:
        sys.exit("%s: %s%s" % (" ".join(command), result.stdout[-2000:], result.stderr[-2000:]))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def edited(clone, source, target, tests):
    """A line added at the end of `source`, `target` built, and its `tests` run."""
    with open(clone / source, "a") as file:
        file.write("// An edit.\n")
    build = timed(["scripts/build", "release", "--target", target], clone)
    run = timed(["build/release/bin/" + target, "--gtest_filter=" + tests], clone) if tests else (0.0, 0.0)
    return build[0] + run[0], build[1] + run[1]


def main():
    house = pathlib.Path(sys.argv[1])
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        clone = pathlib.Path(folder, "kerf")
        subprocess.run(["git", "clone", "--quiet", str(house), str(clone)], check=True)
        build = ["scripts/build", "release"]
        rows.append(("the program, as `scripts/demo` builds it", timed(build + ["--target", "kerf"], clone)))
        rows.append(("all tests, after it", timed(build, clone)))
        rows.append(("an edit in `models/src/orthogonal.cpp`, and its tests",
                     edited(clone, "models/src/orthogonal.cpp", "kerf_models_test", "Orthogonal*")))
        rows.append(("an edit in `kelvin.h`, and its tests",
                     edited(clone, "models/include/kerf/models/kelvin.h", "kerf_models_test", "Kelvin*")))
        rows.append(("the program, after that", edited(clone, "models/include/kerf/models/kelvin.h", "kerf", "")))
    lines = ["| what | wall [s] | processor [s] |", "|---|---|---|"]
    lines += ["| %s | %.0f | %.0f |" % (what, wall, processor) for what, (wall, processor) in rows]
    lines += ["", "GCC, `release`, without ccache, of a clone of the last commit; what npm and apt fetch was there already."]
    replace_section(house / "docs/benchmarks.md", "build", "Building from nothing, and after an edit", "\n".join(lines))


main()
