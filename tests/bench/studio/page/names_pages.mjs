// Recordings of any name that a file system takes: listed, opened, opened again by their address, handed out, and given to verbs.

import { createHash } from "node:crypto";
import { copyFile, mkdir, readFile } from "node:fs/promises";
import { join } from "node:path";

import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

const names = [
  "a b.h5",
  " blank.h5",
  "#1.h5",
  "what?.h5",
  "100%.h5",
  "%41.h5",
  "a&b=c.h5",
  "a+b.h5",
  'it\'s "so".h5',
  "<b>bold<b>.h5",
  "<img src=x onerror=alert(1)>.h5",
  "{{token}}.h5",
  "back\\slash.h5",
  "Größe.h5",
  "切る 🔪.h5",
  "-dash.h5",
  "--help.h5",
  "day #2/50% & more.h5",
  `${"x".repeat(200)}.h5`,
];
const steering = ["two\nlines.h5", "bell\u0007.h5"];

/** What the studio calls a file, of its path in the folder. */
const idOf = (name) => createHash("sha256").update(name).digest("hex").slice(0, 16);

async function prepare(studio, all) {
  studio.record("cut.h5", 5);
  for (const name of all) {
    const place = Buffer.isBuffer(name)
      ? Buffer.concat([Buffer.from(`${studio.folder}/`), name])
      : join(studio.folder, name);
    if (String(name).includes("/")) await mkdir(join(place, ".."), { recursive: true });
    await copyFile(join(studio.folder, "cut.h5"), place);
  }
  await studio.serve();
}

async function open(page, studio, name) {
  await page.goto(studio.page(`recording/${idOf(name)}/time`));
  await page.waitForSelector(".time_plot");
}

const head = (page) => page.locator(".recording_head h1");

export const tests = {
  async AreListedAndOpenedAndComeBackByTheirAddress({ browser, studio }) {
    await prepare(studio, names);
    const page = await openPage(browser);
    const asked = [];
    page.on("dialog", (it) => asked.push(it.message()));
    for (const name of names) {
      await page.goto(studio.page("recordings"));
      await page.locator(`.recording_list a[href*="${idOf(name)}"]`).click();
      await page.waitForSelector(".time_plot");
      expectEqual(await head(page).textContent(), name, "the head");
      expectEqual(await page.title(), `${name.trim()}: Time – Kerf studio`, "the title");
      await page.reload();
      await page.waitForSelector(".time_plot");
      expectEqual(await head(page).textContent(), name, "the head after a reload");
      const row = page.locator('.side_list [aria-current="page"]');
      expectEqual(await row.getAttribute("title"), name, "what is marked in the list");
    }
    expectEqual(asked, [], "what a name has run");
    expectEqual(await page.locator("b, main img").count(), 0, "elements that a name has made");
    expectNoComplaints(page);
  },

  async AreToldWholeWhereTheyAreCut({ browser, studio, screenshots }) {
    const long = `${"a long name of a cut ".repeat(9)}.h5`.replaceAll(" ", "_");
    await prepare(studio, [long]);
    const page = await openPage(browser);
    await open(page, studio, long);
    const heading = page.locator(".recording_head h1");
    await until("the head can be reached", async () => (await heading.getAttribute("tabindex")) === "0");
    expectEqual(await heading.getAttribute("title"), long, "the head's title");
    const box = page.locator(".whole_text");
    const stem = long.replace(/\.h5$/, "");
    for (const reached of [heading, page.locator(".list_row").filter({ hasText: stem })]) {
      await page.locator(".list_search").focus();
      await page.keyboard.press("Tab"); // by the keyboard
      await reached.focus();
      await box.waitFor();
      expect((await box.textContent()).includes(stem), `${await box.textContent()} at what has the focus`);
      await page.screenshot({ path: join(screenshots, "whole_text.png") });
      await page.locator("#zero").focus();
      await box.waitFor({ state: "hidden" });
    }
    await page.setViewportSize({ width: 640, height: 360 });
    // Wherever an ellipsis is, what it stands for is told.
    for (const place of [`recording/${idOf(long)}/time`, `recording/${idOf(long)}/report`, "recordings", "scope"]) {
      await page.goto(studio.page(place));
      const untold = () =>
        page.evaluate(() => {
          const said = (it) => it.closest("[title]")?.title.includes(it.textContent.trim());
          const reached = (it) => it.closest("a, button, label, summary, [tabindex='0']");
          return [...document.querySelectorAll("main *, #side *")]
            .filter((it) => getComputedStyle(it).textOverflow === "ellipsis" && it.scrollWidth > it.clientWidth + 1)
            .filter((it) => !/reading/.test(it.className) && it.checkVisibility())
            .filter((it) => !said(it) || !reached(it))
            .map((it) => `${it.className}: ${it.textContent}`);
        });
      await until(`${place}: all is told`, async () => (await untold()).length === 0).catch(async () =>
        expectEqual(await untold(), [], `what is cut without a word at ${place}`),
      );
    }
    expectNoComplaints(page);
  },

  async AreHandedOutUnderNamesThatEveryFileSystemTakes({ browser, studio }) {
    await prepare(studio, names);
    const page = await openPage(browser);
    for (const name of names) {
      await open(page, studio, name);
      await page.locator(".out summary").first().click();
      const csv = page.locator(".out").first().getByRole("button", { name: "CSV", exact: true });
      const [download] = await Promise.all([page.waitForEvent("download"), csv.click()]);
      const given = download.suggestedFilename();
      expect(/^[A-Za-z0-9][A-Za-z0-9_-]*\.csv$/.test(given) && given.length <= 64, `${name} is handed out as ${given}`);
      const lines = (await readFile(await download.path(), "utf8")).trimEnd().split("\r\n");
      expect(lines.length > 100 && lines[0].startsWith("time"), `${name}: ${lines.length} lines, ${lines[0]}`);
    }
    expectNoComplaints(page);
  },

  async AreGivenToVerbsAsFilesAndNotAsOptions({ studio }) {
    await prepare(studio, names);
    for (const name of names) {
      const asked = await studio.api("/api/verbs/run", { verb: "info", values: { recording: name } });
      expectEqual(asked.status, 200, `${name}: ${JSON.stringify(asked.json)}`);
    }
    const jobs = await until(
      "all have ended",
      async () => {
        const all = (await studio.api("/api/jobs")).json.jobs ?? (await studio.api("/api/jobs")).json;
        return all.length === names.length && all.every((it) => it.state === "done" || it.state === "failed")
          ? all
          : null;
      },
      60000,
    );
    for (const job of jobs) expectEqual([job.state, job.error], ["done", ""], job.title);
  },

  async HaveCharactersThatSteerATerminalShownAsNumbers({ browser, studio }) {
    await prepare(studio, steering);
    const page = await openPage(browser);
    for (const name of steering) {
      await open(page, studio, name);
      await page.reload();
      await page.waitForSelector(".time_plot");
    }
    expectEqual(await head(page).textContent(), "bell\\u0007.h5", "a bell");
    expectNoComplaints(page);
  },

  async ThatAreNoTextAreListedBesideTheOthers({ browser, studio }) {
    const name = Buffer.from([0x63, 0xff, 0x2e, 0x68, 0x35]); // "c?.h5", no UTF-8
    await prepare(studio, [name]);
    const page = await openPage(browser);
    await page.goto(studio.page("recordings"));
    await until("both are listed", async () => (await page.locator(".recording_list tbody tr").count()) === 2);
    await open(page, studio, name);
    expectEqual(await head(page).textContent(), "c\ufffd.h5", "the head");
    expectNoComplaints(page);
  },
};
