#!/usr/bin/env python3
"""Compiles headers alone, as the first and only include of a source: those that changed, or all of them.

    scripts/test.d/headers_alone.py [--all] BUILD

A header that includes a changed one counts as changed: it may have lived on what the other included. What has changed is
said in changed_files.py. Exit status: that of the build; 2 for bad usage.
"""

import re
import subprocess
import sys
from pathlib import Path

from changed_files import changed_files
from compile_commands import ROOT, read_units


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


def main(arguments: list[str]) -> int:
    everything = "--all" in arguments
    folders = [word for word in arguments if word != "--all"]
    if len(folders) != 1 or not (Path(folders[0]) / "compile_commands.json").exists():
        print("usage: scripts/test.d/headers_alone.py [--all] BUILD, a folder with compile_commands.json", file=sys.stderr)
        return 2
    build = Path(folders[0]).resolve()
    alone = {unit.includes[0]: unit.output for unit in read_units(build) if unit.is_header_alone and unit.includes}
    changed = None if everything else changed_files(ROOT)
    if changed is None:
        count, targets = len(alone), ["all_verify_interface_header_sets"]
    else:
        affected = with_users(changed, {header: included_names(header) for header in alone})
        count, targets = len(affected), sorted(alone[header] for header in affected)
    status = 0
    if targets:
        status = subprocess.run(["cmake", "--build", str(build), "--target", *targets], check=False).returncode
    print(f"{count} of {len(alone)} headers compiled alone" if status == 0 else "Not every header compiles alone")
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
