#!/usr/bin/env python3
"""Which files a run of scripts/test is about: all that differ from where this work began.

That is the last commit shared with the default branch of `origin`; where nothing was done since then, the commit before the
last one. Or so many commits ago as is asked for. What is not yet committed, or not yet known to git, counts too. Without git or
without so much history: every file.

    scripts/test.d/changed_files.py [--commits N] PLACE...      whether something below these did

Exit status: 0 if something changed, or nobody knows; 1 if nothing did; 2 for bad usage.
"""

import argparse
import subprocess
import sys
from pathlib import Path


def _git(root: Path, *arguments: str) -> str | None:
    result = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, text=True, check=False)
    return result.stdout if result.returncode == 0 else None


def parser_of(description: str) -> argparse.ArgumentParser:
    """Of a command that looks at what changed in a build, or at everything."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=_build_folder, metavar="BUILD", help="with compile_commands.json, for example build/dev")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--all", action="store_true", help="everything")
    which.add_argument("--commits", type=int, metavar="N", help="what the last N changed")
    return parser


def _build_folder(name: str) -> Path:
    if not (Path(name) / "compile_commands.json").exists():
        raise argparse.ArgumentTypeError(f"{name} has no compile_commands.json")
    return Path(name).resolve()


def changed_files(root: Path, commits: int | None = None) -> set[Path] | None:
    """Paths below `root` that changed, in the last `commits` if they are given, and still exist; None for all of them."""
    changed = _changed(root, commits)
    return None if changed is None else {path for path in changed if path.is_file()}


def has_changed(root: Path, places: list[str], commits: int | None = None) -> bool:
    """Whether something at or below one of the places did, what was deleted too; true where nobody knows."""
    changed = _changed(root, commits)
    return changed is None or any(path.is_relative_to(root / place) for path in changed for place in places)


def _changed(root: Path, commits: int | None) -> set[Path] | None:
    head = _git(root, "rev-parse", "HEAD")
    if head is None:
        return None
    base = _git(root, "rev-parse", "--verify", "--quiet", f"HEAD~{commits}") if commits else None
    if commits and base is None:
        return None
    for branch in ("origin/HEAD", "origin/main"):
        base = base or _git(root, "merge-base", "HEAD", branch)
    untracked = _git(root, "ls-files", "--others", "--exclude-standard") or ""
    edited = _git(root, "diff", "--name-only", "HEAD") or ""
    if base is None or base == head and not commits:
        base = head if edited or untracked else _git(root, "rev-parse", "HEAD~")
    if base is None:
        return None
    committed = _git(root, "diff", "--name-only", base.strip(), "HEAD") or ""
    return {root / name for name in (committed + edited + untracked).splitlines()}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("places", nargs="+", metavar="PLACE", help="a file or folder of the project, as drivers or scripts/test")
    parser.add_argument("--commits", type=int, metavar="N", help="in the last N")
    asked = parser.parse_args()
    root = Path(__file__).resolve().parents[2]
    for place in asked.places:
        if not (root / place).exists():
            parser.error(f"there is no {root / place}")
    return 0 if has_changed(root, asked.places, asked.commits) else 1


if __name__ == "__main__":
    sys.exit(main())
