#!/usr/bin/env python3
"""The manual says what --help says, in troff that no reader of it complains of. Arguments: kerf, kerf-emulate, its page."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

KERF, EMULATE, EMULATE_PAGE = sys.argv[1:4]


def output_of(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    return done.stdout + done.stderr


def help_of(*verb):
    return output_of(KERF, *verb, "--help")


def verbs():
    """The words of every verb, those that have verbs of their own too."""
    for name in re.findall(r"^(?:[a-z]+ +| +)([a-z]+) +[A-Z]", help_of(), re.M):
        yield (name,)
        own = help_of(name).partition("Subcommands:\n")[2].partition("\n\n")[0]
        for word in re.findall(r"^  ([a-z]+) ", own, re.M):
            yield (name, word)


def words_of(text):
    """A text without its layout: pages break lines elsewhere, and have hyphens of their own."""
    return re.sub(r"\s+", " ", text)


class ManPages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        pages = Path(cls.folder.name) / "pages"
        subprocess.run([KERF, "pages", "-o", pages, "--date", "2026-11-25"], check=True, stdout=subprocess.DEVNULL)
        cls.pages = pages / "man1"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def shown(self, page):
        environment = {**os.environ, "MANWIDTH": "10000", "LC_ALL": "C.UTF-8", "MAN_KEEP_FORMATTING": ""}
        return words_of(output_of("man", "--local-file", page, env=environment))

    def test_are_there_for_every_verb_and_for_nothing_else(self):
        wanted = {"kerf.1"} | {"-".join(("kerf", *verb)) + ".1" for verb in verbs()}
        self.assertGreater(len(wanted), 30)
        self.assertEqual({page.name for page in self.pages.iterdir()}, wanted)

    def test_pass_those_who_check_pages(self):
        pages = [*sorted(self.pages.iterdir()), EMULATE_PAGE]
        self.assertEqual(output_of("mandoc", "-T", "lint", "-W", "warning", *pages), "")
        said = subprocess.run(["man", "--warnings", "--encoding=UTF-8", "--local-file", *pages], check=False, text=True,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env={**os.environ, "LC_ALL": "C.UTF-8"})
        self.assertEqual(said.stderr, "")

    def test_say_all_that_help_says(self):
        for verb in [("fit",), ("import",), ("devices",), ("reproduce",), ("session",), ("session", "new")]:
            page = self.shown(self.pages / ("-".join(("kerf", *verb)) + ".1"))
            text = help_of(*verb)
            for option in re.findall(r"^  (?:-\w,)?(--[a-z0-9-]+)", text, re.M):
                self.assertIn(option, page)
            head = text.partition("\n")[0]
            self.assertIn(head, page)
            below = text.partition("Example:\n")[2]
            for line in below.splitlines():
                self.assertIn(words_of(line).strip(), page, verb)

    def test_of_the_emulator_has_every_option(self):
        page = self.shown(EMULATE_PAGE)
        options = re.findall(r"^  (?:-\w,)?(--[a-z-]+)", output_of(EMULATE, "--help"), re.M)
        self.assertGreater(len(options), 6)
        for option in options:
            self.assertIn(option, page)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
