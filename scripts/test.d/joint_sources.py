"""Which sources can be compiled as one, since they define no name twice. Most of the time of a compiler goes into what they all
include.

    scripts/test.d/joint_sources.py SOURCE...        a batch's number and a test source, one a line

Names are told from the text, by how the house writes it (what is defined outside of a function begins its line): at worst two
sources that could have been together are apart, or a compiler names what clashes.
"""

import re
import sys
from collections.abc import Callable, Hashable, Iterable
from pathlib import Path

BROUGHT = re.compile(r"^using (?:\w+::)+(\w+);", re.MULTILINE)
DEFINED = re.compile(r"""^(?:(?:inline|static|constexpr|const|\[\[nodiscard\]\]|template\ <[^>]*>)\ +)*
    (?:(?:struct|class|enum(?:\ class)?|using)\ (\w+)\b(?!::)
    |MATCHER(?:_P\d?)?\((\w+)
    |(?!\s|using|namespace|return|TEST|INSTANTIATE)[\w:<>,&*\[\]\ ]+?\b(\w+)(?:\(|\{|\ =|\[|;))""", re.MULTILINE | re.VERBOSE)
SPANS_LINES = re.compile(r"^(\w+)\(", re.MULTILINE)
# What holds from its line on, for all that comes after it.
ALIAS = re.compile(r"^namespace (\w+ = [\w:]+);", re.MULTILINE)
REACHES_ON = re.compile(r"^(?:#\s*(?:define|pragma (?!once))|using namespace (?!std::(?:string_view_)?literals|testing))", re.MULTILINE)


class Names:
    """What one source, or several, define and bring into the scope of the file."""

    def __init__(self, text: str) -> None:
        self.defined = {name for match in DEFINED.findall(text) for name in match if name}
        self.defined |= set(SPANS_LINES.findall(text)) - {"TEST", "TEST_F", "TEST_P", "INSTANTIATE_TEST_SUITE_P"}
        self.brought = set(BROUGHT.findall(text))
        self.aliases = dict(alias.split(" = ") for alias in ALIAS.findall(text))

    def clash_with(self, other: "Names") -> bool:
        return not (self.defined.isdisjoint(other.defined | other.brought | other.aliases.keys())
                    and other.defined.isdisjoint(self.brought | self.aliases.keys())
                    and all(other.aliases.get(name, space) == space for name, space in self.aliases.items()))

    def take(self, other: "Names") -> None:
        self.defined |= other.defined
        self.brought |= other.brought
        self.aliases |= other.aliases


def joined(sources: Iterable[Path], most: int, most_bytes: int,
           kind: Callable[[Path], Hashable] = lambda source: None) -> list[list[Path]]:
    """Groups of at most so many sources and bytes, each of one kind, none of which clashes."""
    groups: list[tuple[Names, list[Path]]] = []
    for source in sorted(sources, key=lambda source: (-source.stat().st_size, source)):
        names = Names(source.read_text())
        for held, group in groups:
            if (len(group) < most and kind(group[0]) == kind(source)
                    and sum(one.stat().st_size for one in [*group, source]) < most_bytes and not held.clash_with(names)):
                held.take(names)
                group.append(source)
                break
        else:
            groups.append((names, [source]))
    return [group for _, group in groups]


MOST_TESTS, MOST_BYTES_OF_TESTS = 14, 120_000


def main(sources: list[str]) -> int:
    plain = [path for path in map(Path, sources) if path.suffix == ".cpp" and not REACHES_ON.search(path.read_text())]
    for number, group in enumerate(joined(plain, MOST_TESTS, MOST_BYTES_OF_TESTS)):
        for source in group:
            print(number, source)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
