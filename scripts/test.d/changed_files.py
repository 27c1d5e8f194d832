"""Which files a run of scripts/test is about: all that differ from where this work began.

That is the last commit shared with the default branch of `origin`; where nothing was done since then, the commit before the
last one. Or so many commits ago as is asked for. What is not yet committed, or not yet known to git, counts too. Without git or
without so much history: every file.
"""

import argparse
import subprocess
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
    names = set((committed + edited + untracked).splitlines())
    return {root / name for name in names if (root / name).is_file()}
