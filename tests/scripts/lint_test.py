"""What scripts/test.d/tidy.py and headers_alone.py look at, and what they keep."""

import contextlib
import io
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "test.d"))

import headers_alone  # noqa: E402
import tidy  # noqa: E402
from changed_files import changed_files, has_changed  # noqa: E402
from compile_commands import read_units  # noqa: E402


class Repository:
    def __init__(self, folder):
        self.folder = folder
        self.git("init", "--quiet", "--initial-branch=main")
        self.commit("a.cpp", "b.cpp")

    def git(self, *arguments):
        environment = {**os.environ, "GIT_CONFIG_GLOBAL": "/dev/null", "GIT_CONFIG_SYSTEM": "/dev/null"}
        subprocess.run(["git", "-C", self.folder, "-c", "user.name=n", "-c", "user.email=e", *arguments], check=True,
                       capture_output=True, env=environment)

    def write(self, *names):
        for name in names:
            with open(self.folder / name, "a", encoding="utf-8") as file:
                file.write("int a;\n")

    def commit(self, *names):
        self.write(*names)
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", "so")

    def changed(self, commits=None):
        files = changed_files(self.folder, commits)
        return files and sorted(path.name for path in files)


class WhatChanged(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.repository = Repository(self.folder)

    def branch_off(self):
        self.repository.git("update-ref", "refs/remotes/origin/main", "HEAD")

    def test_is_everything_in_the_first_commit(self):
        self.assertIsNone(self.repository.changed())

    def test_is_everything_without_git(self):
        with tempfile.TemporaryDirectory() as elsewhere:
            self.assertIsNone(changed_files(Path(elsewhere)))

    def test_is_the_last_commit_where_nothing_was_done_since(self):
        self.repository.commit("b.cpp")
        self.branch_off()
        self.assertEqual(self.repository.changed(), ["b.cpp"])

    def test_counts_a_place_of_which_something_changed_or_was_deleted(self):
        self.branch_off()
        (self.folder / "within").mkdir()
        self.repository.commit("within/c.cpp")
        self.assertTrue(has_changed(self.folder, ["a.cpp", "within"]))
        self.assertFalse(has_changed(self.folder, ["a.cpp", "with"]))
        self.repository.git("rm", "--quiet", "b.cpp")
        self.repository.git("commit", "--quiet", "--message", "so")
        self.assertTrue(has_changed(self.folder, ["b.cpp"], 1))
        self.assertFalse(has_changed(self.folder, ["within"], 1))

    def test_has_changed_everywhere_where_nobody_knows(self):
        self.assertTrue(has_changed(self.folder, ["a.cpp"], 7))

    def test_is_what_was_done_since_the_branch_began(self):
        self.branch_off()
        self.repository.commit("b.cpp")
        self.repository.commit("c.cpp")
        self.repository.write("d.cpp")
        self.assertEqual(self.repository.changed(), ["b.cpp", "c.cpp", "d.cpp"])

    def test_is_what_the_last_commits_changed_where_that_is_asked(self):
        for name in ("c.cpp", "d.cpp", "e.cpp"):
            self.repository.commit(name)
        self.branch_off()
        self.assertEqual(self.repository.changed(commits=2), ["d.cpp", "e.cpp"])
        self.assertIsNone(self.repository.changed(commits=4))

    def test_is_what_is_not_committed_where_nothing_was_committed(self):
        self.repository.commit("b.cpp")
        self.branch_off()
        self.repository.write("a.cpp")
        self.assertEqual(self.repository.changed(), ["a.cpp"])

    def test_leaves_out_what_is_gone(self):
        self.branch_off()
        (self.folder / "a.cpp").unlink()
        self.repository.commit("b.cpp")
        self.assertEqual(self.repository.changed(), ["b.cpp"])


class House(unittest.TestCase):
    """A small house: a unity build of two sources, one source by itself, a header that is verified and one that is not."""

    tidy_config = "Checks: '-*,bugprone-integer-division'\nWarningsAsErrors: '*'\nHeaderFilterRegex: '/house/'\n"

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name).resolve() / "house"
        self.build = self.root / "build" / "dev"
        self.write(".clang-tidy", self.tidy_config)
        self.write("include/law.h", "#pragma once\ninline double half(int n) { return n / 2; }\n")
        self.write("src/private.h", "#pragma once\n")
        self.write("src/a.cpp", '#include <law.h>\n#include "private.h"\nint a() { return 1; }\n')
        self.write("src/b.cpp", "#include <law.h>\nint b() { return 2; }\n")
        self.write("src/c.cpp", "int c() { return 3; }\n")
        self.write("build/dev/unity_0_cxx.cxx", f'#include "{self.root}/src/a.cpp"\n#include "{self.root}/src/b.cpp"\n')
        self.write("build/dev/x_verify_interface_header_sets/law.h.cxx", "#include <law.h> // alone\n")
        self.write("build/dev/cmake_pch.hxx.cxx", "")
        entries = [self.entry(name) for name in ("build/dev/unity_0_cxx.cxx", "src/c.cpp", "build/dev/cmake_pch.hxx.cxx",
                                                 "build/dev/x_verify_interface_header_sets/law.h.cxx")]
        self.write("build/dev/compile_commands.json", json.dumps(entries))
        self.units = read_units(self.build, self.root)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def entry(self, name):
        return {"directory": str(self.build), "file": str(self.root / name),
                "command": f"clang++ -I{self.root}/include -Xclang -include-pch -Xclang none.pch -Werror -o {name}.o -c {self.root / name}"}

    def read_for(self, *names):
        chosen = tidy.units_of_changes(self.units, {self.root / name for name in names})
        return [unit.source.name for unit in chosen]

    def test_knows_what_a_build_reads(self):
        self.assertEqual([(unit.source.name, [path.name for path in unit.includes]) for unit in self.units],
                         [("unity_0_cxx.cxx", ["a.cpp", "b.cpp"]), ("c.cpp", []), ("law.h.cxx", ["law.h"])])

    def test_reads_a_changed_source_by_itself(self):
        self.assertEqual(self.read_for("src/b.cpp", "src/c.cpp"), ["b.cpp", "c.cpp"])

    def test_reads_a_changed_header_alone(self):
        self.assertEqual(self.read_for("include/law.h"), ["law.h.cxx"])

    def test_reads_a_changed_header_in_a_changed_source_that_includes_it(self):
        self.assertEqual(self.read_for("include/law.h", "src/a.cpp"), ["a.cpp"])
        self.assertEqual(self.read_for("include/law.h", "src/c.cpp"), ["c.cpp", "law.h.cxx"])

    def test_reads_a_private_header_in_a_source_that_includes_it(self):
        self.assertEqual(self.read_for("src/private.h"), ["a.cpp"])
        self.assertEqual(self.read_for("src/private.h", "src/a.cpp"), ["a.cpp"])

    def test_does_not_read_what_is_no_source(self):
        self.assertEqual(self.read_for(".clang-tidy"), [])

    def run_tidy(self, *arguments):
        with mock.patch.object(tidy, "ROOT", self.root), mock.patch("tidy.read_units", lambda build: read_units(build, self.root)), \
                mock.patch("builtins.print") as said:
            status = tidy.main([*arguments, str(self.build)])
        return status, "".join(str(call.args[0]) for call in said.call_args_list)

    def test_finds_what_a_header_holds_once_and_keeps_the_result(self):
        status, said = self.run_tidy("--all")
        self.assertEqual(status, 1)
        self.assertIn("[bugprone-integer-division", said)
        self.assertIn("1 findings in 2 units, 0 of them known", said)
        self.assertIn("1 findings in 2 units, 2 of them known", self.run_tidy("--all")[1])
        self.write("include/law.h", "#pragma once\ninline double half(int n) { return n / 2; }  // NOLINT\n")
        status, said = self.run_tidy("--all")
        self.assertEqual(status, 0, said)
        self.assertIn("0 findings in 2 units, 1 of them known", said)

    def test_keeps_nothing_where_it_is_to_look_afresh(self):
        for _ in range(2):
            self.assertIn("1 findings in 2 units, 0 of them known", self.run_tidy("--all", "--fresh")[1])
        self.assertFalse((self.root / "build" / "tidy-cache").exists())

    def test_says_which_header_lives_on_what_others_include(self):
        def compile_headers():
            with mock.patch("headers_alone.read_units", lambda build: read_units(build, self.root)), \
                    contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
                return headers_alone.main(["--all", str(self.build)]), out.getvalue(), err.getvalue()

        self.assertEqual(compile_headers(), (0, "1 of 1 headers compiled alone\n", ""))
        self.write("include/law.h", "#pragma once\ninline std::size_t half(std::size_t n) { return n / 2; }\n")
        status, out, err = compile_headers()
        self.assertEqual((status, out), (1, "Of 1 headers 1 do not compile alone\n"))
        self.assertIn("law.h:2:8: error:", err)

    def test_asks_again_when_the_checks_change(self):
        self.write("include/law.h", "#pragma once\n")
        self.assertIn("0 of them known", self.run_tidy("--all")[1])
        self.write(".clang-tidy", self.tidy_config.replace("integer-division", "branch-clone"))
        self.assertIn("0 of them known", self.run_tidy("--all")[1])

    def test_fails_where_a_source_cannot_be_read(self):
        self.write("src/c.cpp", "#include <missing.h>\n")
        status, said = self.run_tidy("--all")
        self.assertEqual(status, 1)
        self.assertIn("'missing.h' file not found", said)


class HeadersAlone(unittest.TestCase):
    def test_are_those_that_changed_and_those_that_include_them(self):
        a, b, c, other = (Path(f"/house/{name}.h") for name in ("a", "b", "c", "other"))
        headers = {a: set(), b: {"a.h"}, c: {"b.h"}, other: {"vector"}}
        self.assertEqual(headers_alone.with_users({a}, headers), {a, b, c})
        self.assertEqual(headers_alone.with_users({Path("/house/private.h"), Path("/house/a.cpp")}, headers), set())


class Checks(unittest.TestCase):
    def test_are_each_there_with_what_it_would_find(self):
        text = (ROOT / ".clang-tidy").read_text()
        explained = [line[4:].split(":")[0] for line in text.splitlines() if line.startswith("#   ") and ": " in line]
        enabled = [name.strip() for name in text.split("Checks: >")[1].split("WarningsAsErrors")[0].split(",")]
        self.assertEqual(enabled, ["-*", *explained])


if __name__ == "__main__":
    unittest.main()
