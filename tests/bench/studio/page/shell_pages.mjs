// What is around every page: the address that holds what is seen, tabs, the list at the left, commands and keys, and how much
// of the window is left to the data.

import { copyFile, mkdir, readFile, rename, rm, utimes, writeFile } from "node:fs/promises";
import { join } from "node:path";

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

const tabs = ["time", "loop", "cycles", "law", "fits", "chart", "report"];

async function prepare({ browser, studio }, options = {}) {
  if (!studio.process) {
    studio.record("cut.h5", 20);
    studio.kerfOrThrow("record", "--device", "sim:scissors?seed=7", "--seconds", "10", "--virtual", "-o", "other.h5");
    studio.kerfOrThrow("segment", "other.h5");
    await studio.serve();
  }
  return openPage(browser, options);
}

const hash = (page) => page.evaluate(() => location.hash);
const reading = (page) => page.textContent(".time_reading");
const isShown = (page, tab) => page.waitForSelector(`#tab_${tab}[aria-selected=true]`);
const rows = (page) => page.locator(".side_list .list_name bdi").allTextContents();

async function open(page, studio, name, rest = "time") {
  await page.goto(studio.page(`recording/${await studio.id("recordings", name)}/${rest}`));
  await until(`${name} is open`, async () => (await page.textContent("h1")) === name);
}

/** What axe finds, a line each. */
async function axe(page, source) {
  await page.evaluate(source);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  return violations.flatMap((it) => it.nodes.map((node) => `${it.id}: ${node.html.slice(0, 160)}`));
}

