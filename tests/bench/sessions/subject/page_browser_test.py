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
import time
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
return [...document.querySelectorAll('button, .tile, h1, p, .end')].filter(visible).filter((it) => it.textContent.trim()).map((it) => {
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
OVERFLOWS = """
const seen = (it) => it.getClientRects().length && it.getBoundingClientRect().width > 1;
const parts = [...document.querySelectorAll('button, .tile, h1, p, label, .end, #number')].filter(seen)
  .filter((it) => it.textContent.trim() || it.id === 'number');
const boxes = parts.map((it) => it.getBoundingClientRect());
const found = [];
parts.forEach((it, i) => {
  const box = boxes[i];
  const name = `${it.tagName} ${it.textContent.trim()}`;
  if (it.scrollWidth > it.clientWidth + 1 || it.scrollHeight > it.clientHeight + 1) found.push(`${name}: cut off`);
  if (box.left < 0 || box.right > innerWidth) found.push(`${name}: beside the screen`);
  parts.forEach((other, j) => {
    if (j <= i || it.contains(other) || other.contains(it)) return;
    const covered = Math.min(box.right, boxes[j].right) - Math.max(box.left, boxes[j].left);
    const deep = Math.min(box.bottom, boxes[j].bottom) - Math.max(box.top, boxes[j].top);
    if (covered > 1 && deep > 1) found.push(`${name}: lies over ${other.textContent.trim()}`);
  });
});
return found;
"""
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

    arguments = ()

    def __init__(self, program, browser, *arguments):
        self.demo = subprocess.Popen([program, *(arguments or self.arguments)], stdout=subprocess.PIPE, text=True)
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


def takes_numbers(session, browser, folder):
    session.heading("How strong was it?")
    session.said("You can answer now: a number above 0.")
    browser.wait_for("the field", "return document.activeElement.id === 'number'")
    expect(session.button("Answer").attribute("aria-disabled") == "true", "answers before a number is written")
    browser.press("Enter", *"0", "Enter")  # neither is a number above 0
    session.said("That number cannot be.")
    browser.press("Backspace", *"12,5")
    browser.screenshot(folder / "magnitude.png")
    browser.press("Enter")
    session.action(3, "0 12.5")

    session.heading("How real was it?")
    browser.wait_for("the line", "return document.activeElement.type === 'range'")
    expect(session.button("Answer").attribute("aria-disabled") == "true", "answers before the mark was moved")
    browser.press("Enter", "ArrowRight", "ArrowRight")
    expect(browser.run("return document.scrollingElement.scrollHeight") <= 720, "a line has to be scrolled to")
    browser.screenshot(folder / "line.png")
    for width in (1280, 390):
        browser.screen(width, 800)
        expect(browser.run("return document.scrollingElement.scrollWidth") <= width, f"a line too wide for {width}")
    browser.screen(1280, 720, "light", "reduce")  # what fades in is not legible yet
    session.button("Answer").click()
    session.action(3, "0 52")

    session.heading("How real was it, in steps?")
    session.said("You can answer now: 1 (not at all), 2, 3, 4 or 5 (exactly).")
    tops = browser.run("return [...document.querySelectorAll('#answer_row button')].map((it) => it.getBoundingClientRect().top)")
    expect(len(tops) == 5 and len(set(tops)) == 1, f"steps that do not stand in a row: {tops}")
    expect(all(it["contrast"] >= 7 and it["size"] >= 20 for it in browser.run(LOOKS)), "steps are hard to read")
    browser.screenshot(folder / "steps.png")
    browser.press("4")
    session.action(3, 3)


def ends(session, browser, folder):
    session.heading("Finished")
    browser.screenshot(folder / "finished.png")
    expect(not [it for it in browser.all("button") if it.name()], "buttons after the end")
    expect(session.demo.wait(timeout=20) == 0, "the session failed")


WHERE = """
const middle = (name) => {
  const box = document.querySelector('#guide .' + name).getBoundingClientRect();
  return [box.x + box.width / 2, box.y + box.height / 2];
};
return [middle('target'), middle('tool'), document.querySelector('#guide .track').getBoundingClientRect().width];
"""
MAY_ANSWER = "return document.querySelector('#answer button').getAttribute('aria-disabled') === 'false'"
OVERLAPS = """
const boxes = [...document.querySelectorAll('h1, #guide, #feel_row, #plays, #answer_row, #notice, footer')]
  .filter((it) => it.getClientRects().length).map((it) => [it.id || it.tagName, it.getBoundingClientRect()]);
return boxes.slice(1).filter(([, box], i) => box.top < boxes[i][1].bottom - 1).map(([name], i) => name);
"""


def leads_by_a_target(session, browser, folder):
    browser.screen(1280, 720, "light", "reduce")
    browser.open(session.url)
    session.heading("What you will do")
    expect(browser.run("return document.querySelector('#guide').hidden"), "a target is shown among texts")
    browser.press("Enter")
    session.action(0, 0)
    session.heading("The next trial")
    browser.wait_for("the ring", "return !document.querySelector('#guide .target').classList.contains('unknown')")
    browser.press("Enter")
    session.action(0, 0)
    session.heading("Which felt more like cutting liver?")
    before = browser.run(BOXES)
    seen = watched(browser)
    way = 0.76 * seen[0][2]
    targets, tools = [it[0][0] for it in seen], [it[1][0] for it in seen]
    expect(max(targets) - min(targets) > 0.95 * way, f"the ring went {max(targets) - min(targets):.0f} of {way:.0f} px")
    expect(0.8 * way < max(tools) - min(tools) < 0.95 * way, f"the bar went {max(tools) - min(tools):.0f} px")
    expect(max(abs(it[0][1] - it[1][1]) for it in seen) < 2, "bar and ring are not at one height")
    expect(browser.run(BOXES) == before, "something moved but the target")
    for scheme in ("light", "dark"):
        browser.screen(1280, 720, scheme, "reduce")
        expect(browser.run("return document.scrollingElement.scrollHeight") <= 720, "a trial has to be scrolled")
        expect(not browser.run(OVERLAPS), f"parts lie on each other: {browser.run(OVERLAPS)}")
        for it in browser.run(LOOKS):
            expect(it["contrast"] >= 7 and it["size"] >= 20, f"{scheme}: {it}")
        browser.run("document.activeElement.blur()")
        browser.screenshot(folder / f"target-{scheme}.png")
    for width, height in ((1024, 768), (390, 844)):
        browser.screen(width, height)
        expect(browser.run("return document.scrollingElement.scrollWidth") <= width, f"too wide for {width}")
        expect(not browser.run(OVERLAPS), f"parts lie on each other at {width}: {browser.run(OVERLAPS)}")
        browser.screenshot(folder / f"target-{width}x{height}.png")
    browser.screen(1280, 720)
    browser.press("b")
    session.action(2, 1)
    browser.wait_for("the answers", MAY_ANSWER)
    messages = browser.console()  # while the server is there: at the end it goes, whoever looks at the target just then
    expect(not messages, f"the console has {messages}")
    browser.press("Enter", "a")
    session.action(3, 0)
    session.heading("Finished")
    expect(browser.run("return document.querySelector('#guide').hidden"), "a target is shown after the end")


def watched(browser):
    """Where ring and bar are, for longer than a cycle."""
    seen = []
    end = time.monotonic() + 2.6
    while time.monotonic() < end:
        seen.append(browser.run(WHERE))
    return seen


def leads_by_a_beat(session, browser, folder):
    browser.screen(1280, 720, "light", "reduce")
    browser.open(session.url)
    session.heading("What you will do")
    browser.press("Enter")
    session.action(0, 0)
    session.heading("The next trial")
    flash = "return document.querySelector('#guide .beat').classList.contains('sounds')"
    browser.wait_for("a beat", flash)
    browser.wait_for("its end", flash.replace("return ", "return !"))
    browser.press("Enter")
    session.action(0, 0)
    session.heading("Which felt more like cutting liver?")
    browser.wait_for("a beat", flash)
    browser.screenshot(folder / "beat.png")
    expect(not browser.run(OVERLAPS), f"parts lie on each other: {browser.run(OVERLAPS)}")
    browser.press("b")
    session.action(2, 1)
    browser.wait_for("the answers", MAY_ANSWER)
    messages = browser.console()  # while the server is there: at the end it goes, whoever looks at the target just then
    expect(not messages, f"the console has {messages}")
    browser.press("Enter", "a")
    session.action(3, 0)
    session.heading("Finished")


ENGLISH = {"name": "english", "trial": "Which one is X?", "heading": "A question", "progress": "Question {} of 3",
           "give": "Answer", "end": "Finished", "items": (
               ("How mentally demanding was the task?", "Very low to Very high"),
               ("How successful were you in accomplishing what you were asked to do?", "Perfect to Failure"),
               ("How much was what you felt like the cutting of tissue that you know from your daily work?",
                "not at all like the tissue that I know to not to be told from the tissue I know"))}
GERMAN = {"name": "german", "trial": "Welches von beiden ist X?", "heading": "Eine Frage", "progress": "Frage {} von 3",
          "give": "Antworten", "end": "Ende", "items": (
              ("Wie hoch waren die geistigen Anforderungen der Aufgabe?", "Sehr gering bis Sehr hoch"),
              ("Wie gut ist Ihnen gelungen, worum Sie gebeten wurden?", "Perfekt bis Misslungen"),
              ("Wie sehr glich das, was Sie fühlten, dem Schneiden von Gewebe, wie Sie es aus Ihrer täglichen Arbeit kennen?",
               "überhaupt nicht wie wirkliches Gewebe bis ununterscheidbar von wirklichem Gewebe"))}


def fills_a_questionnaire(session, browser, folder, words):
    browser.screen(1280, 720, "light", "reduce")
    browser.open(session.url)
    session.heading(words["trial"])
    browser.press("b")
    session.action(2, 1)
    browser.wait_for("the answers", MAY_ANSWER)
    browser.press("Enter", "a")
    session.action(3, 0)
    # By keyboard alone; by arrows and the button; by the mouse alone, at the middle where the mark stands already.
    shows_an_item(session, browser, folder, words, 1)
    browser.press("ArrowRight", "Enter")
    session.action(3, "0 55")
    shows_an_item(session, browser, folder, words, 2)
    browser.press("ArrowLeft", "ArrowLeft")
    session.button(words["give"]).click()
    session.action(3, "0 40")
    shows_an_item(session, browser, folder, words, 3)
    browser.one("#number").click()
    expect(session.button(words["give"]).attribute("aria-disabled") == "false", "a click on the mark does not set it")
    session.button(words["give"]).click()
    session.action(3, "0 50")
    session.heading(words["end"])
    expect(browser.run("return document.querySelector('#answer').hidden"), "a line after the last question")


def shows_an_item(session, browser, folder, words, number):
    question, line = words["items"][number - 1]
    browser.wait_for(f"question {number}", "return document.querySelector('#text').textContent === arguments[0]", question)
    session.heading(words["heading"])
    expect(browser.one("#progress").text() == words["progress"].format(number), f"progress: {browser.one('#progress').text()}")
    mark = browser.focused()
    expect(mark.attribute("id") == "number" and mark.role() == "slider", f"of question {number} the focus is not on its line")
    outline = browser.run("return getComputedStyle(document.activeElement).outlineWidth")
    expect(float(outline.removesuffix("px")) >= 3, f"the focus on the line is hard to see: {outline}")
    expect(mark.name() == line, f"a screen reader is told {mark.name()!r}")
    described = browser.run("return document.getElementById(document.activeElement.getAttribute('aria-describedby')).textContent")
    expect(described == question, f"a screen reader is asked {described!r}")
    give = session.button(words["give"])
    expect(give.attribute("aria-disabled") == "true", "answers before the mark was set")
    browser.press("Enter")  # neither is an answer: the next action is the one that is looked for
    give.click()
    mark_again = "document.querySelector('#number').focus()"
    for scheme, width, height in (("light", 1280, 720), ("dark", 1280, 720), ("light", 800, 600), ("light", 390, 844)):
        browser.screen(width, height, scheme, "reduce")
        where = f"question {number}, {words['name']}, {width}x{height}, {scheme}"
        expect(browser.run("return document.scrollingElement.scrollWidth") <= width, f"{where}: too wide")
        expect(browser.run("return document.querySelector('#number').getBoundingClientRect().bottom <= innerHeight"),
               f"{where}: the line has to be scrolled to")
        expect(not browser.run(OVERFLOWS), f"{where}: {browser.run(OVERFLOWS)}")
        for it in browser.run(LOOKS):
            expect(it["contrast"] >= 7 and it["size"] >= 20, f"{where}: {it}")
        browser.run(mark_again)
        browser.screenshot(folder / f"questionnaire-{words['name']}-{number}-{width}x{height}-{scheme}.png")
    browser.screen(1280, 720, "light", "reduce")
    expect(give.attribute("aria-disabled") == "true", "answers though the mark was not set")
    browser.run(mark_again)


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
            takes_numbers(session, browser, folder)
            ends(session, browser, folder)
            messages = browser.console()
            expect(not messages, f"the console has {messages}")
            for kind, leads in (("target", leads_by_a_target), ("metronome", leads_by_a_beat)):
                sessions.append(Session(program, browser, kind))
                leads(sessions[-1], browser, folder)
                browser.console()
            for arguments, words in (((), ENGLISH), (("de",), GERMAN)):
                sessions.append(Session(program, browser, "questionnaire", *arguments))
                fills_a_questionnaire(sessions[-1], browser, folder, words)
                browser.console()
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
