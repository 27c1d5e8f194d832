"""The subject's page in a browser: page_browser_test.py DEMO FOLDER, where the screenshots go.

Goes through a whole session, by mouse and by keyboard alone, and asks what a screen reader is told. Exit status 77 (skipped)
without a browser.
"""

import pathlib
import queue
import subprocess
import sys
import tempfile
import threading
import urllib.error
import urllib.request

sys.dont_write_bytecode = True  # nothing beside the sources
import browser as webdriver  # noqa: E402

LOOKS = """
const visible = (it) => it.getClientRects().length && it.getBoundingClientRect().width > 1;
const light = (rgb) => rgb.slice(0, 3).map((it) => it / 255)
  .map((it) => it <= 0.04045 ? it / 12.92 : ((it + 0.055) / 1.055) ** 2.4)
  .reduce((sum, it, i) => sum + it * [0.2126, 0.7152, 0.0722][i], 0);
const numbers = (text) => text.match(/[\\d.]+/g).map(Number);
const ground = (it) => {
  for (; it; it = it.parentElement) {
    const color = numbers(getComputedStyle(it).backgroundColor);
    if (color.length === 3 || color[3] === 1) return color;
  }
};
return [...document.querySelectorAll('button, .tile, h1, p')].filter(visible).filter((it) => it.textContent.trim()).map((it) => {
  const [a, b] = [light(numbers(getComputedStyle(it).color)), light(ground(it))];
  const box = it.getBoundingClientRect();
  return {tag: it.tagName, text: it.textContent, contrast: (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05),
          height: box.height, width: box.width, size: parseFloat(getComputedStyle(it).fontSize)};
});
"""
BOXES = """return [...document.querySelectorAll('h1, button, .tile, #plays, #notice')].map((it) => {
  const box = it.getBoundingClientRect();
  return [box.x, box.y, box.width, box.height];
});"""
MESSAGES = """
window.said = [];
new MutationObserver(() => window.said.push(document.getElementById('live').textContent))
  .observe(document.getElementById('live'), {childList: true, characterData: true, subtree: true});
"""


def expect(fact, what):
    if not fact:
        raise AssertionError(what)


class Session:
    """A demo and the page of it."""

    def __init__(self, program, browser):
        self.demo = subprocess.Popen([program], stdout=subprocess.PIPE, text=True)
        self.lines = queue.Queue()
        threading.Thread(target=lambda: [self.lines.put(line.strip()) for line in self.demo.stdout], daemon=True).start()
        self.url = self.lines.get(timeout=20)
        self.browser = browser

    def heading(self, text):
        self.browser.wait_for(f"the heading {text!r}", "return document.querySelector('h1').textContent === arguments[0]", text)

    def action(self, kind, slot):
        try:
            line = self.lines.get(timeout=20)
        except queue.Empty:
            line = "nothing"
        expect(line == f"action {kind} {slot}", f"expected action {kind} {slot}, got {line!r}")

    def said(self, text):
        self.browser.wait_for(f"the words {text!r}", "return window.said.some((it) => it.includes(arguments[0]))", text)

    def button(self, name):
        return next(it for it in self.browser.all("main button") if it.name() == name)


def refuses_strangers(session):
    bare = session.url.split("?")[0]
    for url in (bare, bare + "?token=" + "0" * 32, bare + "page.js", bare + "../../etc/passwd"):
        try:
            webdriver.DIRECT.open(url, timeout=10)
            raise AssertionError(f"{url} was answered")
        except urllib.error.HTTPError as error:
            expect(error.code == 403, f"{url}: {error.code}")


def reads_texts(session, browser, folder):
    session.heading("Welcome")
    browser.run(MESSAGES)
    expect(browser.run("return document.documentElement.lang") == "en-GB", "no language")
    expect(len(browser.all("h1")) == 1, "more than one h1")
    expect(browser.one("#text").text() == "You will feel tissues, <b>two</b> &amp; two.", "a text is not shown as text")
    expect(browser.focused().attribute("id") == "heading", "the focus is not at the heading")
    expect(browser.one("#live").role() == "status", "the live region has no role")
    session.button("Continue").click()
    session.action(0, 0)

    session.heading("Your consent")
    browser.screenshot(folder / "consent.png")
    session.said("Your consent")
    browser.press("Enter", "Space")  # agree to nothing: the buttons have to be gone to
    names = []
    while "I agree" not in names:
        expect(len(names) < 6, f"Tab does not lead to the consent, only to {names}")
        browser.press("Tab")
        names.append(browser.focused().name())
    expect("I do not agree" in names, "nothing to decline with")
    outline = browser.run("return getComputedStyle(document.activeElement).outlineWidth")
    expect(float(outline.removesuffix("px")) >= 3, f"the focus is hard to see: {outline}")
    browser.press("Enter")
    session.action(0, 0)
    session.heading("What you will do")
    browser.press("Space")
    session.action(0, 0)


