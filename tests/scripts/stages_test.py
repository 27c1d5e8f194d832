"""Which stages scripts/test runs, with stages of nothing in place of its own."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

TEST = Path(__file__).resolve().parents[2] / "scripts" / "test"
HELPERS = ("set-up", "build", "fuzz", "test.d/run_tests.py", "test.d/headers_alone.py", "test.d/tidy.py", "test.d/changed_files.py",
           "usb-machine.d/find-kernel")


class Stages(unittest.TestCase):
    def run_stages(self, minutes=None, instead=None):
        """@returns the exit status, and what it printed. `instead`: what helpers do in place of nothing."""
        with tempfile.TemporaryDirectory() as folder:
            scripts = Path(folder, "scripts")
            for name in HELPERS:
                helper = scripts / name
                helper.parent.mkdir(parents=True, exist_ok=True)
                nothing = "exit 1" if name.endswith("changed_files.py") else "exit 0"
                helper.write_text("#!/bin/sh\n%s\n" % (instead or {}).get(name, nothing))
                helper.chmod(0o755)
            shutil.copy(TEST, scripts / "test")
            environment = {name: value for name, value in os.environ.items() if name != "KERF_TEST_MINUTES"}
            if minutes is not None:
                environment["KERF_TEST_MINUTES"] = str(minutes)
            done = subprocess.run([scripts / "test", "--all"], capture_output=True, text=True, env=environment)
            return done.returncode, done.stdout

    def test_of_clang_run_where_there_is_time(self):
        says = {"test.d/run_tests.py": 'echo "ran $*"'}
        for minutes, until in ((None, ""), (88, "--until [0-9]+ ")):
            status, said = self.run_stages(minutes, instead=says)
            self.assertEqual(status, 0)
            self.assertRegex(said, "Clang, sanitizers: tests +passed")
            self.assertRegex(said, f"ran --totals [^ ]+ {until}--preset dev")
            self.assertNotIn("Clang: all of it", said)

    def test_of_clang_are_left_out_and_named_where_there_is_none(self):
        status, said = self.run_stages(minutes=4)  # its tests have some minutes, or there are none
        self.assertEqual(status, 0)
        self.assertRegex(said, "Clang: all of it +left out: built in minute 0 of 4")
        self.assertNotIn("Clang, sanitizers", said)

    def test_that_follow_gccs_part_are_stopped_and_named_when_the_time_is_up(self):
        all_changed = {"test.d/changed_files.py": "exit 0"}
        ends = {"test.d/run_tests.py": 'case "$*" in *--until*) exit 124 ;; esac'}
        status, said = self.run_stages(minutes=88, instead=all_changed | ends)
        self.assertEqual(status, 0)
        for name in ("USB machine: tests", "Page: tests, types, style", "Clang, sanitizers: tests", "Thread sanitizer: tests"):
            self.assertRegex(said, name + " +stopped")
        self.assertRegex(said, "GCC: tests +passed")
        self.assertRegex(said, "Together +passed")

    def test_whose_build_is_stopped_are_not_run(self):
        status, said = self.run_stages(minutes=88, instead={"build": 'case $1 in dev) exit 124 ;; esac'})
        self.assertEqual(status, 0)
        self.assertRegex(said, "Clang, sanitizers: build +stopped")
        self.assertRegex(said, "Clang, sanitizers: tests +not run")

    def test_that_fail_make_it_fail(self):
        for minutes in (None, 1):
            status, said = self.run_stages(minutes, instead={"test.d/run_tests.py": "exit 8"})
            self.assertEqual(status, 1)
            self.assertRegex(said, "GCC: tests +FAILED")


if __name__ == "__main__":
    unittest.main()
