"""The subject's page in German, in a browser: german_page_test.py DEMO FOLDER, where the screenshots go.

Goes through the screens with the longest words by keyboard, and asks on each, on a wide and on a small screen, that nothing
of them is cut off, lies over another, or is English. Exit status 77 (skipped) without a browser.
"""

import pathlib
import sys
import tempfile

sys.dont_write_bytecode = True  # nothing beside the sources
import browser as webdriver  # noqa: E402
from page_browser_test import MESSAGES, OVERFLOWS, Session, expect  # noqa: E402

SCREENS = ((1280, 800), (800, 600))
ENGLISH = ["Trial", "trial", "Continue", "Answer", "Feel", "You ", "Stop", "agree", "Keys", "Please", "Welcome"]


class German(Session):
    arguments = ("de",)

    def looks_well(self, folder, name):
        for width, height in SCREENS:
            self.browser.screen(width, height)
            self.browser.run("document.activeElement.blur(); window.scrollTo(0, 0)")
            self.browser.screenshot(folder / f"german-{name}-{width}x{height}.png")
            expect(self.browser.run("return document.scrollingElement.scrollWidth") <= width, f"{name}: too wide for {width}")
            expect(self.browser.run("return document.querySelector('#notice').getBoundingClientRect().bottom <= innerHeight"),
                   f"{name}: what is refused cannot be seen at {width}x{height}")
            found = self.browser.run(OVERFLOWS)
            expect(not found, f"{name} at {width}x{height}: {found}")
        words = self.browser.run("return document.body.innerText")
        for english in ENGLISH:
            expect(english not in words, f"{name} says {english!r} in {words!r}")


def sets_noise_and_agrees(session, browser, folder):
    session.heading("Willkommen")
    browser.run(MESSAGES)
    expect(browser.run("return document.documentElement.lang") == "de", "the language is not told")
    session.looks_well(folder, "noise")
    session.button("Rauschen anhören").click()
    session.button("Diese Lautstärke übernehmen").click()
    browser.wait_for("the noise to be set", "return document.querySelector('#noise').hidden")
    session.button("Weiter").click()
    session.action(0, 0)
    session.heading("Ihre Einwilligung")
    session.looks_well(folder, "consent")
    session.button("Ich willige ein").click()
    session.action(0, 0)


def answers_a_free_trial(session, browser, folder):
    session.heading("Welches von beiden ist X?")
    session.said("Übungsdurchgang 1 von etwa 24. Sie fühlen jetzt A.")
    names = [it.name() for it in browser.all("main button") if it.name()]
    expect(names == ["A fühlen", "B fühlen", "X fühlen", "Antwort A", "Antwort B", "Ich habe mich vertan"], f"buttons: {names}")
    browser.press("b")
    session.action(2, 1)
    session.said("Sie können jetzt antworten: A oder B.")
    session.looks_well(folder, "trial")
    expect(browser.one("#keys").text() == "Tasten: A, B oder X zum Fühlen, Eingabetaste zum Antworten. S: Ich habe mich vertan.",
           "other keys than there are")
    browser.press("Enter", "2")
    session.action(3, 1)


def answers_in_words(session, browser, folder):
    session.heading("War es die steifere der beiden Proben?")
    browser.wait_for("answers", "return document.querySelector('#answer_row button').getAttribute('aria-disabled') === 'false'")
    names = [it.name() for it in browser.all("#answer_row button")]
    expect(names[1] == "2 nein, ziemlich sicher" and len(names) == 6, f"answers: {names}")
    session.looks_well(folder, "confidence")
    browser.press("2")
    session.action(3, 1)


def takes_a_break(session, browser, folder):
    session.heading("Zeit für eine Pause")
    browser.wait_for("the count", r"return /^In \d+ s können Sie weitermachen\.$/.test(document.querySelector('#notice').textContent)")
    session.looks_well(folder, "break")


def stops(session, browser, folder):
    browser.one("#stop").click()
    for width, height in SCREENS:
        browser.screen(width, height)
        browser.screenshot(folder / f"german-stop-{width}x{height}.png")
        cut = browser.run("return [...document.querySelectorAll('dialog *')].filter((it) => it.scrollWidth > it.clientWidth + 1).length")
        expect(not cut, "the question whether to stop is cut off")
    browser.one("#stop_yes").click()
    session.action(4, 0)


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    if not webdriver.is_there():
        print("skipped: no chromium or chromedriver; scripts/set-up installs them")
        return 77
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = webdriver.Browser(profile)
        session = German(program, browser)
        try:
            browser.screen(*SCREENS[0])
            browser.open(session.url)
            for part in (sets_noise_and_agrees, answers_a_free_trial, answers_in_words, takes_a_break):
                part(session, browser, folder)
            # Ahead of the end, at which the demo leaves the page alone.
            messages = [it for it in browser.console() if "AudioContext" not in it["message"]]
            expect(not messages, f"the console has {messages}")
            stops(session, browser, folder)
        finally:
            session.demo.kill()
            session.demo.wait()
            browser.close()
    print("the page speaks German")
    return 0


if __name__ == "__main__":
    sys.exit(main())