def answers_by_keyboard(session, browser):
    session.heading("Which of A and B is the same as X?")
    session.said("Practice trial 1 of 24. You feel A now.")
    buttons = {it.name(): it for it in browser.all("main button") if it.name()}
    expect(list(buttons) == ["Feel A", "Feel B", "Feel X", "Answer A", "Answer B"], f"buttons: {list(buttons)}")
    expect(all(it.role() == "button" for it in buttons.values()), "a button is none")
    expect(buttons["Feel A"].attribute("aria-pressed") == "true", "what plays is not told")
    expect(buttons["Answer A"].attribute("aria-disabled") == "true", "answers before two were felt")
    before = browser.run(BOXES)
    browser.press("b")
    session.action(2, 1)
    session.said("You feel B now. You can answer now: A or B.")
    expect(browser.run(BOXES) == before, "something moved when B began to play")
    expect(buttons["Feel B"].attribute("aria-pressed") == "true", "B plays and is not pressed")
    browser.press("Enter")
    session.said("Answer: which? A or B.")
    browser.press("Escape", "3")  # not an answer any more
    session.action(2, 2)
    browser.press("Enter", "x", "B")  # X is no answer
    session.action(3, 1)
    session.heading("After this practice trial")
    browser.press("Enter")
    session.action(0, 0)


def is_legible(session, browser, folder):
    session.heading("Which felt more like cutting liver?")
    browser.screen(1280, 720, "light", "reduce")
    session.button("Feel B").click()
    session.action(2, 1)
    browser.wait_for("B", "return document.querySelector('#plays').textContent.includes('B')")
    for scheme in ("light", "dark"):
        browser.screen(1280, 720, scheme, "reduce")
        expect(browser.run("return getComputedStyle(document.querySelector('#feel button')).transitionDuration") == "0s",
               "something moves where motion is not wanted")
        expect(browser.run("return document.scrollingElement.scrollHeight") <= 720, "a trial has to be scrolled")
        for it in browser.run(LOOKS):
            expect(it["contrast"] >= 7, f"{scheme}: {it}")
            expect(it["size"] >= 20, f"too small: {it}")
            expect(it["tag"] != "BUTTON" or min(it["height"], it["width"]) >= 96, f"hard to hit: {it}")
        browser.run("document.activeElement.blur()")
        browser.screenshot(folder / f"trial-{scheme}.png")
    widths = {it["width"] for it in browser.run(LOOKS) if it["text"].startswith("Feel")}
    expect(len(widths) == 1, f"slots of different widths: {widths}")
    for width, height in ((1024, 768), (768, 1024), (390, 800)):
        browser.screen(width, height)
        expect(browser.run("return document.scrollingElement.scrollWidth") <= width, f"too wide for {width}")
        browser.screenshot(folder / f"trial-{width}x{height}.png")
    browser.screen(1280, 720)
    session.button("Answer A").click()
    session.action(3, 0)


def waits_and_follows(session, browser, folder):
    session.heading("Time for a break")
    browser.wait_for("the count", "return /^You can go on in \\d+ s\\.$/.test(document.querySelector('#notice').textContent)")
    browser.screenshot(folder / "break.png")
    browser.wait_for("its end", "return document.querySelector('#go_on button').getAttribute('aria-disabled') === 'false'")
    session.said("You can go on.")
    browser.press("Enter")
    session.action(0, 0)
    session.heading("Which of the three was the odd one?")
    for label in "123":
        session.said(f"You feel {label} now.")
    session.said("You can answer now: 1, 2 or 3.")
    browser.screenshot(folder / "sequence.png")
    browser.press("3")
    session.action(3, 2)
    session.heading("Finished")
    browser.screenshot(folder / "finished.png")
    expect(not [it for it in browser.all("button") if it.name()], "buttons after the end")
    expect(session.demo.wait(timeout=20) == 0, "the session failed")


def tells_that_it_is_alone(session, browser):
    browser.open(session.url)
    session.heading("Welcome")
    browser.one("#stop").click()
    expect(browser.one("dialog").role() == "dialog", "no dialog")
    browser.press("Escape")
    session.demo.kill()
    session.demo.wait()
    browser.wait_for("the message", "return document.querySelector('#connection').textContent.includes('Connection lost')")
    expect(session.button("Continue").attribute("aria-disabled") == "true", "a button that leads nowhere")


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    if not webdriver.is_there():
        print("skipped: no chromium or chromedriver; scripts/set-up installs them")
        return 77
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = webdriver.Browser(profile)
        sessions = []
        try:
            browser.screen(1280, 720)
            session = Session(program, browser)
            sessions.append(session)
            refuses_strangers(session)
            browser.open(session.url)
            reads_texts(session, browser, folder)
            answers_by_keyboard(session, browser)
            is_legible(session, browser, folder)
            waits_and_follows(session, browser, folder)
            messages = browser.console()
            expect(not messages, f"the console has {messages}")
            sessions.append(Session(program, browser))
            tells_that_it_is_alone(sessions[-1], browser)
        finally:
            for session in sessions:
                session.demo.kill()
                session.demo.wait()
            browser.close()
    print("the page works")
    return 0


if __name__ == "__main__":
    sys.exit(main())
