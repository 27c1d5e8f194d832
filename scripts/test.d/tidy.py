#!/usr/bin/env python3
"""Runs clang-tidy with the checks of .clang-tidy, on what changed or on everything, in parallel, and keeps the results.

    scripts/test.d/tidy.py [--all | --commits N] [--fresh] BUILD

BUILD is a folder that Clang has compiled, for example build/dev; --commits asks for what changed in the last N.
What has changed is said in changed_files.py; a changed header is read in a changed source that includes it, else alone, else in
another source that does. Sources that clash in no name are read together, since most of the time goes into what they all include. A result is kept in build/tidy-cache under the hash of the preprocessed text with its comments (which hold the
NOLINTs), the command, the checks and the version of clang-tidy; with --fresh none is looked up or kept, which saves reading
everything a second time where nothing is known from before.

Exit status: 0 if nothing was found, 1 if something was, 2 for bad usage.
"""

import concurrent.futures
import dataclasses
import hashlib
import os
import re
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

from changed_files import changed_files, parser_of
from compile_commands import ROOT, Unit, read_units, without_precompiled_header
from headers_alone import included_names
from joint_sources import joined

SOURCES = {".cpp"}
HEADERS = {".h"}


def by_itself(unit: Unit, source: Path) -> Unit:
    return dataclasses.replace(unit, source=source, includes=())


def units_of_changes(units: list[Unit], changed: set[Path]) -> list[Unit]:
    """What has to be read for every changed file to be read."""
    chosen: dict[Path, Unit] = {}
    included: set[str] = set()  # names, of all that the chosen sources include
    for path in sorted(changed, key=lambda path: (path.suffix not in SOURCES, path)):
        if path.suffix in SOURCES:
            holders = [unit for unit in units if unit.source == path or path in unit.includes]
            if holders:
                chosen[path] = by_itself(holders[0], path)
                included |= included_names(path)
        elif path.suffix in HEADERS and path.name not in included:
            alone = [unit for unit in units if unit.is_header_alone and path in unit.includes]
            user = None if alone else source_that_includes(path, units)
            if alone:
                chosen[alone[0].source] = alone[0]
            elif user:
                chosen.setdefault(user.source, user)
    return list(chosen.values())


def source_that_includes(header: Path, units: list[Unit]) -> Unit | None:
    """The source beside it of the same name, or the first whose own text names it."""
    sources = {source: unit for unit in units if not unit.is_header_alone
               for source in (unit.includes or (unit.source,))}
    beside = header.with_suffix(".cpp")
    if beside in sources:
        return by_itself(sources[beside], beside)
    line = re.compile(rf'#include ["<](?:[^">]*/)?{re.escape(header.name)}[">]')
    for source, unit in sorted(sources.items(), key=lambda item: (item[0].parent != header.parent, item[0])):
        if source.exists() and line.search(source.read_text(errors="replace")):
            return by_itself(unit, source)
    return None


MOST_TOGETHER, MOST_BYTES_TOGETHER = 20, 120_000


def together(units: list[Unit], folder: Path) -> list[Unit]:
    """Sources that are compiled alike and define no name twice, as sources that include them, written into `folder`."""
    of = {unit.source: unit for unit in units}
    groups = joined(of, MOST_TOGETHER, MOST_BYTES_TOGETHER, lambda source: of[source].arguments)
    return [of[group[0]] if len(group) == 1 else joint([of[source] for source in group], folder) for group in groups]


def joint(group: list[Unit], folder: Path) -> Unit:
    sources = tuple(unit.source for unit in group)
    text = "".join(f'#include "{source}"\n' for source in sources)
    folder.mkdir(parents=True, exist_ok=True)
    source = folder / f"{hashlib.sha256(text.encode()).hexdigest()[:16]}.cpp"
    source.write_text(text)
    return dataclasses.replace(group[0], source=source, includes=sources)


