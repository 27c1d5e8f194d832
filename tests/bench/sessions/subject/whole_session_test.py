"""A whole ABX session of `kerf session run --page` by the wall clock, on simulated scissors, in a browser.

whole_session_test.py KERF EXAMPLES
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

import browser

PROTOCOL = """
name = "two springs"
design = "abx"
consent = "I take part."
instructions = "Close and open."
trials = 2
device = "sim:scissors"
ramp = {{ value = 20, unit = "ms" }}
[[sample]]
name = "kelvin"
law = "{examples}/kelvin.law.toml"
[[sample]]
name = "exponential"
law = "{examples}/exponential.law.toml"
"""


def kerf(program, *arguments):
    done = subprocess.run([program, "session", *arguments], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return done.stdout


def click(page, selector):
    page.wait_for(selector, "const b = document.querySelector(arguments[0]); return b && !b.disabled && b.offsetHeight > 0 && "
                  "b.getAttribute('aria-disabled') !== 'true'", selector)
    page.one(selector).click()


def answers_all(page, url):
    page.open(url)
    for heading in ("welcome", "consent", "instructions"):
        page.wait_for(heading, "return document.querySelectorAll('#go_on button').length === arguments[0]", 2 if heading == "consent" else 1)
        click(page, "#go_on button.firm")
    for trial in (1, 2):
        page.wait_for(f"trial {trial}", "return document.querySelector('#progress').textContent.includes(arguments[0])",
                      f"Trial {trial} of 2")
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


def main():
    if not browser.is_there():
        print("skipped: Debian's chromium and chromium-driver are not there")
        return 77
    program, examples = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "p.protocol.toml").write_text(PROTOCOL.format(examples=examples))
        key, session = str(folder / "k.key"), str(folder / "s.h5")
        kerf(program, "key", key)
        kerf(program, "new", str(folder / "p.protocol.toml"), "--subject", "S01", "--key-file", key, "-o", session)
        running = subprocess.Popen([program, "session", "run", session, "--key-file", key, "--page"], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        page = None
        try:
            seen = []
            for line in running.stderr:
                seen.append(line)
                if found := re.search(r"(http://127\.0\.0\.1:\S+)", line):
                    break
            page = browser.Browser(str(folder / "profile"))
            answers_all(page, found[1])
            seen += list(running.stderr) + list(running.stdout)
            assert running.wait(timeout=20) == 0, seen
        finally:
            running.kill()
            running.wait()
            if page:
                page.close()
        screen = "".join(seen)
        assert "kelvin" not in screen and "exponential" not in screen, f"the experimenter's screen tells: {screen}"
        result = json.loads(kerf(program, "analyze", session, "--key-file", key, "--json"))
        assert result["trials"] == 2, result
    print("the session works")
    return 0


sys.exit(main())
