"""Whether what stands under a final name is whole: it parses, and holds what an undisturbed run wrote."""

import csv
import io
import json
import subprocess
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import numpy


def numbers_of(file: Path) -> dict[str, numpy.ndarray]:
    found = {}
    with h5py.File(file, "r") as opened:
        opened.visititems(lambda name, item: found.__setitem__(name, item[()]) if isinstance(item, h5py.Dataset) else None)
    return found


def differs(file: Path, reference: Path) -> str:
    """Which numbers of two recordings are not the same."""
    ours, theirs = numbers_of(file), numbers_of(reference)
    if ours.keys() != theirs.keys():
        return f"holds {sorted(ours.keys() ^ theirs.keys())}, and the other does not"
    for name, values in ours.items():
        other = theirs[name]
        if values.shape != other.shape:
            return f"{name} has the shape {values.shape}, not {other.shape}"
        if values.dtype.kind == "f" and not numpy.array_equal(values, other, equal_nan=True):
            return f"{name} has other numbers"
    return ""


def parsed(file: Path, text: str, reference: str) -> str:
    """What is wrong with a text file; nothing if it parses to the end."""
    try:
        if file.suffix == ".json":
            if isinstance(whole := json.loads(text), dict) and whole.keys() != json.loads(reference).keys():
                return "has other keys"
        elif file.suffix == ".toml":
            if tomllib.loads(text).keys() != tomllib.loads(reference).keys():
                return "has other keys"
        elif file.suffix in (".svg", ".xml"):
            ElementTree.fromstring(text)
        elif file.suffix == ".csv":
            rows = [len(row) for row in csv.reader(io.StringIO(text))]
            if rows != [len(row) for row in csv.reader(io.StringIO(reference))] or not text.endswith("\n"):
                return "has other rows"
        elif file.suffix == ".html":
            if not text.rstrip().endswith("</html>"):
                return "ends early"
        elif text.count("\n") != reference.count("\n"):
            return "has another number of lines"
    except (ValueError, ElementTree.ParseError) as problem:
        return f"does not parse: {problem}"
    return ""


def wrong_with_file(kerf: Path, file: Path, references: list[Path], deterministic: bool = True) -> str:
    """Nothing if the file is as whole as one of the references."""
    if file.suffix in (".h5", ".partial"):
        valid = subprocess.run([kerf, "validate", file], capture_output=True, text=True, check=False)
        if valid.returncode != 0:
            return f"is not valid: {valid.stderr.strip()[:300]}"
        complaints = [differs(file, one) for one in references] if deterministic else [""]
    elif any(file.read_bytes() == one.read_bytes() for one in references):
        return ""
    elif file.suffix == ".key":  # random bytes
        return "" if file.stat().st_size == references[0].stat().st_size else "has another length"
    else:
        text = file.read_text(errors="replace")
        complaints = [parsed(file, text, one.read_text(errors="replace")) for one in references]
    return "" if "" in complaints else complaints[0]


def names_in(folder: Path) -> set[str]:
    """Of all files in it, from there."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def wrong_with(kerf: Path, output: Path, references: list[Path], deterministic: bool = True) -> str:
    """The first thing that is wrong with a file or a folder under a final name; nothing if it is not there or whole.

    A folder may hold all files of one reference, or of all: results of other verbs stay.
    """
    if not output.exists():
        return ""
    references = [one for one in references if one.exists()]
    if output.is_file():
        wrong = wrong_with_file(kerf, output, references, deterministic)
        return f"{output.name} {wrong}" if wrong else ""
    names = names_in(output)
    for name in sorted(names):
        alike = [one / name for one in references if (one / name).is_file()]
        if not alike:
            return f"{output.name}/{name} is a leftover"
        if wrong := wrong_with_file(kerf, output / name, alike, deterministic):
            return f"{output.name}/{name} {wrong}"
    whole = [names_in(one) for one in references]
    if names not in (*whole, set().union(*whole)):
        return f"{output.name} is filled in part: {sorted(min(whole, key=len) - names)} is missing"
    return ""