class Cache:
    def __init__(self, folder: Path, tidy: str):
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        version = subprocess.run([tidy, "--version"], capture_output=True, text=True, check=True).stdout
        self.common = version + (ROOT / ".clang-tidy").read_text()

    def entry(self, unit: Unit) -> Path | None:
        compiler, *arguments = without_precompiled_header(unit.arguments)
        preprocessed = subprocess.run([compiler, *arguments, "-E", "-C", str(unit.source)], cwd=unit.folder,
                                      capture_output=True, check=False)
        if preprocessed.returncode != 0:
            return None
        key = hashlib.sha256(self.common.encode() + "\0".join(unit.arguments).encode() + preprocessed.stdout)
        return self.folder / key.hexdigest()

    def prune(self) -> None:
        for entry in self.folder.iterdir():
            if entry.stat().st_mtime < time.time() - 30 * 86400:
                entry.unlink()


def findings(tidy: str, unit: Unit, cache: Cache | None) -> tuple[str, bool]:
    """What clang-tidy says, and whether that was known. What clashes after all is read one by one."""
    text, known = findings_at_once(tidy, unit, cache)
    if unit.includes and "[clang-diagnostic-error]" in text:
        each = [findings_at_once(tidy, by_itself(unit, source), cache) for source in unit.includes]
        return "".join(text for text, _ in each), all(known for _, known in each)
    return text, known


def findings_at_once(tidy: str, unit: Unit, cache: Cache | None) -> tuple[str, bool]:
    entry = cache.entry(unit) if cache else None
    if entry and entry.exists():
        os.utime(entry)
        return entry.read_text(), True
    result = subprocess.run(
        [tidy, "--quiet", f"--config-file={ROOT}/.clang-tidy", str(unit.source), "--",
         *without_precompiled_header(unit.arguments)[1:]],
        cwd=unit.folder, capture_output=True, text=True, check=False)
    text = result.stdout
    if result.returncode != 0 and not text.strip():
        text = f"{unit.source}: clang-tidy ends with {result.returncode}\n{result.stderr}"
    elif entry:
        partial = entry.with_suffix(f".{os.getpid()}")
        partial.write_text(text)
        partial.rename(entry)
    return text, False


def each_once(texts: list[str]) -> list[str]:
    """One text a finding: of a header it is said by each source that includes it."""
    seen: dict[str, str] = {}
    for text in texts:
        for finding in re.split(r"^(?=\S+:\d+:\d+: (?:warning|error): )", text, flags=re.MULTILINE):
            if finding.strip():
                seen.setdefault(finding.splitlines()[0], finding)
    return list(seen.values())


def main(arguments: list[str]) -> int:
    parser = parser_of(__doc__)
    parser.add_argument("--fresh", action="store_true", help="no result is looked up or kept")
    asked = parser.parse_args(arguments)
    tidy = shutil.which("clang-tidy")
    if not tidy:
        print("clang-tidy is missing: scripts/set-up --tests installs it", file=sys.stderr)
        return 2
    units = read_units(asked.build)
    changed = None if asked.all else changed_files(ROOT, asked.commits)
    if changed is None:
        units = [unit for unit in units if not unit.is_header_alone]
        # Tests are compiled in smaller batches than can be read together.
        small = [unit for unit in units if not unit.includes or unit.includes[0].is_relative_to(ROOT / "tests")]
        lone = [by_itself(unit, source) for unit in small for source in unit.includes or (unit.source,)]
        units = [unit for unit in units if unit not in small] + together(lone, ROOT / "build" / "tidy-together")
    else:
        units = units_of_changes(units, changed)
        sources = [unit for unit in units if not unit.is_header_alone]
        units = [unit for unit in units if unit.is_header_alone] + together(sources, ROOT / "build" / "tidy-together")
    cache = None if asked.fresh else Cache(ROOT / "build" / "tidy-cache", tidy)
    # The longest first, so that none is left for one processor at the end.
    units.sort(key=lambda unit: -sum(path.stat().st_size for path in unit.includes or (unit.source,)))
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        results = list(pool.map(lambda unit: findings(tidy, unit, cache), units))
    found = each_once([text for text, _ in results])
    print("".join(found), end="")
    if cache:
        cache.prune()
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"clang-tidy: {len(found)} findings in {len(units)} units, {sum(known for _, known in results)} of them known from "
          f"before, {usage.ru_utime + usage.ru_stime:.0f} s of processor time")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
