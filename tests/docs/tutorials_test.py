#!/usr/bin/python3
"""The tutorials do what they say: their commands run in an empty folder, and print what stands below them. Arguments: the tree, kerf, CMake,
the build.

Of a page, in its order: a block of `sh` is run; one with a title is written to the file of that name; each line of a block of `text` is
one that the last commands have printed, where "..." stands for the rest of a line.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT, KERF, CMAKE, BUILD = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3], sys.argv[4]
BLOCK = re.compile(r"^```(\w+)(?: title=\"([^\"]+)\")?\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def follow(page, folder, environment):
    """Goes through a page. What of it does not hold, or None."""
    printed = ""
    for language, title, body in BLOCK.findall(page):
        if title:
            (folder / title).parent.mkdir(exist_ok=True)
            (folder / title).write_text(body, encoding="utf-8")
        elif language == "sh":
            done = subprocess.run(["sh", "-e"], input=body, cwd=folder, env=environment, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, check=False)  # fmt: skip
            printed = done.stdout
            if done.returncode:
                return f"{body}ends with {done.returncode}:\n{printed}"
        elif language == "text":
            lines = [line.rstrip() for line in printed.splitlines()]
            for line in body.splitlines():
                start, cut, _ = line.partition("...")
                if not any(one.startswith(start) if cut else one == line for one in lines):
                    return f"nothing printed\n{line}\nbut:\n{printed}"
    return None


class Tutorials(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.installed = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.installed.cleanup)
        for component in ("runtime", "development"):
            subprocess.run([CMAKE, "--install", BUILD, "--component", component, "--prefix", cls.installed.name], check=True,
                           stdout=subprocess.DEVNULL)  # fmt: skip
        library = next(Path(cls.installed.name).rglob("libkerf.so.1")).parent
        cls.environment = {**os.environ, "PATH": f"{KERF.parent}:{os.environ['PATH']}", "LD_LIBRARY_PATH": str(library), "LC_ALL": "C.UTF-8",
                           "PKG_CONFIG_PATH": str(library / "pkgconfig")}

    def follow(self, page):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "examples").symlink_to(ROOT / "examples")
            self.assertIsNone(follow(page, Path(folder), self.environment))

    def test_of_the_lab(self):
        self.follow((ROOT / "docs/tutorials/lab-user.md").read_text(encoding="utf-8"))

    def test_of_the_law_author(self):
        self.follow((ROOT / "docs/tutorials/law-author.md").read_text(encoding="utf-8"))

    def test_of_the_simulator(self):
        self.follow((ROOT / "docs/tutorials/simulator.md").read_text(encoding="utf-8"))

    def test_of_the_experimenter(self):
        self.follow((ROOT / "docs/tutorials/experimenter.md").read_text(encoding="utf-8"))

    def test_are_all_of_the_folder(self):
        self.assertEqual({path.stem for path in (ROOT / "docs/tutorials").glob("*.md")}, {"experimenter", "lab-user", "law-author", "simulator"})

    def test_that_do_not_hold_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            def tried(page):
                return follow(page, Path(folder), self.environment)
            self.assertIsNone(tried('```c title="a.c"\nint a;\n```\n```sh\ncat a.c\n```\n```text\nint a;\nint ...\n```\n'))
            self.assertIn("ends with 3", tried("```sh\nexit 3\necho never\n```\n"))
            self.assertIn("nothing printed\nhalf", tried("```sh\necho half a line\n```\n```text\nhalf\n```\n"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
