"""A study of twelve people, from its plan to a dataset, by the wall clock and in a browser: one leaves and is replaced, once the loop
stalls, once the program is killed, and the answers are looked at halfway.

whole_study_test.py KERF EXAMPLES
"""

import csv
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

import browser
import two_springs

TOP = """
name = "two springs"
design = "abx"
consent = "I take part."
trials = 2"""

SCREEN = """const on = (b) => b && b.offsetHeight > 0 && b.getAttribute('aria-disabled') !== 'true';
const all = (s) => [...document.querySelectorAll(s)];
return {progress: document.querySelector('#progress').textContent, go_on: all('#go_on button.firm').some(on),
        feel: all('#feel_row button').filter(on).length, answer: all('#answer_row button').some(on),
        plays: document.querySelector('#plays').textContent}"""


class Study:
    def __init__(self, program, examples, folder, page):
        self.program, self.folder, self.page = program, folder, page
        self.key = str(folder / "k.key")
        self.study = str(folder / "study")
        self.screens = ""
        (folder / "p.protocol.toml").write_text(two_springs.protocol(examples, TOP))
        self.kerf("key", self.key, sealed=False)
        self.kerf("plan", str(folder / "p.protocol.toml"), "--participants", "12", "--rule", "alpha-spending", "--look", "6",
                  "-o", self.study, sealed=False)
        self.kerf("new", self.study, "--no-check")

    def kerf(self, *arguments, sealed=True, status=0):
        words = [self.program, "session", *arguments, *(("--key-file", self.key) if sealed else ())]
        done = subprocess.run(words, capture_output=True, text=True, timeout=120)
        assert done.returncode == status, (words, done.returncode, done.stderr)
        return done.stdout if status == 0 else done.stderr

    def sit(self, code, by_key=False, at_trial=lambda trial, process: True):
        """Somebody sits down, feels each slot and answers, until the session is over or `at_trial`, asked while B plays, says that it is."""
        words = [self.program, "session", "run", self.study, "--subject", code, "--key-file", self.key, "--page", "--no-check"]
        process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        try:
            for line in process.stderr:
                self.screens += line
                if found := re.search(r"(http://127\.0\.0\.1:\S+)", line):
                    break
            self.page.open(found[1])
            while process.poll() is None:
                if not self.act(by_key, lambda trial: at_trial(trial, process)):
                    break
            out, errors = process.communicate(timeout=30)
            self.screens += out + errors
            return process.returncode
        finally:
            process.kill()
            process.wait()

    def click(self, selector):
        """What is there by now: a screen may come anew between a look and a click."""
        self.page.run("document.querySelector(arguments[0])?.click()", selector)

    def act(self, by_key, at_trial):
        screen = self.page.run(SCREEN)
        if screen["go_on"]:
            self.click("#go_on button.firm")
            time.sleep(0.05)
        elif screen["feel"] == 3 and not screen["answer"]:
            trial = int(re.search(r"Trial (\d+)", screen["progress"])[1])
            for slot, label in enumerate("abx"):
                if by_key:
                    self.page.press(label)
                else:
                    self.click(f"#feel_row button:nth-child({slot + 1})")
                time.sleep(0.5)
                if slot == 1 and not at_trial(trial):
                    return False
        elif screen["answer"]:
            if by_key:
                self.page.press("Enter", "b")
            else:
                self.click("#answer_row button")
            end = time.monotonic() + 5
            while time.monotonic() < end and self.page.run(SCREEN)["progress"] == screen["progress"]:
                time.sleep(0.02)
        else:
            time.sleep(0.02)
        return True


def leaves_in(trial_left):
    def at(trial, process):
        if trial < trial_left:
            return True
        process.send_signal(signal.SIGINT)
        return False
    return at


def is_killed_in(trial_killed):
    def at(trial, process):
        if trial < trial_killed:
            return True
        process.kill()
        return False
    return at


def stalls_in(trial_stalled):
    def at(trial, process):
        if trial == trial_stalled:
            os.kill(process.pid, signal.SIGSTOP)
            time.sleep(0.3)
            os.kill(process.pid, signal.SIGCONT)
        return True
    return at


