"""Pages of the manual, of the few requests of troff that Kerf's have (bench/cli/pages/man_page.cpp), as Markdown."""

import re
from pathlib import Path

import pages

_LETTERS = {r"\-": "-", r"\(aq": "'", r"\(ga": "`", r"\(ha": "^", r"\(ti": "~", r"\e": "\\", r"\&": ""}
# The same on every page, and told in one place.
_SHARED = {"NAME", "EXIT STATUS", "FILES", "SEE ALSO"}


def plain(text):
    """Without any font."""
    text = re.sub(r"\\f[BIR]", "", text)
    return re.sub(r"\\(?:\(\w\w|[-e&])", lambda found: _LETTERS[found[0]], text)


def prose(text):
    """Words, with what Markdown would take for its own kept from it and documents as links."""
    return pages.linked(re.sub(r"([*_<>`|\[\]])", r"\\\1", plain(text)), "../../")


def _code(text):
    return f"`{plain(text)}`".replace("|", "\\|")


def _head(text):
    """Of an entry: names as code, and what they take."""
    bold = [_code(name) for name in re.findall(r"\\fB(.*?)\\fR", text)]
    rest = [_code(name) if not bold and i == 0 else prose(name) for i, name in enumerate(re.findall(r"\\fI(.*?)\\fR", text))]
    return ", ".join(bold) + (" " if bold and rest else "") + " ".join(rest)


def _entries(lines):
    """Those of a list: head and text of each."""
    parts = ([line for line in part.split("\n") if line] for part in "\n".join(lines).split(".TP\n"))
    return [(part[0], " ".join(part[1:])) for part in parts if part]


def _paragraphs(lines):
    out, code, words = [], None, []
    for line in [*lines, ".PP"]:
        if line in {".PP", ".nf", ".fi"}:
            if words:
                out.append(re.sub(r"(?<=\w-)\n", "", "\n".join(words)) if code is None else "```text\n" + "\n".join(words) + "\n```")
            words, code = [], True if line == ".nf" else None
        else:
            words.append(prose(line) if code is None else plain(line))
    return "\n\n".join(out) + "\n"


def sections(text):
    """Head and lines of each section."""
    found = {}
    for line in text.splitlines():
        if line.startswith(".SH "):
            found[line[4:]] = lines = []
        elif not line.startswith(".TH"):
            lines.append(line)
    return found


def _page(parts, level, title):
    """One verb, from its sections."""
    hashes = "#" * level
    summary = plain(" ".join(parts["NAME"])).partition(" - ")[2]
    out = [f"{hashes} {title}\n", prose(summary) + ".\n", "    " + plain(" ".join(parts["SYNOPSIS"])) + "\n"]
    for name, lines in parts.items():
        if name in _SHARED or name in {"SYNOPSIS", "VERBS"}:
            continue
        if name == "OPTIONS":
            rows = [f"| {_head(head)} | {prose(text)} |" for head, text in _entries(lines)]
            out.append("| option | what it does |\n|---|---|\n" + "\n".join(rows) + "\n")
        elif name == "EXAMPLES":
            out.append("```sh\n" + "\n".join(plain(line) for line in lines if not line.startswith(".")) + "\n```\n")
        else:
            out.append(_paragraphs(lines))
    return "\n".join(out)


def verbs(folder):
    """Names and texts of pages: verbs.md, which lists all, and a page for each verb with those that it has itself."""
    manual = {path.stem: sections(path.read_text(encoding="utf-8")) for path in Path(folder).glob("*.1")}
    out = {"verbs.md": _list_of_verbs(manual["kerf"])}
    for page in sorted(manual):
        words = page.split("-")
        if page == "kerf" or len(words) > 2:
            continue
        title = "kerf-emulate" if page == "kerf-emulate" else " ".join(words)
        text = [_page(manual[page], 1, title)]
        text += [_page(manual[own], 2, own.replace("-", " ")) for own in sorted(manual) if own.startswith(page + "-")]
        text.append("Exit statuses, and what goes to which stream: [the command line](../../docs/command-line.md#exit-status).\n")
        out[f"verbs/{words[1]}.md"] = "\n".join(text)
    return out


def _list_of_verbs(parts):
    out = ["# Every verb\n", "As `kerf --help` lists them, by what one wants to do; each page is `kerf VERB --help`, word by word.\n"]
    for group in "\n".join(parts["VERBS"]).split(".SS ")[1:]:
        name, _, lines = group.partition("\n")
        rows = [f"| [{_code(head)}](verbs/{plain(head).split()[1]}.md) | {prose(text)} |" for head, text in _entries(lines.split("\n"))]
        out.append(f"## {plain(name)}\n\n| verb | does |\n|---|---|\n" + "\n".join(rows) + "\n")
    out.append("Beside `kerf` there is [`kerf-emulate`](verbs/emulate.md), which plays devices.\n")
    return "\n".join(out)
