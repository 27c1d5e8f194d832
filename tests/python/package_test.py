"""The package as a whole: what importing it costs and brings, what its types and documents say."""

import ast
import inspect
import os
import pathlib
import re
import subprocess
import sys
import unittest

import kerf
import kerf._core
from support import HOUSE, python

PACKAGE = HOUSE / "python/kerf"


class Importing(unittest.TestCase):
    def test_brings_neither_pandas_nor_scipy_nor_h5py(self):
        done = python("import sys, kerf; print(*sorted({name.split('.')[0] for name in sys.modules}))")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual({"pandas", "scipy", "h5py", "matplotlib"} & set(done.stdout.split()), set())

    def test_starts_no_process_and_writes_nothing(self):
        done = python("import os, kerf; print(os.listdir('/proc/self/task').__len__())", env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        self.assertEqual((done.stdout, done.stderr), ("1\n", ""))

    def test_shows_one_symbol_to_others(self):
        names = subprocess.run(["nm", "-D", "--defined-only", kerf._core.__file__], capture_output=True, text=True, check=True).stdout
        shown = {line.split()[2] for line in names.splitlines() if line.split()[1] in "TD"}
        self.assertEqual(shown, {"PyInit__core"})


class Documents(unittest.TestCase):
    def test_say_something_of_everything_that_is_public(self):
        for name in kerf.__all__:
            public = getattr(kerf, name)
            if not callable(public):
                continue
            self.assertTrue(inspect.getdoc(public), name)
            for member, what in vars(public).items() if inspect.isclass(public) else ():
                if callable(what) and not member.startswith("_"):
                    self.assertTrue(inspect.getdoc(what), "%s.%s" % (name, member))

    def test_have_examples_that_are_python(self):
        for page in (HOUSE / "docs/python.md", PACKAGE / "__init__.py"):
            for block in re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.S):
                ast.parse(block)

    def test_name_what_there_is(self):
        page = (HOUSE / "docs/python.md").read_text(encoding="utf-8")
        for name in set(re.findall(r"\bkerf\.([A-Za-z_]+)\b", page)) - {"readthedocs"}:
            self.assertTrue(hasattr(kerf, name), "docs/python.md speaks of kerf.%s" % name)


class Stubs(unittest.TestCase):
    """_core.pyi says what the module of C++ has; the rest carries its types itself."""

    def setUp(self):
        self.stub = ast.parse((PACKAGE / "_core.pyi").read_text(encoding="utf-8"))

    def test_name_what_the_module_has(self):
        named = {node.name if not isinstance(node, ast.AnnAssign) else node.target.id for node in self.stub.body
                 if isinstance(node, (ast.FunctionDef, ast.ClassDef, ast.AnnAssign))}
        there = {name for name in vars(kerf._core) if not name.startswith("__")}
        self.assertEqual(named, there)

    def test_name_the_members_of_its_classes(self):
        for node in self.stub.body:
            if isinstance(node, ast.ClassDef) and node.name.startswith("Held"):
                named = {member.name for member in node.body if isinstance(member, ast.FunctionDef)}
                there = {name for name in vars(getattr(kerf._core, node.name)) if not name.startswith("__") or name == "__init__"}
                self.assertEqual(named, there - (set() if "__init__" in named else {"__init__"}), node.name)

    def test_are_marked_as_such(self):
        self.assertTrue((PACKAGE / "py.typed").exists())

    def test_stand_for_every_argument(self):
        for source in PACKAGE.glob("*.py"):
            for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
                if not isinstance(node, ast.FunctionDef):
                    continue
                arguments = node.args.args[1 if node.args.args and node.args.args[0].arg in ("self", "cls") else 0:] + node.args.kwonlyargs
                self.assertTrue(node.returns is not None and all(one.annotation for one in arguments), "%s: %s" % (source.name, node.name))


if __name__ == "__main__":
    unittest.main()
