#!/usr/bin/python3
"""Every link of the documents leads somewhere, as a forge shows them: files, pictures, places of pages. Argument: the tree."""

import os
import re
import sys
import tempfile
import unittest
import urllib.parse
from pathlib import Path

ROOT = Path(sys.argv.pop(1))
sys.path.insert(0, str(ROOT / "scripts/site.d"))
import pages  # noqa: E402


def prose(text):
    """A document without its code, which holds brackets of its own."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^(?: {4}|\t).*$", "", text, flags=re.MULTILINE)
    return re.sub(r"`[^`\n]*`", lambda code: "x" * len(code[0]), text)


def places(text):
    """What a forge calls the headings of a document: small letters, without marks, a hyphen for each blank; again with a number."""
    found = []
    without_code_blocks = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    for heading in re.findall(r"^#+ (.+)$", without_code_blocks, re.MULTILINE):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")
        again = sum(re.fullmatch(re.escape(name) + r"(-\d+)?", one) is not None for one in found)
        found.append(f"{name}-{again}" if again else name)
    return found


def broken(root):
    """Of each link that leads nowhere: document, link, and what is missing."""
    out = []
    for page in pages.documents(root):
        for link in pages.LINK.finditer(prose((root / page).read_text(encoding="utf-8"))):
            target, place = link["target"], (link["place"] or "")[1:]
            if re.match(r"[a-z]+:", target):
                continue
            there = root / page if not target else root / os.path.normpath(page.parent / urllib.parse.unquote(target))
            if not there.exists():
                out.append(f"{page}: {link[0]}: there is no {target}")
            elif place and (there.suffix != ".md" or place not in places(there.read_text(encoding="utf-8"))):
                out.append(f"{page}: {link[0]}: nothing there has that heading")
    return out


class Links(unittest.TestCase):
    def test_of_the_documents_all_lead_somewhere(self):
        self.assertGreater(len(pages.documents(ROOT)), 70)
        self.assertEqual(broken(ROOT), [])

    def test_that_lead_nowhere_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "docs").mkdir()
            (root / "docs/a.md").write_text("# A\n\n## How, and `why`?\n\n## Twice\n\n## Twice\n\n```sh\n# No heading [x](gone.md)\n```\n")
            (root / "README.md").write_text(
                "[well](docs/a.md) [well](docs/a.md#how-and-why) [well](docs/a.md#twice-1) [well](https://example.org/gone.md) `[](gone.md)`\n"
                "[file](docs/b.md) [place](docs/a.md#when) ![picture](docs/a.png) [code](docs/a.md#no-heading-x)\n")
            self.assertEqual(broken(root), [
                "README.md: docs/b.md: there is no docs/b.md",
                "README.md: docs/a.md#when: nothing there has that heading",
                "README.md: docs/a.png: there is no docs/a.png",
                "README.md: docs/a.md#no-heading-x: nothing there has that heading",
            ])


if __name__ == "__main__":
    unittest.main()
