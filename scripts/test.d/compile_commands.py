"""How a build compiles each source of the house, from its compile_commands.json."""

import json
import re
import shlex
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Unit:
    """What a compiler reads at once: a source, several of them (a unity build), or a header alone."""

    source: Path
    arguments: tuple[str, ...]  # without the source, the output and -Werror
    folder: Path
    includes: tuple[Path, ...]  # what a generated source takes in: the sources of a unity build, the header to be verified

    @property
    def is_header_alone(self) -> bool:
        return "_verify_interface_header_sets" in str(self.source)


def _stripped(words: list[str], source: str) -> tuple[str, ...]:
    arguments = []
    skip = 0
    for word in words:
        if skip:
            skip -= 1
        elif word in ("-o", "-MF", "-MT"):
            skip = 1
        elif word not in ("-c", "-MD", "-Werror", source):
            arguments.append(word)
    return tuple(arguments)


def _included(source: Path, arguments: tuple[str, ...]) -> tuple[Path, ...]:
    folders = [Path(word[2:]) for word in arguments if word.startswith("-I")]
    included = []
    for quoted, angled in re.findall(r'^#include (?:"([^"]+)"|<([^>]+)>)', source.read_text(), re.MULTILINE):
        name = quoted or angled
        candidates = [Path(name)] if Path(name).is_absolute() else [folder / name for folder in folders]
        included += [one.resolve() for one in candidates if one.exists()][:1]
    return tuple(included)


def read_units(build: Path, root: Path = ROOT) -> list[Unit]:
    """Sources of the house only: of what a build generates, unity sources and headers alone."""
    units = []
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = Path(entry["file"])
        words = shlex.split(entry["command"])
        generated = source.is_relative_to(build) or not source.is_relative_to(root)
        arguments = _stripped(words, entry["file"])
        includes: tuple[Path, ...] = ()
        if generated:
            if not ("_verify_interface_header_sets" in str(source) or source.name.startswith("unity_")):
                continue
            includes = _included(source, arguments)
        units.append(Unit(source, arguments, Path(entry["directory"]), includes))
    return units


def without_precompiled_header(arguments: tuple[str, ...]) -> list[str]:
    """Its text is included instead: it may not be built, and what it holds must count in the hash."""
    words = list(arguments)
    while "-include-pch" in words:
        at = words.index("-include-pch")
        del words[at - 1:at + 3]  # -Xclang -include-pch -Xclang FILE
    return words
