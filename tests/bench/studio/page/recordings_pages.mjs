// Recordings: the list, a recording over time at every zoom, its cycles as loops, several laid over each other.

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

async function prepare({ browser, studio }, options = {}) {
  if (!studio.process) {
    studio.record("cut.h5", 20);
    studio.kerfOrThrow("record", "--device", "sim:scissors?seed=7", "--seconds", "10", "--virtual", "-o", "other.h5");
    studio.kerfOrThrow("segment", "other.h5");
    await studio.serve();
  }
  return openPage(browser, options);
}

async function openRecording(page, studio, name) {
  await page.goto(studio.page(`recordings/${await studio.id("recordings", name)}`));
  await page.waitForSelector(".time_plot");
}

const reading = (page) => page.textContent(".time_reading");
const views = (page) => {
  const asked = [];
  page.on("request", (it) => {
    if (it.url().includes("/api/recording/view")) asked.push(Object.fromEntries(new URL(it.url()).searchParams));
  });
  return asked;
};

export const tests = {
  async ListsAndFiltersRecordings({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await page.goto(studio.page("recordings"));
    await page.waitForSelector("tbody tr");
    expectEqual(await page.locator("tbody tr").count(), 2, "rows");
    await page.fill("input[type=search]", "OTH");
    expectEqual(await page.locator("tbody tr a").allTextContents(), ["other.h5"], "what the filter leaves");
    await page.click("tbody tr a");
    await page.waitForSelector(".time_plot");
    expectEqual(await page.evaluate(() => document.activeElement?.tagName), "H1", "what has the focus");
    expectEqual(await page.textContent("h1"), "other.h5", "the head");
    expectNoComplaints(page);
  },

  async FetchesExactlyWhatIsShownAtThePlotsPixels({ browser, studio, screenshots }) {
    const page = await prepare({ browser, studio });
    const asked = views(page);
    await openRecording(page, studio, "cut.h5");
    await until("the whole is asked for", () => asked.length > 0);
    const width = await page
      .locator(".u-over")
      .first()
      .evaluate((it) => it.clientWidth);
    expect(Math.abs(Number(asked[0].columns) - width) <= 1, `${asked[0].columns} columns for ${width} pixels`);
    await page.focus(".time_focus");
    for (let i = 0; i < 3; ++i) await page.keyboard.press("+");
    await until("an eighth is asked for", () => asked.some((it) => Math.abs(it.to - it.from - 19.999 / 8) < 0.01));
    await page.keyboard.press("0");
    await until("the whole is shown", async () => (await reading(page)).startsWith("0.00 s to 20.00 s"));
    await page.screenshot({ path: `${screenshots}/recording.png` });
    expectNoComplaints(page);
  },

  async ReadsTheCursorByArrowKeys({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await openRecording(page, studio, "cut.h5");
    await page.focus(".time_focus");
    await until("values are read", async () => {
      await page.keyboard.press("ArrowRight");
      return (await page.locator(".time_value").allTextContents()).every((it) => it !== "");
    });
    await until("and said", async () => (await page.textContent("[aria-live=polite]")).includes("cursor at"));
    expectNoComplaints(page);
  },

  async ShowsCyclesOneByOne({ browser, studio, screenshots }) {
    const page = await prepare({ browser, studio });
    await openRecording(page, studio, "cut.h5");
    await page.click("#tab_loops");
    const text = () => page.textContent(".loops_text");
    await until("cycles are there", async () => /^Cycles 1 to \d+ of \d+/.test(await text()));
    await page.selectOption(".recording_loops select", "one");
    await until("the first", async () => (await text()).startsWith("Cycle 1 of"));
    await page.focus(".loops_frame");
    await page.keyboard.press("ArrowRight");
    await until("the second", async () => (await text()).startsWith("Cycle 2 of"));
    await page.selectOption(".recording_loops select", "average");
    await until("the average", async () => (await page.locator(".loops_frame .curve").count()) === 2);
    await page.screenshot({ path: `${screenshots}/loops.png` });
    expectNoComplaints(page);
  },

  async LaysRecordingsOverEachOther({ browser, studio, screenshots }) {
    const page = await prepare({ browser, studio });
    const asked = views(page);
    await openRecording(page, studio, "cut.h5");
    const other = await studio.id("recordings", "other.h5");
    await page.selectOption(".overlay select", other);
    await until("both are drawn", async () => (await page.locator(".time_legend").first().locator("li").count()) === 3);
    await until("the other is fetched", () => asked.some((it) => it.id === other));
    await page.selectOption(".overlay label:last-of-type select", "cycle");
    await until("it is fetched where its first closing lies over", () =>
      asked.some((it) => it.id === other && Number(it.from) !== 0),
    );
    await page.screenshot({ path: `${screenshots}/overlay.png` });
    await page.click(".overlay_list button");
    await until("it is gone", async () => (await page.locator(".overlay_list li").count()) === 0);
    expectNoComplaints(page);
  },

  async IsAccessible({ browser, studio }) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await prepare({ browser, studio }, { colorScheme });
      await page.goto(studio.page("recordings"));
      await page.waitForSelector("tbody tr");
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, the list`);
      await openRecording(page, studio, "cut.h5");
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, over time`);
      await page.click("#tab_loops");
      await page.waitForSelector(".loops_frame .curve");
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, loops`);
    }
  },
};
