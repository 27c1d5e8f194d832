"""What is drawn: places in C++ where one operator of one line is another, a statement is gone, or a value is another.

The sources are laid out by clang-format, so an operator with a blank on either side is a binary one, and a bracket of a template
has none. What no test could tell (comments, the text of messages, includes, static_assert, a template's head) is left alone.
"""

import re
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path


@dataclass(frozen=True, order=True)
class Mutant:
    file: str  # below the root
    line: int  # from 1
    begin: int  # in the line, from 0
    end: int
    new: str
    source: str = field(compare=False)  # the line
    nth: int = field(default=0, compare=False)  # of those in this file that make the same of the same text, from 0

    @property
    def text(self) -> str:
        return self.source.strip()

    @property
    def becomes(self) -> str:
        return self.changed().strip()

    @property
    def identity(self) -> tuple[str, str, str, int]:
        """What stays while other lines of the file change."""
        return self.file, self.text, self.becomes, self.nth

    def changed(self) -> str:
        return self.source[: self.begin] + self.new + self.source[self.end :]

    def applied_to(self, text: str) -> str:
        lines = text.split("\n")
        lines[self.line - 1] = self.changed()
        return "\n".join(lines)


# A pattern whose group 1 is replaced, and by what.
SWAPS = [(rf"\s({re.escape(old)})\s", new) for old, news in {
    "+": "-", "-": "+", "*": "/", "/": "*", "%": "*",
    "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=",
    "<": "<= >=", "<=": "< >", ">": ">= <=", ">=": "> <",
    "==": "!=", "!=": "==", "&&": "||", "||": "&&",
}.items() for new in news.split()] + [
    (r"\bstd::(min)\b", "max"), (r"\bstd::(max)\b", "min"),
    (r"(\+\+)(?=[A-Za-z_])", "--"), (r"(--)(?=[A-Za-z_])", "++"),
    (r"(?<![\w.'])(0)(?![\w.'])", "1"), (r"(?<![\w.'])(1)(?![\w.'])", "0"),
    (r"(?<![\w.'])(0\.0)(?![\w'])", "1.0"), (r"(?<![\w.'])(1\.0)(?![\w'])", "0.0"),
    (r"(?:[(,{=?:]|\breturn)\s?(-)(?=[\w(])", ""),
    (r"\b(true)\b", "false"), (r"\b(false)\b", "true"),
    (r"^\s*(?:\} else )?(?:if|while) \((!)(?=[\w(][\w.()>:-]*\))", ""),
]  # fmt: skip

CONDITION = re.compile(r"^\s*(?:\} else )?(?:if|while) (\()")
RETURNED = re.compile(r"^\s*(?:if \(.*\) )?return ([^;{]+);$")
ASSIGNMENT = re.compile(r"^\s*([\w.\[\]>()-]+ (?:[-+*/|&]?=) .*;)$")
CALL = re.compile(r"^\s*((?!return\b|throw\b|using\b|if\b|for\b|while\b)[\w.:>-]+\(.*\);)$")


def masked(text: str) -> str:
    """The text with blanks in place of comments, literals, and what the preprocessor and the compiler alone see."""
    hidden = (r'R"(\w*)\(.*?\)\1"|//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\''
              r"|^[ \t]*#(?:\\\n|[^\n])*|\bstatic_assert\(.*?\);|^[ \t]*template <[^\n]*|\boperator[^\s(\w]+")
    return re.sub(hidden, lambda found: re.sub(r"[^\n]", "_", found[0]), text, flags=re.S | re.M)


def closed(text: str) -> bool:
    depth = 0
    for letter in text:
        depth += (letter in "([{") - (letter in ")]}")
        if depth < 0:
            return False
    return depth == 0


def behind_bracket(line: str, begin: int) -> int | None:
    """Where the bracket that opens at `begin` has been closed; none if not in this line."""
    for end in range(begin + 1, len(line) + 1):
        if line[end - 1] in ")]}" and closed(line[begin:end]):
            return end
    return None


def changes_of(line: str):
    """(begin, end, new) of each mutant of a masked line."""
    for pattern, new in SWAPS:
        for found in re.finditer(pattern, line):
            yield found.start(1), found.end(1), new
    if found := CONDITION.match(line):
        begin = found.start(1)
        end = behind_bracket(line, begin)
        if end is not None and ";" not in line[begin:end] and "=" not in re.sub(r"[=!<>]=", "", line[begin:end]):
            yield begin, begin + 1, "(!("  # closed by the caller, who knows the line
    if (found := RETURNED.match(line)) and found[1] not in ("true", "false", "0", "0.0") and closed(found[1]):
        yield found.start(1), found.end(1), "{}"
    if (found := ASSIGNMENT.match(line) or CALL.match(line)) and closed(found[1]):
        yield found.start(1), found.end(1), ";"


def mutants_of(root: Path, file: str) -> list[Mutant]:
    shown = (root / file).read_text().split("\n")
    found = set()
    for number, line in enumerate(masked("\n".join(shown)).split("\n"), 1):
        source = shown[number - 1]
        for begin, end, new in changes_of(line):
            if new == "(!(":
                behind = behind_bracket(line, begin)
                new, end = f"(!{source[begin:behind]})", behind
            found.add(Mutant(file, number, begin, end, new, source))
    alike = Counter()
    numbered = []
    for mutant in sorted(found):
        key = (mutant.text, mutant.becomes)
        numbered.append(replace(mutant, nth=alike[key]))
        alike[key] += 1
    return numbered
