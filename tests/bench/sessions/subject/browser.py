"""A browser by WebDriver (W3C), with nothing but Python: Debian's chromium and chromium-driver."""

import base64
import json
import os
import re
import shutil
import subprocess
import time
import urllib.error
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
KEYS = {"Enter": "\ue007", "Escape": "\ue00c", "Tab": "\ue004", "Space": " ",
        "Backspace": "\ue003", "ArrowLeft": "\ue012", "ArrowRight": "\ue014", "End": "\ue010"}
DIRECT = urllib.request.build_opener(urllib.request.ProxyHandler({}))


def is_there():
    return shutil.which("chromium") and shutil.which("chromedriver")


class Element:
    def __init__(self, browser, reference):
        self.browser, self.path = browser, f"/element/{reference}"

    def click(self):
        self.browser.command("POST", self.path + "/click", {})

    def role(self):
        return self.browser.command("GET", self.path + "/computedrole")

    def name(self):
        return self.browser.command("GET", self.path + "/computedlabel")

    def text(self):
        return self.browser.command("GET", self.path + "/text")

    def attribute(self, name):
        return self.browser.command("GET", f"{self.path}/attribute/{name}")


class Browser:
    def __init__(self, profile):
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                       text=True)
        for line in self.driver.stdout:
            if found := re.search(r"successfully on port (\d+)", line):
                break
        self.base = f"http://127.0.0.1:{found[1]}/session"
        arguments = ["--headless=new", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run", "--no-proxy-server",
                     "--disable-background-networking", "--disable-extensions", f"--user-data-dir={profile}"]
        if os.geteuid() == 0:
            arguments.append("--no-sandbox")
        options = {"browserName": "chrome", "goog:loggingPrefs": {"browser": "ALL"},
                   "goog:chromeOptions": {"binary": shutil.which("chromium"), "args": arguments}}
        answer = self._send("POST", "", {"capabilities": {"alwaysMatch": options}})
        self.base += "/" + answer["sessionId"]

    def _send(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with DIRECT.open(request, timeout=30) as response:
                return json.load(response)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(f"{method} {path}: {json.load(error)['value']['message'].splitlines()[0]}") from None

    def command(self, method, path, body=None):
        return self._send(method, path, body)

    def devtools(self, command, **parameters):
        return self._send("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def open(self, url):
        self._send("POST", "/url", {"url": url})

    def all(self, selector):
        found = self._send("POST", "/elements", {"using": "css selector", "value": selector})
        return [Element(self, it[ELEMENT]) for it in found]

    def one(self, selector):
        return self.all(selector)[0]

    def focused(self):
        return Element(self, self._send("GET", "/element/active")[ELEMENT])

    def run(self, script, *arguments):
        return self._send("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def press(self, *keys):
        actions = []
        for key in keys:
            value = KEYS.get(key, key)
            actions += [{"type": "keyDown", "value": value}, {"type": "keyUp", "value": value}]
        self._send("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def screen(self, width, height, scheme="light", motion="no-preference"):
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.devtools("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": scheme}, {"name": "prefers-reduced-motion", "value": motion}])

    def screenshot(self, file):
        with open(file, "wb") as stream:
            stream.write(base64.b64decode(self._send("GET", "/screenshot")))

    def console(self):
        return self._send("POST", "/se/log", {"type": "browser"})

    def wait_for(self, what, script, *arguments):
        """Until the script gives something true; a page that never gets there is the failure."""
        end = time.monotonic() + 20
        while not (value := self.run(script, *arguments)):
            if time.monotonic() > end:
                raise AssertionError(f"waited in vain for {what}; the page says: {self.one('body').text()!r}")
            time.sleep(0.01)
        return value

    def close(self):
        try:
            self._send("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait()
