#!/usr/bin/env python3
"""What scripts/mutate draws, and what it leaves alone."""

import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts/mutate.d"))

from mutants import mutants_of  # noqa: E402
from rooms import ROOMS, room_of  # noqa: E402


def changed(text: str) -> set[str]:
    """What becomes of the lines of a source, each mutant for itself."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "x.cpp").write_text(text)
        lines = text.split("\n")
        return {mutant.changed(lines[mutant.line - 1]).strip() for mutant in mutants_of(Path(folder), "x.cpp")}


class Mutants(unittest.TestCase):
    def test_change_one_operator(self):
        self.assertEqual(changed("  x = a + b;"), {"x = a - b;", ";"})
        self.assertEqual(changed("  if (a < b) go();"), {"if (a <= b) go();", "if (a >= b) go();", "if (!(a < b)) go();"})
        self.assertEqual(changed("  const T x = std::min(a, -b);"), {"const T x = std::max(a, -b);", "const T x = std::min(a, b);"})
        self.assertEqual(changed("  return a == b;"), {"return a != b;", "return {};"})
        self.assertEqual(changed("  return true;"), {"return false;"})

    def test_take_a_statement_away(self):
        self.assertIn(";", changed("  device.write(force);"))
        self.assertNotIn(";", changed("  int count = first;"))
        self.assertNotIn(";", changed("  std::sort(a, [](int x) {"))

    def test_leave_alone_what_no_test_could_tell(self):
        for text in ("// a + b", "/* a\n + b\n*/", "#define A a + b", "#include <a/b.h>",
                     "static_assert(a + 1 < b);", "template <int n = 1>", "std::vector<int> a;", "T&& a;", "const T* a;",
                     "bool operator<(T a);", "using A = B<C>;"):  # fmt: skip
            self.assertEqual(changed(text), set(), text)
        self.assertEqual(changed('  fail("a + b", 1);'), {'fail("a + b", 0);', ";"})

    def test_are_of_rooms_that_are_there(self):
        for room in ROOMS:
            for path in (room.folder, *room.without):
                self.assertTrue((ROOT / path).exists(), path)
        self.assertEqual(room_of("fitting/psychophysics/src/dprime.cpp").folder, "fitting/psychophysics")
        self.assertIsNone(room_of("drivers/src/usb/guard.cpp"))
        self.assertIsNone(room_of("bench/studio/server/studio.cpp"))


class Equivalents(unittest.TestCase):
    def test_are_mutants_of_today_and_say_why(self):
        for entry in tomllib.loads((ROOT / "scripts/mutate.d/equivalent.toml").read_text()).get("mutant", []):
            lines = (ROOT / entry["file"]).read_text().split("\n")
            drawn = {(lines[mutant.line - 1].strip(), mutant.changed(lines[mutant.line - 1]).strip())
                     for mutant in mutants_of(ROOT, entry["file"])}
            self.assertIn((entry["line"], entry["becomes"]), drawn, "no such mutant any more: take the entry away")
            self.assertTrue(entry["why"])


if __name__ == "__main__":
    unittest.main()
