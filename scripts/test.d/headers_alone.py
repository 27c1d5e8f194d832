#!/usr/bin/env python3
"""Compiles headers alone, as the first and only include of a source: those that changed, or all of them.

    scripts/test.d/headers_alone.py [--all | --commits N] BUILD        --commits: those that changed in the last N

A header that includes a changed one counts as changed: it may have lived on what the other included. What has changed is
said in changed_files.py. Only read, no code is made of it. Exit status: 0 if every one compiles, 1 if not, 2 for bad usage.
"""

import concurrent.futures
import os
import re
import subprocess
import sys
from pathlib import Path

from changed_files import changed_files, parser_of
from compile_commands import ROOT, Unit, read_units, without_precompiled_header


def with_users(changed: set[Path], headers: dict[Path, set[str]]) -> set[Path]:
    """The changed headers, and those that include them, themselves or through others. Names, not paths, are compared: at worst
    one header too many is compiled."""
    affected = {header for header in headers if header in changed}
    grew = True
    while grew:
        names = {header.name for header in affected} | {path.name for path in changed if path.suffix == ".h"}
        more = {header for header, included in headers.items() if included & names}
        grew = not more <= affected
        affected |= more
    return affected


def included_names(header: Path) -> set[str]:
    return {Path(name).name for name in re.findall(r'^\s*#include ["<]([^">]+)[">]', header.read_text(), re.MULTILINE)}


def what_is_wrong(unit: Unit) -> str | None:
    """What the compiler says of a header that does not compile; None of one that does."""
    command = [*without_precompiled_header(unit.arguments), "-Werror", "-fsyntax-only", str(unit.source)]
    result = subprocess.run(command, cwd=unit.folder, capture_output=True, text=True, check=False)
    return None if result.returncode == 0 else result.stderr or f"{unit.source}: the compiler ends with {result.returncode}\n"


def main(arguments: list[str]) -> int:
    asked = parser_of(__doc__).parse_args(arguments)
    alone = {unit.includes[0]: unit for unit in read_units(asked.build) if unit.is_header_alone and unit.includes}
    changed = None if asked.all else changed_files(ROOT, asked.commits)
    affected = alone if changed is None else with_users(changed, {header: included_names(header) for header in alone})
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        failures = [text for text in pool.map(what_is_wrong, (alone[header] for header in sorted(affected))) if text is not None]
    print("".join(failures), end="", file=sys.stderr)
    print(f"{len(affected)} of {len(alone)} headers compiled alone" if not failures
          else f"Of {len(affected)} headers {len(failures)} do not compile alone")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
