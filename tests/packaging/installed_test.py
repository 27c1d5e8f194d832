#!/usr/bin/env python3
"""Kerf installed, moved, and run from where it is then. Arguments: the program cmake, a build folder."""

import json
import os
import stat
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CMAKE, BUILD = sys.argv[1], sys.argv[2]


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        scratch = Path(cls.folder.name)
        staged = {**os.environ, "DESTDIR": str(scratch / "staged")}
        for component in ["program", "udev", "documentation", "examples"]:
            subprocess.run(
                [CMAKE, "--install", BUILD, "--prefix", "/opt/kerf", "--component", component],
                env=staged, check=True, stdout=subprocess.DEVNULL)
        cls.prefix = scratch / "moved"
        (scratch / "staged/opt/kerf").rename(cls.prefix)
        cls.work = scratch / "work"
        cls.work.mkdir()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_kerf(self, *words):
        return subprocess.run(
            [self.prefix / "bin/kerf", *words], cwd=self.work, capture_output=True, text=True, check=False,
            env={"PATH": "/usr/bin:/bin", "HOME": str(self.work)})

    def kerf(self, *words):
        done = self.run_kerf(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_goes_from_a_recording_to_a_law_that_renders(self):
        examples = self.prefix / "share/doc/kerf/examples"
        self.kerf("import", str(examples / "data/punch.txt"), "--map", "time=time,position=angle,force=force",
                  "-o", "punch.h5")
        self.assertGreater(json.loads(self.kerf("info", "punch.h5", "--json"))["samples"], 1000)
        self.kerf("fit", "punch.h5", "--models", "kelvin", "--no-folds", "-o", "fits")
        self.kerf("check", "fits/kelvin.law.toml", "--virtual", "--seconds", "1")
        self.kerf("record", "--virtual", "--scene", str(examples / "scenes/palpation.scene.toml"), "--seconds", "0.1",
                  "-o", "cut.h5")

    def test_keeps_its_helpers_where_nobody_types_their_names(self):
        helpers = {path.name for path in (self.prefix / "libexec/kerf").iterdir()}
        self.assertEqual(helpers, {"kerf-device-host", "kerf-guard", "kerf-law-trial", "kerf-reader", "kerf-unpack"})
        self.assertEqual({path.name for path in (self.prefix / "bin").iterdir()}, {"kerf", "kerf-emulate"})

    def test_takes_no_reader_from_elsewhere(self):
        self.kerf("record", "--virtual", "--seconds", "0.1", "-o", "r.h5")
        reader = self.prefix / "libexec/kerf/kerf-reader"
        away = reader.rename(self.prefix / "bin/kerf-reader")
        try:
            refused = self.run_kerf("info", "r.h5")
            self.assertEqual(refused.returncode, 4)
            self.assertIn(str(reader), refused.stderr)
        finally:
            away.rename(reader)
        self.kerf("info", "r.h5")

    def test_names_no_folder_of_the_build(self):
        for program in [*(self.prefix / "bin").iterdir(), *(self.prefix / "libexec/kerf").iterdir()]:
            self.assertNotIn(os.fsencode(BUILD), program.read_bytes(), program)
            self.assertTrue(program.stat().st_mode & stat.S_IXOTH, program)

    def test_brings_its_manual_and_what_its_help_points_to(self):
        documents = self.prefix / "share/doc/kerf"
        for name in ["man/man1/kerf.1.gz", "man/man1/kerf-session-new.1.gz", "man/man1/kerf-emulate.1.gz",
                     "bash-completion/completions/kerf", "zsh/site-functions/_kerf", "fish/vendor_completions.d/kerf.fish"]:
            self.assertTrue((self.prefix / "share" / name).is_file(), name)
        for name in ["docs/devices.md", "docs/charts.md", "drivers/README.md", "firmware/hapkit/hapkit.ino", "examples/blade.law.toml", "README.md"]:
            self.assertTrue((documents / name).is_file(), name)
        self.assertTrue((self.prefix / "lib/udev/rules.d/70-kerf.rules").is_file())

    def test_is_plain_files_that_everybody_may_read(self):
        for path in self.prefix.rglob("*"):
            self.assertFalse(path.is_symlink(), path)
            wanted = stat.S_IROTH | (stat.S_IXOTH if path.is_dir() else 0)
            self.assertEqual(path.stat().st_mode & wanted, wanted, path)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
