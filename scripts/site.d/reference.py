"""The reference that is made of the code: verbs, laws, C headers, Python."""

import json
import subprocess
import tempfile
from pathlib import Path

import c_header
import manual
import python_package

# Of each header: what it is for, and which page tells of it in prose.
HEADERS = [
    ("kerf", "libkerf/include/kerf/kerf.h", "docs/library.md", "laws in other programs"),
    ("law", "models/include/kerf/law.h", "docs/own-law.md", "a law as a plug-in"),
    ("device", "drivers/include/kerf/device.h", "docs/own-device.md", "a device or force sensor as a plug-in"),
]


def write(root, program, output):
    """All of it below `output`, which is to be the folder reference/ of the pages."""
    output = Path(output)
    (output / "verbs").mkdir(parents=True)
    (output / "c").mkdir()
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "pages"
        subprocess.run([program, "pages", "-o", made], check=True, stdout=subprocess.DEVNULL)
        (made / "man1/kerf-emulate.1").write_text((root / "drivers/emulators/kerf-emulate.1").read_text())
        for name, text in manual.verbs(made / "man1").items():
            (output / name).write_text(text, encoding="utf-8")
    (output / "laws.md").write_text(laws(program), encoding="utf-8")
    for name, header, prose, about in HEADERS:
        text = c_header.page(f"`<kerf/{name}.h>`: {about}", (root / header).read_text(encoding="utf-8"), f"../../{prose}")
        (output / f"c/{name}.md").write_text(text, encoding="utf-8")
    if (root / "python/kerf/__init__.py").exists():
        (output / "python.md").write_text(python_package.page(root / "python/kerf"), encoding="utf-8")


def _asked(program, *words):
    return json.loads(subprocess.run([program, *words, "--json"], check=True, capture_output=True).stdout)


def _cell(value):
    return str(value).replace("|", "\\|").replace("\n", " ")


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += ["| " + " | ".join(_cell(value) for value in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def laws(program):
    """Each law as the program tells of it."""
    out = ["# Every law\n", "As `kerf laws NAME` prints them; sources and limits stand in [the force laws](../docs/laws.md). "
           "Parameters are those over a depth in m; over an angle, N/m is N/rad.\n"]
    for listed in _asked(program, "laws")["laws"]:
        law = _asked(program, "laws", listed["name"])
        out.append(f"## {law['name']}\n\n    {law['equation']}\n")
        if law["axes"]:
            axes = [axis if isinstance(axis, str) else axis["name"] for axis in law["axes"]]
            out.append(f"In space: axes {', '.join(f'`{axis}`' for axis in axes)}.\n")
        if not law["fit"]:
            out.append("`kerf fit` does not fit it.\n")
        out.append(table(["parameter", "unit", "from", "to", "meaning"],
                         [(f"`{p['name']}`", p["unit"], f"{p['lower']:g}", f"{p['upper']:g}", p["meaning"]) for p in law["parameters"]]))
        if law.get("options"):
            out.append(table(["option", "standard", "meaning"],
                             [(f"`{o['name']}`", f"`{json.dumps(o['standard'])}`", o["meaning"]) for o in law["options"]]))
    return "\n".join(out)
