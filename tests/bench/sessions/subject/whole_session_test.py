"""A whole ABX session, and one of yes and no with confidence, of `kerf session run --page` by the wall clock, on simulated scissors, in a browser.

whole_session_test.py KERF EXAMPLES
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

import browser
import two_springs

ABX = """
name = "two springs"
design = "abx"
consent = "I take part."
instructions = "Close and open."
trials = 2"""
APPARATUS = """
[apparatus]
noise = "pink"
headphones = "closed, over both ears"
occlusion = "a curtain"
"""

YES_NO = """
name = "yes or no"
design = "yes-no"
question = "Was it the stiffer one?"
signal = "exponential"
confidence = ["unsure", "sure"]
trials = 2
interval = { value = 300, unit = "ms" }
gap = { value = 50, unit = "ms" }"""


def kerf(program, *arguments):
    done = subprocess.run([program, "session", *arguments], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return done.stdout


def click(page, selector):
    page.wait_for(selector, "const b = document.querySelector(arguments[0]); return b && !b.disabled && b.offsetHeight > 0 && "
                  "b.getAttribute('aria-disabled') !== 'true'", selector)
    page.one(selector).click()


def sets_the_noise(page):
    page.wait_for("the noise", "return document.querySelector('#noise').hidden === false && document.querySelector('#go_on').hidden")
    click(page, "#noise_play")
    page.wait_for("noise to be heard", "return player.sounds && player.gain.gain.value > 1e-4")
    click(page, "#noise_keep")
    page.wait_for("silence till a trial", "return document.querySelector('#noise').hidden && !document.querySelector('#go_on').hidden && "
                  "player.gain.gain.value < 1e-4")


def answers_all(page, url):
    page.open(url)
    sets_the_noise(page)
    for heading in ("welcome", "consent", "instructions"):
        page.wait_for(heading, "return document.querySelectorAll('#go_on button').length === arguments[0]", 2 if heading == "consent" else 1)
        click(page, "#go_on button.firm")
    for trial in (1, 2):
        page.wait_for(f"trial {trial}", "return document.querySelector('#progress').textContent.includes(arguments[0])",
                      f"Trial {trial} of 2")
        page.wait_for("noise in a trial", "return player.sounds && Math.abs(player.gain.gain.value - 10 ** (-50 / 20)) < 1e-3")
        for slot in (1, 2, 3):
            click(page, f"#feel_row button:nth-child({slot})")
            page.wait_for("what plays", "return document.querySelector('#plays').textContent.includes(arguments[0])",
                          f"You feel {'ABX'[slot - 1]} now")
            page.wait_for("a moment to have passed", "window.since ??= performance.now(); const over = performance.now() - "
                          "window.since > 450; if (over) window.since = undefined; return over")
        click(page, "#answer_row button:nth-child(1)")
    page.wait_for("the end", "return document.querySelector('#text').textContent.includes('last trial') || "
                  "document.querySelector('#heading').textContent.includes('over') || "
                  "document.body.textContent.includes('Thank you')")


def answers_in_words(page, url):
    page.open(url)
    page.wait_for("welcome", "return document.querySelectorAll('#go_on button').length === 1")
    click(page, "#go_on button.firm")
    words = ["1 no, sure", "2 no, unsure", "3 yes, unsure", "4 yes, sure"]
    page.wait_for("words", "return [...document.querySelectorAll('#answer_row button')].map((it) => it.textContent).join('|') === "
                  "arguments[0]", "|".join(words))
    click(page, "#answer_row button:nth-child(2)")
    page.wait_for("trial 2", "return document.querySelector('#progress').textContent.includes('Trial 2 of 2')")
    page.wait_for("its answer", "return document.querySelector('#answer_row button').getAttribute('aria-disabled') === 'false' && "
                  "document.querySelector('#keys').textContent.includes('4 (yes, sure)')")
    page.press("4")
    page.wait_for("the end", "return document.body.textContent.includes('Thank you')")


def run_in_browser(program, folder, name, protocol, answers, *arguments):
    """The session file, and what the experimenter's screen told."""
    file, key, session = folder / f"{name}.protocol.toml", str(folder / "k.key"), str(folder / f"{name}.h5")
    file.write_text(protocol)
    kerf(program, "new", str(file), "--subject", "S01", "--key-file", key, "-o", session)
    running = subprocess.Popen([program, "session", "run", session, "--key-file", key, "--page", *arguments],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    page = None
    try:
        seen = []
        for line in running.stderr:
            seen.append(line)
            if found := re.search(r"(http://127\.0\.0\.1:\S+)", line):
                break
        page = browser.Browser(str(folder / f"profile-{name}"))
        answers(page, found[1])
        seen += list(running.stderr) + list(running.stdout)
        assert running.wait(timeout=20) == 0, seen
    finally:
        running.kill()
        running.wait()
        if page:
            page.close()
    screen = "".join(seen)
    assert "kelvin" not in screen and "exponential" not in screen, f"the experimenter's screen tells: {screen}"
    return session, screen


def main():
    if not browser.is_there():
        print("skipped: Debian's chromium and chromium-driver are not there")
        return 77
    program, examples = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        key = str(folder / "k.key")
        kerf(program, "key", key)
        session, screen = run_in_browser(program, folder, "abx", two_springs.protocol(examples, ABX, APPARATUS), answers_all,
                                         "--apparatus", "headphones=yes")
        assert "occlusion (a curtain): nobody has confirmed it" in screen, screen
        result = json.loads(kerf(program, "analyze", session, "--key-file", key, "--json"))
        assert result["trials"] == 2, result
        assert [one["sample"] for one in result["felt"]["samples"]] == ["kelvin", "exponential"], result["felt"]
        kerf(program, "share", session, "--key-file", key, "-o", str(folder / "dataset"))
        methods = (folder / "dataset/documentation/methods.md").read_text()
        assert "pink noise during trials; its level was set in 1 of 1 sessions (-50 to -50 dB" in methods, methods
        assert "| headphones: closed, over both ears | 1 | 0 | 0 |" in methods, methods
        assert "| occlusion: a curtain | 0 | 0 | 1 |" in methods, methods
        session, _ = run_in_browser(program, folder, "words", two_springs.protocol(examples, YES_NO), answers_in_words)
        kerf(program, "open", session, "--key-file", key, "-o", str(folder / "opened"))
        table = [line for line in (folder / "opened" / "trials.csv").read_text().splitlines() if not line.startswith("#")]
        rows = [dict(zip(table[0].split(","), row.split(","))) for row in table[1:]]
        assert [(row["answer"], row["confidence"]) for row in rows] == [("no", "1"), ("yes", "2")], rows
        assert sorted(row["right"] for row in rows) == ["no", "yes"], rows
    print("the session works")
    return 0


sys.exit(main())