def rows_of(dataset, name):
    with open(dataset / f"data/task-abx_description-{name}_data.csv", encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def check_dataset(dataset, analysis):
    """Held against what the analysis counted, and against itself."""
    trials, people = rows_of(dataset, "trials"), rows_of(dataset, "participants")
    through = [row["subject_id"] for row in people if row["analysed"] == "TRUE"]
    assert len(through) == 12 and "S05" not in through and "S13" in through, people
    left = next(row for row in people if row["subject_id"] == "S05")
    assert (left["stage"], left["reason"], left["sessions"]) == ("dropped", "was called away", "0"), left
    assert next(row for row in people if row["subject_id"] == "S13")["replaces"] == "S05"
    counted = [row for row in trials if row["practice"] == "FALSE"]
    assert len(counted) == 24 == analysis["trials"], len(counted)
    assert len({row["trial_id"] for row in trials}) == len(trials)
    assert {row["subject_id"] for row in trials} == set(through)
    right = sum(row["correct"] == "TRUE" for row in counted)
    assert right == analysis["correct"], (right, analysis["correct"])
    assert all(row["felt"] in ("TRUE", "FALSE") and row["device"] == "sim:scissors" for row in trials), trials
    stalled = next(row for row in counted if row["trial_id"] == "S07-1-002")
    assert stalled["sound"] == "FALSE", "a stalled loop is a fault of its trial"
    description = json.loads((dataset / "dataset_description.json").read_text())
    columns = {name for table in ("trials", "slots", "participants") for name in rows_of(dataset, table)[0]}
    assert {one["name"] for one in description["variableMeasured"]} == columns
    methods = (dataset / "documentation/methods.md").read_text()
    for words in ("12 participants; primary test: difference", "13 assigned, 13 begun, 12 completed, 1 dropped, 1 replaced",
                  "S05 dropped: was called away; S13 has their order", "Look 1 at 6 participants", "Look 2 at 12 participants"):
        assert words in methods, (words, methods)


def whole_study(study):
    for code in ("S01", "S02"):
        assert study.sit(code, by_key=code == "S02") == 0, study.screens
    assert study.sit("S03", at_trial=is_killed_in(2)) == -signal.SIGKILL
    assert study.sit("S03") == 0, study.screens
    assert study.sit("S04") == 0, study.screens
    study.sit("S05", at_trial=leaves_in(2))
    refused = study.kerf("share", study.study, "-o", str(study.folder / "early"), status=2)
    assert "is under way" in refused, refused
    study.kerf("drop", study.study, "S05", "--reason", "was called away")
    study.kerf("new", study.study, "--replaces", "S05", "--no-check")
    assert study.sit("S06", by_key=True) == 0 and study.sit("S07", at_trial=stalls_in(2)) == 0, study.screens
    halfway = json.loads(study.kerf("analyze", study.study, "--json"))["experiment"]
    assert halfway["look"]["paid"] and not halfway["decision"]["shown"], halfway
    for code in ("S08", "S09", "S10", "S11", "S12", "S13"):
        assert study.sit(code, by_key=code == "S09") == 0, (code, study.screens)
    assert "kelvin" not in study.screens and "exponential" not in study.screens, f"the screen tells: {study.screens}"
    analysis = json.loads(study.kerf("analyze", study.study, "--json"))
    experiment = analysis["experiment"]
    assert experiment["look"]["last"] and experiment["flow"]["analysed"] == 12 and experiment["files"] == [], experiment
    study.kerf("share", study.study, "-o", str(study.folder / "dataset"))
    check_dataset(study.folder / "dataset", analysis)


def main():
    if not browser.is_there():
        print("skipped: Debian's chromium and chromium-driver are not there")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        page = browser.Browser(str(folder / "profile"))
        try:
            whole_study(Study(*sys.argv[1:], folder, page))
        finally:
            page.close()
    print("the study works")
    return 0


sys.exit(main())
