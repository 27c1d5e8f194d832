#!/usr/bin/env python3
"""The Debian packages of a build folder, as lintian and dpkg see them. Arguments: the program cpack, the build folder.

That they install, serve and leave nothing behind is tried by scripts/package --try, which needs an empty Debian.
"""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CPACK, BUILD = sys.argv[1], Path(sys.argv[2])


def output_of(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    return done.stdout + done.stderr


class Debian(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        # Beside a package that somebody keeps, none of it: packed for speed and not for size.
        done = subprocess.run([CPACK, "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder.name,
                               "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip"],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(done.stdout + done.stderr)
        cls.packages = sorted(Path(cls.folder.name).glob("*.deb"))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def package(self, name):
        return next(path for path in self.packages if path.name.startswith(name + "_"))

    def test_pass_lintian_but_for_what_is_explained(self):
        self.assertEqual(output_of("lintian", "--allow-root", "--suppress-tags", "uses-no-compression-for-data-tarball",
                                   *self.packages), "")

    def test_depend_on_what_they_link(self):
        depends = output_of("dpkg-deb", "--field", self.package("kerf"), "Depends")
        for name in ["libc6 (>=", "libstdc++6 (>=", "libusb-1.0-0", "libhdf5-103"]:
            self.assertIn(name, depends)
        self.assertIn("libsodium23", output_of("dpkg-deb", "--field", self.package("libkerf1"), "Depends"))
        version = output_of("dpkg-deb", "--field", self.package("libkerf1"), "Version").strip()
        self.assertIn("libkerf1 (= %s)" % version, output_of("dpkg-deb", "--field", self.package("libkerf-dev"), "Depends"))
        self.assertIn("gnuplot", output_of("dpkg-deb", "--field", self.package("kerf"), "Recommends"))

    def test_of_python_need_the_program_and_the_python_that_they_are_for(self):
        if not (BUILD / "python").exists():
            self.skipTest("built without the Python package")
        python = self.package("python3-kerf")
        depends = output_of("dpkg-deb", "--field", python, "Depends")
        version = output_of("dpkg-deb", "--field", python, "Version").strip()
        for name in ["kerf (= %s)" % version, "python3 (>= 3.", "python3 (<< 3.", "python3-numpy", "libcholmod3"]:
            self.assertIn(name, depends)
        files = output_of("dpkg-deb", "--contents", python)
        for name in ["__init__.py", "laws.py", "_core.pyi", "py.typed"]:
            self.assertIn("./usr/lib/python3/dist-packages/kerf/" + name, files)
        self.assertRegex(files, r"\./usr/lib/python3/dist-packages/kerf/_core\.cpython-3\d+-[a-z0-9_-]+\.so\n")

    def test_lie_beside_those_of_other_architectures(self):
        for name, wanted in [("kerf", "foreign"), ("libkerf1", "same"), ("libkerf-dev", "same")]:
            self.assertEqual(output_of("dpkg-deb", "--field", self.package(name), "Multi-Arch").strip(), wanted, name)

    def test_tell_what_the_library_shows_and_has_the_linker_told_by_a_trigger(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(output_of("dpkg-deb", "--raw-extract", self.package("libkerf1"), folder), "")
            control = Path(folder, "DEBIAN")
            self.assertEqual({path.name for path in control.iterdir()}, {"control", "md5sums", "shlibs", "symbols", "triggers"})
            self.assertRegex((control / "shlibs").read_text(), r"^libkerf 1 libkerf1 \(>= [0-9.]+\)\n$")
            self.assertEqual((control / "triggers").read_text(), "activate-noawait ldconfig\n")
            library = next(Path(folder, "usr/lib").glob("*/libkerf.so.1.*"))
            found = subprocess.run(["dpkg-gensymbols", "-c4", "-plibkerf1", "-v0.1.0", "-I" + str(control / "symbols"),
                                    "-e" + str(library), "-O" + str(Path(folder, "symbols"))],
                                   capture_output=True, text=True, check=False, cwd=folder)
            self.assertEqual((found.returncode, found.stdout + found.stderr), (0, ""))

    def test_have_files_of_their_own_only(self):
        owner = {}
        for package in self.packages:
            for line in output_of("dpkg-deb", "--contents", package).splitlines():
                words = line.split()
                self.assertEqual(words[1], "root/root", line)
                if not words[5].endswith("/"):
                    self.assertNotIn(words[5], owner, package.name)
                    owner[words[5]] = package.name
        self.assertEqual(owner["./usr/bin/kerf"], self.package("kerf").name)
        for header in ["kerf.h", "kerf.hpp", "law.h", "plugin.h"]:
            self.assertEqual(owner["./usr/include/kerf/" + header], self.package("libkerf-dev").name)
        self.assertTrue(all(path.startswith("./usr/") for path in owner))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