export const tests = {
  async "the address holds what is seen: a link opens it again, back and forward go through it"({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await open(page, studio, "cut.h5");
    const other = await studio.id("recordings", "other.h5");
    await page.click('.tab_tools summary:has-text("Laid over")');
    await page.selectOption(".overlay select", other);
    await until("the overlay is in the address", async () => (await hash(page)).includes(`over=${other}`));
    await page.focus(".time_focus");
    for (let i = 0; i < 3; ++i) await page.keyboard.press("+");
    await until("so is the stretch", async () => /from=[\d.]+&to=[\d.]+/.test(await hash(page)));
    await until("and at rest", async () => {
      const before = await hash(page);
      await page.waitForTimeout(400);
      return before === (await hash(page));
    });
    const [seen, address] = [await reading(page), page.url()];
    await page.click("#tab_loop");
    await page.selectOption(".recording_loops select >> nth=0", "one");
    await page.focus(".loops_frame svg.xy_plot");
    await page.keyboard.press("]");
    await until("the cycle is in the address", async () => (await hash(page)).includes("cycle=2"));
    const loop = page.url();

    await page.goBack();
    await until("all cycles again", async () => !(await hash(page)).includes("loops="));
    expectEqual(await page.locator(".recording_loops select").first().inputValue(), "all", "what is drawn");
    await page.goBack();
    await isShown(page, "time");
    await until("the stretch is the one before", async () => (await reading(page)) === seen);
    await page.goForward();
    await page.goForward();
    await isShown(page, "loop");
    await until("the cycle is back", async () => (await page.textContent(".loops_text")).startsWith("Cycle 2 of"));

    for (const [link, isThere] of [
      [address, async (it) => (await reading(it)) === seen && (await it.locator(".overlay_list li").count()) === 1],
      [loop, async (it) => (await it.textContent(".loops_text")).startsWith("Cycle 2 of")],
    ]) {
      const another = await prepare({ browser, studio });
      await another.goto(link);
      await another.waitForSelector(".tab_panel > *");
      await until(`${link} shows the same`, () => isThere(another));
      expectNoComplaints(another);
    }
    expectNoComplaints(page);
  },

  async "addresses of earlier versions lead to the tabs that their pages have become"({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const id = await studio.id("recordings", "cut.h5");
    studio.kerfOrThrow("fit", "cut.h5", "--models", "kelvin", "-o", "cut.fit");
    const fit = await studio.id("files", "cut.fit/fit.json");
    for (const [old, tab, key] of [
      [`recordings/${id}`, "time", ""],
      [`editor/${id}`, "law", ""],
      [`fits/${id}`, "fits", ""],
      [`chart/${id}`, "chart", ""],
      [`fits/${fit}`, "fits", `fit=${fit}`],
    ]) {
      await page.goto("about:blank");
      await page.goto(studio.page(old));
      await isShown(page, tab);
      await until(`${old} is of the recording`, async () => (await page.textContent("h1")) === "cut.h5");
      expect((await hash(page)).includes(key), `${await hash(page)} has ${key}`);
    }
    await page.waitForSelector("table.fits");
    studio.record("elsewhere.h5", 10);
    studio.kerfOrThrow("fit", "elsewhere.h5", "--models", "kelvin", "-o", "elsewhere.fit");
    await rm(join(studio.folder, "elsewhere.h5"));
    const another = await studio.id("files", "elsewhere.fit/fit.json");
    await page.goto(studio.page(`fits/${another}`));
    await page.waitForSelector("table.fits");
    expectEqual(await page.textContent("h1"), "elsewhere.fit", "a fit of no recording of the folder, by itself");
    for (const [list, names] of [
      ["fits", ["cut.fit", "elsewhere.fit"]],
      ["chart", []],
    ]) {
      await page.goto(studio.page(list));
      await page.waitForSelector("main section.card");
      expectEqual(await page.locator("main .links a").allTextContents(), names, `what ${list} lists`);
      expectEqual(await page.locator("main form").count(), 0, "forms are in the tabs of recordings");
    }
    expectNoComplaints(page);
  },

  async "tabs are changed by keys, and none of them loses what another shows"({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await open(page, studio, "cut.h5", "time?from=2&to=5");
    for (const [k, tab] of tabs.entries()) {
      await page.keyboard.press(String(k + 1));
      await isShown(page, tab);
      await page.waitForSelector(".tab_panel > *");
      expect((await hash(page)).includes("from=2&to=5"), `${tab}: ${await hash(page)}`);
    }
    await page.focus("#tab_report");
    await page.keyboard.press("Home");
    await isShown(page, "time");
    await page.keyboard.press("ArrowRight");
    await isShown(page, "loop");
    expectEqual(await page.evaluate(() => document.activeElement.id), "tab_loop", "what has the focus");
    expectNoComplaints(page);
  },

  async "ages in the list go on, and rows stay what they are"({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await page.clock.install();
    await page.goto(studio.page("work"));
    const row = page.locator(".list_row").first();
    await row.focus();
    await page.clock.fastForward("07:00");
    await row.getByText(/· [67] min ago/).waitFor();
    await page.clock.fastForward("05:00");
    await row.getByText(/· 1[12] min ago/).waitFor();
    expect(await row.evaluate((it) => it === document.activeElement), "what has the focus keeps it");
    expectNoComplaints(page);
  },

  async "the list is searched, sorted and marked, and follows the folder"({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await page.goto(studio.page("scope"));
    await until("both are listed", async () => (await rows(page)).length === 2);
    await until("thumbnails are drawn", () =>
      page.evaluate(() =>
        [...document.querySelectorAll(".thumbnail")].every((it) => {
          const { data } = it.getContext("2d").getImageData(0, 0, it.width, it.height);
          return data.some((value, k) => k % 4 === 3 && value > 0);
        }),
      ),
    );
    await page.selectOption(".list_tools select", "longest");
    expectEqual(await rows(page), ["cut", "other"], "the longest first");
    await page.selectOption(".list_tools select", "name");
    await page.fill(".list_search", "oth");
    expectEqual(await rows(page), ["other"], "what the search leaves");
    await page.fill(".list_search", "");
    studio.kerfOrThrow("fit", "cut.h5", "--models", "kelvin", "-o", "cut.fit");
    studio.kerfOrThrow("chart", "cut.h5", "--laws", "kelvin", "-o", "cut.chart");
    await copyFile(join(studio.folder, "cut.h5"), join(studio.folder, "third.h5"));
    await until("a new one is listed without a reload", async () => (await rows(page)).includes("third"));
    await until("and the fit marks its recording", async () =>
      (await page.locator(".list_row", { hasText: "cut" }).textContent()).includes("fit"),
    );
    await until("its marks and its flag are whole", () =>
      page.evaluate(() => {
        const marks = [...document.querySelectorAll(".list_row .mark_badge")];
        const isSeen = (it) => {
          const { right, top, height } = it.getBoundingClientRect();
          return document.elementFromPoint(right - 3, top + height / 2) === it;
        };
        const all = marks.map((it) => it.textContent).join(" ");
        return ["fit", "chart", "⚑ 1"].every((wanted) => all.includes(wanted)) && marks.every(isSeen);
      }),
    );
    await page.focus(".list_search");
    for (const key of ["ArrowDown", "ArrowDown", "ArrowDown", "Enter"]) await page.keyboard.press(key);
    await until("the third line is open", async () => (await page.textContent("h1")) === "third.h5");
    await page.waitForSelector('.list_row[aria-current=page]:has-text("third")');
    const says = (words) => until(words, async () => (await page.textContent("#notice")) === `third.h5 ${words}`);
    studio.kerfOrThrow("segment", "third.h5", "--corner", "15");
    await says("has changed in the folder, and was read anew.");
    await page.click("#notice_close");
    await utimes(join(studio.folder, "third.h5"), 1e9, 1e9); // as what is written after the clock was set back
    await says("has changed in the folder, and was read anew.");
    await page.keyboard.press("3"); // Cycles, where somebody may be at work
    await page.waitForSelector("#tab_cycles[aria-selected=true]");
    await utimes(join(studio.folder, "third.h5"), 1.1e9, 1.1e9);
    await says("has changed in the folder: press R to read it anew.");
    await page.keyboard.press("r");
    await until("it is read anew", () => page.locator("#notice_strip").isHidden());
    await page.keyboard.press("2");
    await page.waitForSelector("#tab_loop[aria-selected=true]");
    const file = join(studio.folder, "third.h5");
    await rename(file, `${file}.away`);
    await says("is not in the folder any more: what is shown was read before.");
    const whole = await readFile(`${file}.away`);
    await writeFile(file, whole.subarray(0, whole.length / 2));
    await says("is damaged, and cannot be read any more: what is shown was read before.");
    await until("one that is damaged stays in the list", async () =>
      (await page.locator(".list_row", { hasText: "third" }).textContent()).includes("unreadable"),
    );
    await rename(`${file}.away`, file);
    await until("one that is back is read, and nothing is said", () => page.locator("#notice_strip").isHidden());
    await page.waitForSelector(".tab_loop svg, .tab_loop canvas");
    await rm(file);
    await until("one that is gone leaves the list", async () => !(await rows(page)).includes("third"));
    await until("the page says so", async () =>
      (await page.textContent("#notice")).startsWith("third.h5 is not in the folder any more"),
    );
    await page.click("#notice_close");
    expect(await page.locator("#notice_strip").isHidden(), "the message can be put away");
    expectNoComplaints(page, [/404/]);
  },

  async "five thousand recordings are listed, and only those in sight are drawn"({ browser, studio }) {
    studio.kerfOrThrow("record", "--device", "sim:scissors", "--seconds", "0.1", "--virtual", "-o", "r.h5");
    for (let k = 1; k <= 5000; ++k)
      await copyFile(join(studio.folder, "r.h5"), join(studio.folder, `r${String(k).padStart(4, "0")}.h5`));
    await rm(join(studio.folder, "r.h5"));
    await studio.serve();
    const page = await openPage(browser);
    await page.goto(studio.page("scope"));
    await until("all are counted", async () => (await page.textContent(".list_count")).startsWith("5,000 recordings"));
    expect((await page.locator(".list_row").count()) < 60, "only some are drawn");
    await page.selectOption(".list_tools select", "name");
    await page.locator(".list_row").first().focus();
    await page.keyboard.press("End");
    await until("the last one has the focus", async () =>
      (await page.evaluate(() => document.activeElement.textContent)).includes("r5000"),
    );
    const place = await page.evaluate(() => document.activeElement.parentElement.getAttribute("aria-posinset"));
    expectEqual(place, "5000", "where it stands");
    await page.keyboard.press("Enter");
    await until("it opens though nobody had looked into it", async () => (await page.textContent("h1")) === "r5000.h5");
    expectNoComplaints(page);
  },

  async "a studio that is silent for ten seconds is said to be, and all goes on without a reload"({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await open(page, studio, "cut.h5");
    const seen = await reading(page);
    studio.process.kill("SIGSTOP");
    await page.keyboard.press("2");
    await isShown(page, "loop");
    await page.getByText("No answer from the studio").waitFor();
    await page.keyboard.press("1"); // another wish, before the first has been answered
    await page.waitForTimeout(10_000);
    studio.process.kill("SIGCONT");
    await until("what was wished for last is there", async () => (await reading(page)) === seen);
    await until("the bar has an answer", async () => (await page.getByText("No answer").count()) === 0);
    await page.keyboard.press("2");
    await until("the loop too", async () => /cycle/i.test(await page.textContent(".loops_text")));
    studio.record("later.h5", 20);
    await until("the list follows the folder again", async () => (await rows(page)).includes("later"));
    expectNoComplaints(page);
  },

  async "commands and places are found by their letters, and the help lists the keys that work"({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await page.goto(studio.page("scope"));
    await until("the folder is known", async () => (await rows(page)).length === 2);
    await page.keyboard.press("Control+k");
    await page.keyboard.type("cut");
    await page.locator("#palette li", { hasText: "cut.h5" }).waitFor();
    expectEqual(await page.getAttribute("#palette input", "aria-activedescendant"), "palette_0", "what Enter does");
    await page.keyboard.press("Enter");
    await until("it is open", async () => (await page.textContent("h1")) === "cut.h5");
    await page.keyboard.press("Control+k");
    await page.keyboard.type("tab fits");
    await page.keyboard.press("Enter");
    await isShown(page, "fits");
    await page.locator("h1").focus();
    await page.keyboard.press("Control+k");
    await until("forms of Work are known", async () => {
      await page.fill("#palette input", "work prepare");
      return (await page.locator("#palette li", { hasText: "Prepare" }).count()) > 0;
    });
    await page.keyboard.press("Enter");
    await until("the form is open", async () => (await page.textContent("h1")).startsWith("Prepare"));
    await page.goBack();
    await isShown(page, "fits");
    await page.locator("h1").focus();
    await page.keyboard.press("?");
    const keys = await page.locator("#help dt").allTextContents();
    for (const it of ["Ctrl + K", "Ctrl + B", "/", "1", "7", "Escape"]) expect(keys.includes(it), `${it} in ${keys}`);
    expectEqual(await audit(page, { focus: false }), [], "complaints of the help");
    await page.keyboard.press("?");
    await page.keyboard.press("Control+k");
    expectEqual(await audit(page, { focus: false }), [], "complaints of the palette");
    await page.keyboard.press("Control+k");
    await page.keyboard.press("Control+b");
    expect(await page.locator("#side").isHidden(), "the list is put away");
    await page.keyboard.press("/");
    expectEqual(await page.evaluate(() => document.activeElement.className), "list_search", "a key brings it back");
    expectNoComplaints(page);
  },

  async "the data have seven tenths of the window"({ browser, studio }) {
    const page = await prepare({ browser, studio });
    for (const [tab, data] of [
      ["time", ".time_plots"],
      ["loop", ".loops_frame"],
    ]) {
      await open(page, studio, "cut.h5", tab);
      await page.waitForSelector(data);
      const box = await page.locator(data).boundingBox();
      const share = (box.width * box.height) / (1280 * 720);
      expect(share >= 0.7, `${tab}: ${(100 * share).toFixed(1)} % of the window`);
    }
  },

  async "in a small window the stretch that is shown is told, and plots are high enough to be read"({
    browser,
    studio,
  }) {
    const page = await prepare({ browser, studio });
    for (const [width, height] of [
      [1024, 720],
      [640, 360],
    ]) {
      await page.setViewportSize({ width, height });
      await open(page, studio, "cut.h5", "time");
      await page.getByText(/^0\.00 s to \d/).waitFor();
      const isWhole = await page.locator(".time_reading").evaluate((it) => it.scrollWidth <= it.clientWidth);
      expect(isWhole, `${width}: the stretch is told`);
      for (const it of await page.locator(".time_over").all()) {
        const box = await it.boundingBox();
        expect(box.height >= 50, `${width}: a plot of ${box.height} pixels`);
      }
    }
  },

  async "every plot can have the whole window, and zero force stays within reach"({ browser, studio, screenshots }) {
    const page = await prepare({ browser, studio });
    studio.kerfOrThrow("fit", "cut.h5", "--models", "kelvin,exponential", "-o", "cut.fit");
    studio.kerfOrThrow("chart", "cut.h5", "--laws", "kelvin", "-o", "cut.chart");
    const drawing = ".enlarged :is(.xy_plot, .time_plots), .enlarged > .xy_plot";
    for (const size of [
      { width: 1280, height: 720 },
      { width: 640, height: 360 },
    ]) {
      await page.setViewportSize(size);
      for (const tab of ["time", "loop", "cycles", "law", "fits", "chart"]) {
        await open(page, studio, "cut.h5", tab);
        const opener = page.locator(".tab_panel .enlarge").first();
        await opener.press("Enter");
        const share = async () => {
          const box = await page.locator(drawing).first().boundingBox();
          return (box.width * Math.min(box.height, size.height - box.y)) / (size.width * size.height);
        };
        const least = size.height < 500 ? 0.6 : 0.7;
        await until(`${tab} has ${least} of ${size.width} x ${size.height}`, async () => (await share()) >= least);
        expectEqual(await opener.getAttribute("aria-pressed"), "true", "the button tells");
        const isOnTop = await page
          .locator("#force_bar button")
          .last()
          .evaluate((it) => {
            const { x, y, width, height } = it.getBoundingClientRect();
            return it.contains(document.elementFromPoint(x + width / 2, y + height / 2));
          });
        expect(isOnTop, "nothing lies over zero force");
        await page.screenshot({ path: join(screenshots, `enlarged-${tab}-${size.width}.png`) });
        await opener.press("f");
        await until("it has its place again", async () => (await page.locator(".enlarged").count()) === 0);
        expect(await opener.evaluate((it) => it === document.activeElement), "the focus stays where it was");
      }
    }
    await page.locator(".tab_panel .enlarge").first().press("Enter");
    await page.keyboard.press("Control+k");
    await until("what is gone to lies above it", async () => (await page.locator(".enlarged").count()) === 0);
    expectNoComplaints(page);
  },

  async "names as long as files may have break no page"({ browser, studio }) {
    const folder = join(studio.folder, "a_folder_with_a_long_name", "and_one_below_it_that_is_longer_still");
    await mkdir(folder, { recursive: true });
    const law = new URL("../../../../examples/kelvin.law.toml", import.meta.url);
    await copyFile(law, join(folder, `${"a_law_of_many_words_".repeat(8)}.law.toml`));
    const page = await prepare({ browser, studio });
    const long = `${"a_recording_of_many_words_".repeat(6)}.h5`;
    await copyFile(join(studio.folder, "cut.h5"), join(folder, long));
    for (const width of [1024, 1280]) {
      await page.setViewportSize({ width, height: 720 });
      for (const tab of tabs) {
        await open(page, studio, `a_folder_with_a_long_name/and_one_below_it_that_is_longer_still/${long}`, tab);
        await page.waitForTimeout(500);
        const over = await page.evaluate(() =>
          ["html", "#side", "#view", ".tab_panel"].filter((it) => {
            const node = document.querySelector(it);
            return node.scrollWidth > node.clientWidth;
          }),
        );
        expectEqual(over, [], `what is wider than its place, ${tab} at ${width}`);
        expect(await page.locator("#tab_report").isVisible(), "all tabs are in sight");
      }
    }
    expectNoComplaints(page);
  },

  async "every tab can be used from 640 to 2560 pixels, by keys and by a screen reader"({ browser, studio }) {
    const modules = process.argv[4];
    const source = await readFile(join(modules, "axe-core", "axe.min.js"), "utf8");
    const complaints = [];
    for (const colorScheme of ["light", "dark"]) {
      const page = await prepare({ browser, studio }, { colorScheme, bypassCSP: true, reducedMotion: "reduce" });
      for (const tab of tabs) {
        await open(page, studio, "cut.h5", tab);
        await page.waitForTimeout(600);
        // 640 x 360 is 1280 x 720 at 200 %.
        const sizes = [
          [640, 360],
          [1024, 768],
          [2560, 1440],
        ];
        const focus = colorScheme === "light";
        for (const it of await audit(page, { sizes, focus })) complaints.push(`${tab} ${colorScheme}: ${it}`);
        for (const it of await axe(page, source)) complaints.push(`${tab} ${colorScheme}: axe: ${it}`);
      }
      await page.context().close();
    }
    expectEqual([...new Set(complaints)], [], "what is not accessible");
  },
};
