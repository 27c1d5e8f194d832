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
    def run_stages(self, minutes=None, failing=()):
        """@returns the exit status, and what it printed."""
        with tempfile.TemporaryDirectory() as folder:
            scripts = Path(folder, "scripts")
            for name in HELPERS:
                helper = scripts / name
                helper.parent.mkdir(parents=True, exist_ok=True)
                helper.write_text("#!/bin/sh\nexit %d\n" % (name in failing or name.endswith("changed_files.py")))
                helper.chmod(0o755)
            shutil.copy(TEST, scripts / "test")
            environment = {name: value for name, value in os.environ.items() if name != "KERF_TEST_MINUTES"}
            if minutes is not None:
                environment["KERF_TEST_MINUTES"] = str(minutes)
            done = subprocess.run([scripts / "test", "--all"], capture_output=True, text=True, env=environment)
            return done.returncode, done.stdout

    def test_of_clang_run_where_there_is_time(self):
        for minutes in (None, 88):
            status, said = self.run_stages(minutes)
            self.assertEqual(status, 0)
            self.assertRegex(said, "Clang, sanitizers: tests +passed")
            self.assertNotIn("Clang: all of it", said)

    def test_of_clang_are_left_out_and_named_where_there_is_none(self):
        status, said = self.run_stages(minutes=1)  # some minutes are Clang's own, however fast GCC was
        self.assertEqual(status, 0)
        self.assertRegex(said, "Clang: all of it +left out: it would end in minute 3 of 1")
        self.assertNotIn("Clang, sanitizers", said)

    def test_that_fail_make_it_fail(self):
        for minutes in (None, 1):
            status, said = self.run_stages(minutes, failing=("test.d/run_tests.py",))
            self.assertEqual(status, 1)
            self.assertRegex(said, "GCC: tests +FAILED")


if __name__ == "__main__":
    unittest.main()
