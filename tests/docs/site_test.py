#!/usr/bin/python3
"""The documents as a site: whole, without the net, with a reference of all that there is. Arguments: the tree, kerf, a folder for the site."""

import html.parser
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse
from pathlib import Path

ROOT, KERF, SITE = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
sys.path.insert(0, str(ROOT / "scripts/site.d"))
import python_package  # noqa: E402

# Where a browser takes what it shows or runs, by the element.
RESOURCES = {("script", "src"), ("img", "src"), ("link", "href"), ("iframe", "src"), ("source", "src"), ("object", "data"), ("video", "src")}


class Page(html.parser.HTMLParser):
    """What a page of the site names, and takes."""

    def __init__(self, path):
        super().__init__()
        self.links, self.resources, self.ids, self.text = [], [], set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.ids.add(value)
            elif (tag, name) in RESOURCES:
                self.resources.append(value)
            elif (tag, name) == ("a", "href"):
                self.links.append(value)

    def handle_data(self, data):
        self.text.append(data)


def build(root, program, output):
    return subprocess.run([root / "scripts/site", "--program", program, "-o", output], capture_output=True, text=True, check=False)


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(SITE, ignore_errors=True)
        done = build(ROOT, KERF, SITE)
        assert done.returncode == 0, done.stderr
        cls.pages = {path: Page(path) for path in sorted(SITE.rglob("*.html"))}

    def page(self, name):
        return self.pages[SITE / name]

    def test_links_lead_to_pages_and_places_of_it(self):
        self.assertGreater(len(self.pages), 100)
        broken = []
        for path, page in self.pages.items():
            for link in {*page.links, *page.resources}:
                target, place = urllib.parse.urldefrag(link)
                if re.match(r"[a-z]+:", target) or path.name == "404.html":
                    continue
                there = Path(os.path.normpath(path.parent / urllib.parse.unquote(target))) if target else path
                if not there.is_file() or (place and there in self.pages and urllib.parse.unquote(place) not in self.pages[there].ids):
                    broken.append(f"{path.relative_to(SITE)}: {link}")
        self.assertEqual(broken, [])

    def test_shows_lists_and_tables_as_such(self):
        """Forges begin a list or a table right below a line, and take two blanks for what belongs to an item; mkdocs does neither."""
        as_text = [f"{path.relative_to(SITE)}: {line[:80]}" for path in self.pages
                   for line in re.findall(r"<p>(?:(?!</p>).)*?^(?:<p>)?([-*|] .*?)$", path.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)]
        self.assertEqual(as_text, [])

    def test_takes_nothing_from_the_net(self):
        taken = {path: [one for one in page.resources if re.match(r"(?:https?:)?//", one)] for path, page in self.pages.items()}
        for path in SITE.rglob("*.css"):
            taken[path] = re.findall(r"(?:@import[^;]*|url\([\"']?)((?:https?:)?//[^)\"';]*)", path.read_text())
        self.assertEqual({path: found for path, found in taken.items() if found}, {})

    def test_tells_of_every_verb_as_its_help_does(self):
        verbs = re.findall(r"^(?:[a-z]+ +| +)([a-z]+) +[A-Z]", subprocess.check_output([KERF, "--help"], text=True), re.M)
        self.assertGreater(len(verbs), 25)
        for verb in verbs:
            text = "".join(self.page(f"reference/verbs/{verb}.html").text)
            for option in re.findall(r"^  (?:-\w,)?(--[a-z-]+)", subprocess.check_output([KERF, verb, "--help"], text=True), re.M):
                self.assertIn(option, text, verb)

    def test_tells_of_every_law_with_its_parameters(self):
        page = self.page("reference/laws.html")
        for law in subprocess.check_output([KERF, "laws"], text=True).splitlines():
            name = law.split()[0] if law.strip() else ""
            if re.fullmatch("[a-z_0-9]+", name) and "=" in law:
                self.assertIn(name, page.ids)
        self.assertIn("parallel_stiffness", page.text)

    def test_tells_of_every_function_of_the_library(self):
        text = "".join(self.page("reference/c/kerf.html").text)
        functions = re.findall(r"\b(kerf_\w+)@", (ROOT / "libkerf/libkerf1.symbols").read_text())
        self.assertGreater(len(functions), 20)
        for function in functions:
            self.assertRegex(text, rf"\b{function}\(")

    def test_shows_the_sources_that_documents_point_to(self):
        self.assertEqual((SITE / "sources/models/include/kerf/models/law_facts.h.txt").read_bytes(),
                         (ROOT / "models/include/kerf/models/law_facts.h").read_bytes())
        self.assertIn("../reference/c/device.html", self.page("docs/own-device.html").links)


