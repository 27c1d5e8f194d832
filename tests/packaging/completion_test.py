#!/usr/bin/env python3
"""What bash, zsh and fish make of a half-typed command, each asked itself. Argument: the program kerf."""

import os
import pty
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

KERF = Path(sys.argv[1])

# What is typed, and what stands there after the tab. Blanks, commas and equals signs at the end are the shell's own.
TYPED = {
    "kerf fi": "kerf fit",
    "kerf help cho": "kerf help choose",
    "kerf sess": "kerf session",
    "kerf session ana": "kerf session analyze",
    "kerf fit --prof": "kerf fit --profile",
    "kerf session new --subject S --key-f": "kerf session new --subject S --key-file",
    "kerf fit --loss hub": "kerf fit --loss huber",
    "kerf fit --models kel": "kerf fit --models kelvin",
    "kerf fit --models kelvin,max": "kerf fit --models kelvin,maxwell",
    "kerf fit --models=spr": "kerf fit --models=springpot",
    "kerf laws hunt": "kerf laws hunt_crossley",
    "kerf fit pun": "kerf fit punch.h5",
    "kerf fit punch.h5 pun": "kerf fit punch.h5 punch.h5",
    "kerf fit -o fits pun": "kerf fit -o fits punch.h5",
    "kerf fit --profile --force pun": "kerf fit --profile --force punch.h5",
    "kerf fit --batch dra": "kerf fit --batch drawer/",
    "kerf fit drawer/in": "kerf fit drawer/inner.h5",
    "kerf check pun": "kerf check punch.law.toml",
    "kerf check --device sim:sc": "kerf check --device sim:scissors",
    "kerf check --scene pun": "kerf check --scene punch.scene.toml",
    "kerf regress ru": "kerf regress run",
    "kerf regress run sui": "kerf regress run suite.toml",
    "kerf report res": "kerf report results.h5",
    "kerf report punch.h5 res": "kerf report punch.h5 results.json",
    "kerf report -o r.html punch.h5 res": "kerf report -o r.html punch.h5 results.json",
    "kerf check punch.law.toml pun": "kerf check punch.law.toml pun",
    "kerf check --device=sim:scissors pun": "kerf check --device=sim:scissors punch.law.toml",
    "kerf import pu": "kerf import punch.",
    "kerf pag": "kerf pag",
    "kerf fit --axis pun": "kerf fit --axis pun",
}
FILES = ["punch.h5", "punch.law.toml", "punch.scene.toml", "punch.txt", "suite.toml", "suite.h5", "results.h5", "results.json", "drawer/inner.h5", "drawer/inner.txt"]


class Terminal:
    """A shell at a terminal of its own, whose line is read back by a key that it was given."""

    def __init__(self, command, environment, work, line):
        self.line = line
        process, self.terminal = pty.fork()
        if process == 0:
            os.chdir(work)
            os.execvpe(command[0], command, environment)
        self.process = process

    def write(self, text):
        os.write(self.terminal, text.encode())

    def drain(self):
        os.set_blocking(self.terminal, False)
        try:
            while os.read(self.terminal, 65536):
                pass
        except BlockingIOError:
            pass

    def said(self, path, patience_s=20.0):
        end = time.monotonic() + patience_s
        while not path.exists():
            self.drain()
            if time.monotonic() > end:
                raise TimeoutError("the shell does not answer")
            time.sleep(0.005)
        text = path.read_text()
        path.unlink()
        return text

    def complete(self, typed):
        self.write(typed + "\t\x18s")
        text = self.said(self.line)
        self.write("\x15")
        return text

    def close(self):
        self.write("\x15exit\n")
        os.close(self.terminal)
        os.waitpid(self.process, 0)


class Completion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        cls.work = cls.root / "work"
        for name in FILES:
            (cls.work / name).parent.mkdir(parents=True, exist_ok=True)
            (cls.work / name).touch()
        pages = cls.root / "pages"
        subprocess.run([KERF, "pages", "-o", pages], check=True, stdout=subprocess.DEVNULL)
        share = cls.root / "share"
        for shell, place in [("bash", "bash-completion/completions"), ("zsh", "zsh/site-functions"),
                             ("fish", "fish/vendor_completions.d")]:
            (share / place).parent.mkdir(parents=True)
            (pages / shell).rename(share / place)
        cls.environment = {"PATH": f"{KERF.parent}:/usr/bin:/bin", "HOME": str(cls.root), "TERM": "dumb",
                           "LC_ALL": "C.UTF-8", "XDG_DATA_DIRS": f"{share}:/usr/share"}
        cls.line = cls.root / "line"
        cls.ready = cls.root / "ready"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def hold(self, complete):
        for typed, wanted in TYPED.items():
            with self.subTest(typed):
                self.assertEqual(complete(typed).rstrip(" ,="), wanted)

    def in_terminal(self, command, preparation):
        shell = Terminal(command, self.environment, self.work, self.line)
        try:
            shell.write(f"{preparation}\necho > {self.ready}\n")
            shell.said(self.ready)
            self.hold(shell.complete)
        finally:
            shell.close()

    def test_of_bash(self):
        save = f"printf %s \"$READLINE_LINE\" > {self.line}.new; mv {self.line}.new {self.line}"
        self.in_terminal(["bash", "--noprofile", "--norc"],
                         "source /usr/share/bash-completion/bash_completion\n"
                         f"save() {{ {save}; }}; bind -x '\"\\C-xs\": save'")

    def test_of_zsh(self):
        save = f"print -rn -- \"$BUFFER\" > {self.line}.new; mv {self.line}.new {self.line}"
        self.in_terminal(["zsh", "-f"],
                         f"fpath=({self.root}/share/zsh/site-functions $fpath); autoload -U compinit; compinit -D -u; "
                         f"bindkey -e; save() {{ {save} }}; zle -N save; bindkey '^Xs' save; unsetopt zle_bracketed_paste")

    def test_of_fish(self):
        def complete(typed):
            done = subprocess.run(["fish", "--command", "complete --do-complete $argv[1]", typed], cwd=self.work, check=True,
                                  env=self.environment, capture_output=True, text=True)
            self.assertEqual(done.stderr, "")
            offers = [line.partition("\t")[0] for line in done.stdout.splitlines()]
            if not offers:
                return typed
            begin = typed.rpartition(" ")[0]
            return f"{begin} {os.path.commonprefix(offers)}"

        self.hold(complete)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
