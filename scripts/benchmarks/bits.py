# peers: clang
# targets: kerf
"""Are the forces of Kerf's own laws the same bits whoever compiles them, and wherever they run? The laws are compiled anew as
each row says and linked into the program in place of its own; `kerf regress run` then compares with what is stored. Writes
the table into docs/regress.md. `scripts/benchmark bits WORD` measures the rows with that word alone and prints them."""

import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

from sections import replace_section

LIBRARIES = ["models/libkerf_models.a", "models/mechanisms/libkerf_mechanisms.a"]
BUILDS = [
    ("as released", "as released", None, [], {}),
    ("-O0", "{gcc}, -O0", "g++", ["-O0"], {}),
    ("clang -O3", "{clang}, -O3", "clang++", ["-O3"], {}),
    ("clang -O0", "{clang}, -O0", "clang++", ["-O0"], {}),
    ("native", "{gcc}, -O3 -march=native", "g++", ["-O3", "-march=native"], {}),
    ("fma", "{gcc}, -O3 -mfma -ffp-contract=fast, which Kerf forbids", "g++", ["-O3", "-mfma", "-ffp-contract=fast"], {}),
    ("no-FMA", "as released, on a processor without FMA and AVX2 (`GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA`)", None, [],
     {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"}),
]
OF_GCC = re.compile(r"-O[0-3s]|-Wno-(maybe-uninitialized|stringop-overflow)|-fno-var-tracking\S*")


def commands(build, target):
    return subprocess.run(["ninja", "-C", build, "-t", "commands", target], check=True, capture_output=True, text=True).stdout.splitlines()


def compiled(build, folder, library, compiler, flags):
    """The library as another compiler makes it."""
    objects, tasks = [], []
    stem = pathlib.Path(library).name[len("lib"):-len(".a")]
    for line in commands(build, library):
        words = shlex.split(line)
        if "-c" not in words or ("/%s.dir/" % stem) not in words[words.index("-o") + 1]:
            continue
        words = words[next(i for i, word in enumerate(words) if re.search(r"(\+\+|clang\+\+|g\+\+)(-\d+)?$", word)):]
        words = [compiler] + [word for word in words[1:] if not OF_GCC.fullmatch(word) and word != "-Werror"] + ["-w"] + flags
        objects.append(str(folder / ("%s-%d.o" % (stem, len(objects)))))
        words[words.index("-o") + 1] = objects[-1]
        for option in ("-MF", "-MT"):
            if option in words:
                del words[words.index(option):words.index(option) + 2]
        tasks.append([word for word in words if word != "-MD"])
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda words: subprocess.run(words, cwd=build, check=True), tasks))
    made = folder / pathlib.Path(library).name
    subprocess.run(["ar", "rcs", made] + objects, check=True)
    return made


def linked(build, folder, made):
    """The program with other laws, and the programs that help it beside it."""
    line = commands(build, "bin/kerf")[-1]
    for library, other in made.items():
        if library not in line:
            sys.exit("%s is not linked into kerf any more" % library)
        line = line.replace(library, str(other))
    program = folder / "bin" / "kerf"
    program.parent.mkdir()
    for helper in (build / "bin").glob("kerf-*"):
        (program.parent / helper.name).symlink_to(helper)
    subprocess.run(line.replace("-o bin/kerf ", "-o %s " % shlex.quote(str(program))), shell=True, cwd=build, check=True)
    return program


def measured(program, suite, environment):
    run = subprocess.run([program, "regress", "run", suite, "--no-cost", "--json"], env={**os.environ, **environment},
                         capture_output=True, text=True)
    if run.returncode not in (0, 1):
        sys.exit(run.stderr)
    cases = json.loads(run.stdout)["cases"]
    differing = [case for case in cases if case["differing"]]
    most = {}
    for case in differing:
        for channel in case["channels"]:
            most[channel["unit"]] = max(most.get(channel["unit"], 0.0), channel["largest_difference"])
    names = ", ".join("`%s`" % case["name"] for case in differing) or "nothing"
    ticks = sum(case["differing"] for case in differing)
    outside = [case["name"] for case in cases if not case["passed"]]
    return "%s | %s | %s | %s" % (
        names, ticks, ", ".join("%.2g %s" % (value, unit) for unit, value in sorted(most.items()) if value) or "none: bit for bit",
        "all" if not outside else "all but " + ", ".join("`%s`" % name for name in outside))


def version(compiler):
    words = subprocess.run([compiler, "--version"], check=True, capture_output=True, text=True).stdout.splitlines()[0].split()
    return next(word for word in words if re.fullmatch(r"\d+\.\d+(\.\d+)?", word))


def main():
    house, chosen = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    build = house / "build/release"
    suite = house / "examples/regress/kerf.toml"
    names = {"gcc": "GCC " + version("g++"), "clang": "Clang " + version("clang++")}
    lines = ["| laws compiled or run with | differs in | ticks | largest difference | within the tolerance |", "|---|---|---|---|---|"]
    for short, name, compiler, flags, environment in BUILDS:
        if chosen and not any(word in short for word in chosen):
            continue
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            program = build / "bin/kerf"
            if compiler:
                program = linked(build, folder, {library: compiled(build, folder, library, compiler, flags) for library in LIBRARIES})
            lines.append("| %s | %s |" % (name.format(**names), measured(program, suite, environment)))
            print(lines[-1], flush=True)
    if not chosen:
        libc = os.confstr("CS_GNU_LIBC_VERSION")
        lines[0] = "All as released is %s -O3, %s.\n\n%s" % (names["gcc"], libc, lines[0])
        replace_section(house / "docs/regress.md", "bits", "Bit for bit", "\n".join(lines))


main()
