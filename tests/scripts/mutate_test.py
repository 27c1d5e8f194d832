#!/usr/bin/env python3
"""What scripts/mutate draws, and what it leaves alone."""

import contextlib
import io
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts/mutate.d"))

from drawn import in_order  # noqa: E402
from mutants import mutants_of  # noqa: E402
from results import EQUIVALENT, KILLED, LIVES, Results  # noqa: E402
from rooms import ROOMS, Room, room_of  # noqa: E402
from scratch import Scratch  # noqa: E402


def changed(text: str) -> set[str]:
    """What becomes of the lines of a source, each mutant for itself."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "x.cpp").write_text(text)
        return {mutant.becomes for mutant in mutants_of(Path(folder), "x.cpp")}


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


def mutants_in(text: str, file: str) -> list:
    """Of a source that has this text, as if it stood there."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / file).parent.mkdir(parents=True)
        (Path(folder) / file).write_text(text)
        return mutants_of(Path(folder), file)


class Draws(unittest.TestCase):
    def test_give_each_room_its_share_however_many_are_drawn(self):
        drivers = mutants_in("  x = a + b;\n" * 10, "drivers/src/x.cpp")
        models = mutants_in("  x = a + b;\n" * 30, "models/src/x.cpp")
        ordered = in_order(drivers + models, seed=1)
        self.assertEqual(set(ordered), set(drivers + models))
        for count in (4, 8, 20, 40):
            self.assertEqual(sum(mutant.file.startswith("drivers/") for mutant in ordered[:count]), count // 4)

    def test_hold_while_other_lines_change(self):
        lines = [f"  x = a + {name};" for name in "bcdefg"]
        before = in_order(mutants_in("\n".join(lines), "models/src/x.cpp"), seed=1)
        after = in_order(mutants_in("\n".join(["int x = 0;", *lines]), "models/src/x.cpp"), seed=1)
        old = {mutant.identity for mutant in before}
        self.assertEqual([mutant.identity for mutant in before],
                         [mutant.identity for mutant in after if mutant.identity in old])
        self.assertNotEqual(before, in_order(before, seed=2))


class Kept(unittest.TestCase):
    def test_results_outlive_the_run_and_those_that_lived_can_be_forgotten(self):
        first, second, third = mutants_in("  x = a + b;\n  y = a + b;", "models/src/x.cpp")[:3]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "results.jsonl"
            results = Results(path, set())
            results.add(first, LIVES)
            results.add(second, LIVES)
            results.add(second, KILLED)
            known = Results(path, {(third.file, third.text, third.becomes, None)})
            self.assertEqual([known.of(mutant) for mutant in (first, second, third)], [LIVES, KILLED, EQUIVALENT])
            known.forget(LIVES)
            self.assertIsNone(known.of(first))

    def test_tell_a_line_that_stands_twice_apart_where_they_are_asked_to(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "a.cpp").write_text("  return a + b;\n  return a + b;\n")
            both = [mutant for mutant in mutants_of(Path(folder), "a.cpp") if mutant.new == "-"]
            known = Results(Path(folder) / "results.jsonl", {("a.cpp", "return a + b;", "return a - b;", 1)})
            self.assertEqual([known.of(mutant) for mutant in both], [None, EQUIVALENT])


class Bases(unittest.TestCase):
    def test_name_the_tests_that_fail_without_a_mutant(self):
        with tempfile.TemporaryDirectory() as folder:
            scratch = Scratch(Path(folder), jobs=1)
            program = scratch.build / "bin/some_test"
            program.parent.mkdir(parents=True)
            program.write_text("#!/bin/sh\n"
                               "case $1 in\n"
                               "  --gtest_list_tests) printf 'main() from x\\nA.\\n  Holds\\n  Fails\\nB.\\n  Fails\\n' ;;\n"
                               "  *Fails) exit 1 ;;\n"
                               "esac\n")
            program.chmod(0o755)
            for _ in ("learned", "known"):
                with contextlib.redirect_stdout(io.StringIO()) as said:
                    scratch.take_bases(Room("models", ("some_test",)))
                self.assertEqual(said.getvalue(), "some_test: left out, since they fail without any mutant: A.Fails, B.Fails\n")
                self.assertEqual(list(scratch.bases["some_test"]), ["A.Holds"])


class Equivalents(unittest.TestCase):
    def test_are_mutants_of_today_and_say_why(self):
        for entry in tomllib.loads((ROOT / "scripts/mutate.d/equivalent.toml").read_text()).get("mutant", []):
            alike = [mutant for mutant in mutants_of(ROOT, entry["file"])
                     if (mutant.text, mutant.becomes) == (entry["line"], entry["becomes"])]  # fmt: skip
            self.assertLess(entry.get("nth", 0), len(alike), "no such mutant any more: take the entry away")
            self.assertTrue(entry["why"])


if __name__ == "__main__":
    unittest.main()
