"""A header of C as a page: what its comments say, each beside the declarations that it stands above."""

import re

import pages

_SECTION = re.compile(r"^/\* ---- (.+) ---- \*/$")
# What a reader of the page does not need.
_GUARDS = re.compile(r"^(?:#(?:if|ifn?def|else|endif|include|define KERF_API|define KERF_\w+_H$)|extern \"C\"|\})")
_FUNCTION = re.compile(r"\b(kerf_\w+)\(")
_NAMES = (re.compile(r"^#define (\w+)"), re.compile(r"^typedef struct (\w+)"), re.compile(r"^typedef [^{]* (\w+);$"))


def page(title, text, prose):
    """`prose`: the page that tells of it, as a link from this one."""
    out = [f"# {title}\n", f"The header says so itself; [here it is told with examples]({prose}).\n"]
    for comment, code in _chunks(text):
        section = _SECTION.match(comment) if not code else None
        if section:
            out.append(f"## {section[1]}\n")
            continue
        if code:
            out.append(f"### {', '.join(f'`{name}`' for name in _declared(code))}\n")
            out.append("```c\n" + re.sub(r"\b(?:KERF_API|KERF_LAW_EXPORT|KERF_DEVICE_EXPORT) ", "", code) + "\n```\n")
        if comment:
            out.append(_words(comment) + "\n")
    return "\n".join(out)


def _chunks(text):
    """Comments that begin a line, each with the code below it, up to a blank line or the next such comment."""
    comment, code, inside, depth = [], [], False, 0
    for line in [*text.splitlines(), ""]:
        if not inside and not depth and (line.startswith("/*") or (not line and (comment or code))):
            if comment or code:
                yield "\n".join(comment), "\n".join(code)
            comment, code = [], []
        if inside or (not depth and line.startswith("/*")):
            comment.append(line)
            inside = not line.rstrip().endswith("*/")
        elif line and (depth or not _GUARDS.match(line)):
            code.append(line)
            depth += line.count("{") - line.count("}")


def _declared(code):
    """What a piece of code declares, in its order."""
    if code.startswith("enum"):
        return re.findall(r"\b(KERF_\w+)\s*=", code)[:1] + ["..."]
    outside = re.sub(r"/\*.*?\*/|\{.*?\}", "", code, flags=re.DOTALL)
    names = [found[1] for line in outside.splitlines() for name in _NAMES if (found := name.match(line.strip()))]
    return list(dict.fromkeys(names + _FUNCTION.findall(re.sub(r"^#.*", "", outside, flags=re.MULTILINE))))


def _words(comment):
    """The prose of a comment. Lines that are set in and begin with a dash are a list."""
    lines = [re.sub(r"^ ?\*? ?", "", line) for line in re.sub(r"^/\*+|\*+/$", "", comment.strip()).splitlines()]
    out = []
    for line in lines:
        parts = re.split(r"(`[^`]+`|(?<![\w/.])(?:kerf|KERF)_\w+\*?(?:\(\))?)", line.strip())
        text = "".join(f"`{part.strip('`')}`" if i % 2 else re.sub(r"([*<>\[\]`])", r"\\\1", part) for i, part in enumerate(parts))
        if line.strip().startswith("- ") and out and out[-1] and not out[-1].startswith("- "):
            out.append("")
        out.append(text)
    return pages.linked("\n".join(out).strip(), "../../")
