"""The documents as mkdocs takes them: all in one folder, where each stands as it does in the tree, so that its links hold."""

import os
import re
import shutil
from pathlib import Path

# What was made or fetched, at the root.
_NOT_OF_THE_PROJECT = {"build", "data", "kerf-demo"}
# Of a link or a picture, [text](target#place).
LINK = re.compile(r"(?<=\]\()(?P<target>[^)\s#]*)(?P<place>#[^)\s]*)?(?=(?: \"[^\"]*\")?\))")
_PICTURES = {".png", ".svg"}


def documents(root):
    """Of the tree: the readmes of all folders, what changed, and docs/; relative to it."""
    found = []
    for folder, folders, files in os.walk(root):
        here = Path(folder).relative_to(root)
        passed_by = {"node_modules"} if here.parts else _NOT_OF_THE_PROJECT
        folders[:] = [name for name in folders if not name.startswith(".") and name not in passed_by]
        found += [here / name for name in files if name.endswith(".md") and (name in {"README.md", "CHANGELOG.md"} or here.parts[:1] == ("docs",))]
    return sorted(found)


def copy(root, output, told):
    """Writes them below `output`, with the pictures that they show and the sources that they point to; of sources that `told` has, the
    page that it names is meant."""
    for page in documents(root):
        text = (root / page).read_text(encoding="utf-8")
        (output / page).parent.mkdir(parents=True, exist_ok=True)
        (output / page).write_text(LINK.sub(lambda link, page=page: _led(root, output, told, page, link), text), encoding="utf-8")


def linked(text, up):
    """The documents that a text names as docs/NAME.md, as links from a page; `up` leads from there to the root."""
    return re.sub(r"\bdocs/[a-z-]+\.md", lambda found: f"[{found[0]}]({up}{found[0]})", text)


def _led(root, output, told, page, link):
    """Where a link leads on the site. What leads nowhere is left as it is: mkdocs complains of it."""
    target, place = link["target"], link["place"] or ""
    if not target or re.match(r"[a-z]+:", target):
        return link[0]
    there = Path(os.path.normpath(page.parent / target))
    if str(there) in told:
        return os.path.relpath(told[str(there)], page.parent)
    if (root / there).is_dir():
        if (root / there / "README.md").exists():
            return f"{target.rstrip('/')}/README.md{place}"
        return _taken(root, output, page, there, listing=True)
    if there.suffix == ".md" or not (root / there).is_file():
        return link[0]
    return _taken(root, output, page, there)


def _taken(root, output, page, there, listing=False):
    """Takes a file of the tree along; a source as text, which browsers show."""
    name = there if there.suffix in _PICTURES else Path("sources") / f"{there}.txt"
    (output / name).parent.mkdir(parents=True, exist_ok=True)
    if listing:
        names = sorted(one.name + "/" * one.is_dir() for one in (root / there).iterdir())
        (output / name).write_text("".join(f"{there}/{one}\n" for one in names), encoding="utf-8")
    else:
        shutil.copyfile(root / there, output / name)
    return os.path.relpath(name, page.parent)


def navigation(entries, source):
    """That of mkdocs.yml, with the pages of a folder where it names one, "reference/verbs/", and without what is not made: the
    reference of a part that was not built."""
    out = []
    for entry in entries:
        title, value = next(iter(entry.items())) if isinstance(entry, dict) else (None, entry)
        if isinstance(value, list):
            out.append({title: navigation(value, source)})
        elif value.endswith("/"):
            out.append({title: [str(page.relative_to(source)) for page in sorted((source / value).glob("*.md"))]})
        elif not value.startswith("reference/") or (source / value).exists():
            out.append(entry)
    return out


def unnamed(entries, source):
    """Pages that no entry leads to."""
    def named(entries):
        for entry in entries:
            value = next(iter(entry.values())) if isinstance(entry, dict) else entry
            yield from named(value) if isinstance(value, list) else [value]
    return sorted({str(page.relative_to(source)) for page in source.rglob("*.md")} - set(named(entries)))
