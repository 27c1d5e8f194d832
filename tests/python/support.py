"""What the tests of the Python package share: the program, and recordings that it makes."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

HOUSE = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ["KERF_PROGRAM"]
EXAMPLES = HOUSE / "examples"


def run(*words, expected=0):
    """Runs the program. @returns what it writes to its standard output."""
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    if done.returncode != expected:
        raise AssertionError("kerf %s: exit status %d\n%s" % (" ".join(map(str, words)), done.returncode, done.stderr))
    return done.stdout


def run_json(*words):
    return json.loads(run(*words, "--json"))


def python(code, **options):
    """Runs lines in a Python of their own."""
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, **options)


def bits(array):
    """Numbers as their bits, so that -0.0 is not 0.0 and a NaN is itself."""
    return array.tobytes()


class InFolder(unittest.TestCase):
    """Tests that share a folder, and what make() puts there once."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="kerf-python-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.make()

    @classmethod
    def make(cls):
        pass

    @classmethod
    def record(cls, name, device, *more, seconds=2):
        file = cls.folder / name
        run("record", "--device", device, "--virtual", "--seconds", seconds, *more, "-o", file)
        return file

    @classmethod
    def import_punch(cls):
        file = cls.folder / "punch.h5"
        run("import", EXAMPLES / "data/punch.txt", "--map", "time=time,position=angle,force=force", "-o", file)
        run("segment", file)
        return file