class PythonPage(unittest.TestCase):
    def test_tells_of_what_the_package_offers(self):
        with tempfile.TemporaryDirectory() as folder:
            package = Path(folder)
            (package / "__init__.py").write_text('"""Recordings."""\nfrom .rows import Rows, look\n__all__ = ["Rows", "look"]\n')
            (package / "rows.py").write_text("raise NotReadWhereThereIsAStub\n")
            (package / "_core.pyi").write_text("def hidden() -> None: ...\n")
            (package / "rows.pyi").write_text(
                'class Rows:\n    count: int  #: of them\n    @property\n    def first(self) -> float:\n        """The first."""\n'
                "    def _own(self) -> None: ...\n\ndef hidden() -> None: ...\n\n"
                'def look(path: str, *, at: int = 0) -> Rows:\n    """Opens.\n    :param path, at: where\n    :raises ValueError: no rows\n    """\n')
            self.assertEqual(python_package.page(package), "\n".join([
                "# Python: `import kerf`\n", "Recordings.\n", "## rows\n",
                "### `kerf.Rows`\n", "```python\nclass Rows:\n    count: int  #: of them\n```\n",
                "#### `kerf.Rows.first`\n", "```python\nfirst: float\n```\n", "The first.\n",
                "### `kerf.look`\n", "```python\nlook(path: str, *, at: int=0) -> Rows\n```\n",
                "Opens.\n\n- `path, at`: where\n- raises `ValueError`: no rows\n",
            ]))  # fmt: skip


# What has one verb, and no law.
PROGRAM = r"""#!/bin/sh
[ "$1" = laws ] && { echo '{"laws": []}'; exit; }
mkdir -p "$3/man1"
echo '.SH VERBS
.SS start
.TP
\fBkerf demo\fR
Shows' >"$3/man1/kerf.1"
echo '.SH NAME
kerf\-demo \- Shows
.SH SYNOPSIS
\fBkerf demo\fR' >"$3/man1/kerf-demo.1"
"""


class SiteOfABrokenTree(unittest.TestCase):
    """A tree of a few pages, with what scripts/site reads of the whole one."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name) / "tree"
        for name in ["scripts/site", "scripts/site.d", "libkerf/include", "models/include/kerf", "drivers/include",
                     "drivers/emulators/kerf-emulate.1"]:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            (shutil.copytree if (ROOT / name).is_dir() else shutil.copy)(ROOT / name, self.root / name)
        (self.root / "docs").mkdir()
        # Where the reference leads.
        pages = {"laws", "library", "own-law", "own-device", "command-line"}
        for header in self.root.rglob("*.h"):
            pages |= set(re.findall(r"\bdocs/([a-z-]+)\.md", header.read_text(encoding="utf-8")))
        for page in pages:
            (self.root / f"docs/{page}.md").write_text("# A page\n\n## Exit status\n")
        (self.root / "README.md").write_text("# Kerf\n")
        named = "".join(f"  - docs/{page}.md\n" for page in sorted(pages))
        head = (ROOT / "mkdocs.yml").read_text().partition("\nnav:")[0]
        (self.root / "mkdocs.yml").write_text(f"{head}\nnav:\n  - README.md\n{named}  - reference/verbs.md\n  - Verbs: reference/verbs/\n"
                                              "  - reference/laws.md\n  - C: reference/c/\n")
        self.program = Path(self.folder.name) / "program"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)
        self.site = Path(self.folder.name) / "site"

    def test_is_refused_and_an_earlier_one_stays(self):
        (self.site / "search").mkdir(parents=True)
        (self.site / "index.html").write_text("an earlier one")
        (self.root / "README.md").write_text("# Kerf\n\n[x](docs/nowhere.md) ![x](docs/nowhere.png)\n")
        done = build(self.root, self.program, self.site)
        self.assertEqual(done.returncode, 4)
        for complaint in ["docs/nowhere.md", "docs/nowhere.png", "2 warnings"]:
            self.assertIn(complaint, done.stderr)
        (self.root / "README.md").write_text("# Kerf\n")
        (self.root / "docs/lost.md").write_text("# Lost\n")
        done = build(self.root, self.program, self.site)
        self.assertEqual((done.returncode, done.stderr), (4, "scripts/site: mkdocs.yml names no place for docs/lost.md\n"))
        self.assertEqual({path.name: path.is_file() and path.read_text() for path in self.site.iterdir()},
                         {"search": False, "index.html": "an earlier one"})
        self.assertEqual([path.name for path in Path(self.folder.name).iterdir() if path.name not in {"tree", "program", "site"}], [])

    def test_of_a_program_or_into_a_folder_that_will_not_do_is_one_line(self):
        done = subprocess.run([ROOT / "scripts/site", "--program", self.root / "kerf", "-o", self.site], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
        self.assertIn("scripts/build release", done.stderr)
        done = build(ROOT, KERF, self.root)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
        self.assertTrue((self.root / "mkdocs.yml").exists())


if __name__ == "__main__":
    if not Path("/usr/share/mkdocs/themes/material").is_dir():
        print("skipped: mkdocs-material is not installed")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
