// Recordings: the list, a recording over time at every zoom, its cycles as loops, several laid over each other.

import { mkdir, writeFile } from "node:fs/promises";
import { join } from "node:path";

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";
import { punch } from "./study_pages.mjs";

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

/** Opens what stands under a button of the tab's tools. */
const popover = (page, name) => page.click(`.tab_tools summary:has-text("${name}")`);

const reading = (page) => page.textContent(".time_reading");
const views = (page) => {
  const asked = [];
  page.on("request", (it) => {
    if (it.url().includes("/api/recording/view")) asked.push(Object.fromEntries(new URL(it.url()).searchParams));
  });
  return asked;
};

/** A recording punch.h5: once the sensor is clipped, and at the end the tool is put down. */
export async function makePunch(studio) {
  await writeFile(join(studio.folder, "punch.txt"), punch(400, { put_down: true, limit: 2.6 }));
  studio.kerfOrThrow("import", "punch.txt", "--map", "time=1[s],position=2[mm],force=3[N]", "-o", "punch.h5");
  studio.kerfOrThrow("segment", "punch.h5");
}

async function preparePunch({ browser, studio }, options = {}) {
  if (!studio.process) {
    await makePunch(studio);
    await studio.serve();
  }
  return openPage(browser, options);
}

/** What lies under the lines of a plot at a time, so many pixels from its top or (negative) its bottom. */
function ground(page, plot, at_s, pixels) {
  return page.evaluate(
    ([k, time, y]) => {
      const canvas = document.querySelectorAll(".time_plot")[k].querySelector("canvas.time_layer");
      const [from, to] = document
        .querySelector(".time_reading")
        .textContent.match(/[\d.]+/g)
        .map(Number);
      const row = y < 0 ? canvas.height + y : y;
      const x = Math.round(((time - from) / (to - from)) * canvas.width);
      return [...canvas.getContext("2d").getImageData(x, row, 1, 1).data];
    },
    [plot, at_s, pixels],
  );
}
/** But for what mixing it with what lies below has rounded. */
const isColour = (found, wanted) => found.every((it, i) => Math.abs(it - wanted[i]) <= 3);
const vermillion = [193, 77, 0, 255];
const ink = [22, 27, 34, 255];

export const tests = {
  async ListsAndFiltersRecordings({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await page.goto(studio.page("recordings"));
    await page.waitForSelector("tbody tr");
    expectEqual(await page.locator("main tbody tr").count(), 2, "rows");
    await page.fill("main input[type=search]", "OTH");
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
      .locator(".time_over")
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
    await page.click("#tab_loop");
    const text = () => page.textContent(".loops_text");
    await until("cycles are there", async () => /^Cycles 1 to \d+ of \d+/.test(await text()));
    await page.selectOption(".recording_loops select >> nth=0", "one");
    await until("the first", async () => (await text()).startsWith("Cycle 1 of"));
    await page.focus(".loops_frame svg.xy_plot");
    await page.keyboard.press("]");
    await until("the second", async () => (await text()).startsWith("Cycle 2 of"));
    await page.selectOption(".recording_loops select >> nth=0", "average");
    await until("the average", async () => (await page.locator(".loops_frame .curve").count()) === 2);
    await page.screenshot({ path: `${screenshots}/loops.png` });
    expectNoComplaints(page);
  },

  async DrawsCyclesWithTheirFlagsAndClippedRows({ browser, studio }) {
    const page = await preparePunch({ browser, studio });
    await openRecording(page, studio, "punch.h5");
    const id = await studio.id("recordings", "punch.h5");
    const { inspection, clipped } = (await studio.api(`/api/recording/inspection?id=${id}`)).json;
    const { list } = inspection.cycles;
    const flagged = list.filter((it) => !it.good);
    expectEqual(
      flagged.map((it) => it.number),
      [5, 8],
      "flagged cycles",
    );
    expectEqual(clipped.length, 1, "runs of clipped rows");
    const middle = (it) => it.begin_s + it.duration_s / 2;
    const last = flagged.at(-1);
    await until("it is hatched", async () => isColour(await ground(page, 0, middle(last), -3), vermillion));
    for (const it of list.filter((each) => each.good)) {
      expect(!isColour(await ground(page, 0, middle(it), -3), vermillion), `cycle ${it.number} is not flagged`);
    }
    const plots = await page.locator(".time_plot").evaluateAll((all) => all.map((it) => it.textContent));
    const force = plots.findIndex((it) => it.includes("force"));
    const run = clipped[0];
    const clippedAt = (plot) => ground(page, plot, (run.from_s + run.to_s) / 2, 8);
    await until("clipped rows are in the plot of the force", async () => isColour(await clippedAt(force), ink));
    expect(!isColour(await clippedAt(0), ink), "and not in that of the position");
    const said = await page.locator(".recording_flags li.flagged").allTextContents();
    expectEqual(said.length, flagged.length, "flagged cycles in words");
    for (const { reason } of last.flags) expect(said.at(-1).includes(reason), `${reason} in ${said.at(-1)}`);
    expect(said.at(-1).includes("tool put down"), said.at(-1));
    const whole = await reading(page);
    await popover(page, "Cycles");
    await page.locator(".recording_flags li.flagged button").last().click();
    await until("it is shown", async () => {
      const [from, to] = (await reading(page)).match(/[\d.]+/g).map(Number);
      return (await reading(page)) !== whole && from < last.begin_s && to >= last.begin_s + last.duration_s - 0.01;
    });
    expectNoComplaints(page);
  },

  async SaysWhatARecordingIsWorthAsKerfInspectDoes({ browser, studio }) {
    const page = await preparePunch({ browser, studio });
    const verb = JSON.parse(studio.kerfOrThrow("inspect", "punch.h5", "--json").stdout);
    await openRecording(page, studio, "punch.h5");
    const id = await studio.id("recordings", "punch.h5");
    const { inspection } = (await studio.api(`/api/recording/inspection?id=${id}`)).json;
    for (const [name, value] of Object.entries(inspection)) expectEqual(value, verb[name], name);
    await page.click("#tab_cycles");
    await page.waitForSelector(".inspection table");
    const warnings = await page.locator(".warnings li span:last-child").allTextContents();
    const inPageWords = (it) => it.replace(/'kerf prepare [^']*'/, "'Prepare' under Work");
    expectEqual(warnings, verb.warnings.map(inPageWords), "warnings, which come first");
    const cells = await page
      .locator(".inspection .signals tbody tr")
      .last()
      .locator("td")
      .evaluateAll((all) => all.map((it) => it.title || it.textContent));
    const force = verb.signals.force_measured;
    const exact = (value) => (value === null ? "not known" : String(value));
    expectEqual(
      [cells[1], cells[2], cells[3], cells[4], cells[5], cells[6], cells[10]],
      [
        force.least.value,
        force.most.value,
        force.quantum,
        force.noise,
        force.noise_idle,
        force.noise_contact,
        force.outliers,
      ].map(exact),
      "numbers of the force",
    );
    expectEqual(cells[9], `high, ${force.most.rows} rows`, "where it is clipped");
    const rows = page.locator(".inspection .cycles tbody tr");
    expectEqual(await rows.count(), verb.cycles.list.length, "cycles");
    expectEqual(
      await page.locator(".inspection .cycles tr.flagged").count(),
      verb.cycles.list.filter((it) => !it.good).length,
      "flagged ones",
    );
    await rows.last().locator("button").click();
    const { begin_s, duration_s } = verb.cycles.list.at(-1);
    await until("the rows of the last cycle are shown", async () => {
      const from = Number(/[?&]from=([^&]*)/.exec(page.url())?.[1] ?? 0);
      return from > begin_s - 2 && from < begin_s + duration_s;
    });
    await page.waitForSelector(".cycle_plots", { state: "visible" });
    expectNoComplaints(page);
  },

  async LaysRecordingsOverEachOther({ browser, studio, screenshots }) {
    const page = await prepare({ browser, studio });
    const asked = views(page);
    await openRecording(page, studio, "cut.h5");
    const other = await studio.id("recordings", "other.h5");
    await popover(page, "Laid over");
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

  async TellsRecordingsOfOneNameApartAndAsksAgainAfterANetworkThatWasGone({ browser, studio }) {
    for (const [folder, seed] of [
      ["monday", 1],
      ["tuesday", 2],
    ]) {
      await mkdir(join(studio.folder, folder));
      const device = `sim:scissors?seed=${seed}`;
      studio.kerfOrThrow("record", "--device", device, "--seconds", "3", "--virtual", "-o", `${folder}/cut.h5`);
    }
    const page = await prepare({ browser, studio });
    const [own, other] = [
      await studio.id("recordings", "monday/cut.h5"),
      await studio.id("recordings", "tuesday/cut.h5"),
    ];
    await page.goto(studio.page(`recording/${own}/time?over=${other}`));
    await until("both have a name", async () => {
      const names = await page.locator(".time_legend").first().locator(".time_name").allTextContents();
      return names.join(" ").includes("monday/cut") && names.join(" ").includes("tuesday/cut");
    });
    await page.route("**/api/recording/view*", (route) => route.abort("connectionreset"));
    await page.waitForTimeout(1500); // what was on its way has come
    let fetched = 0;
    page.on("response", (it) => (fetched += it.url().includes("/api/recording/view") && it.ok() ? 1 : 0));
    await page.getByRole("button", { name: "Show less, larger" }).click();
    await page.waitForTimeout(500);
    expectEqual(fetched, 0, "nothing comes through");
    await page.unroute("**/api/recording/view*");
    await until("it is asked for again", () => fetched >= 2);
    expectNoComplaints(page, [/ERR_CONNECTION_RESET|Failed to load/]);
  },

  async IsAccessible({ browser, studio }) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await prepare({ browser, studio }, { colorScheme });
      await page.goto(studio.page("recordings"));
      await page.waitForSelector("tbody tr");
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, the list`);
      await openRecording(page, studio, "cut.h5");
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, over time`);
      await page.click("#tab_loop");
      await page.waitForSelector(".loops_frame .curve");
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, loops`);
      await page.click("#tab_cycles");
      await page.waitForSelector(".inspection table");
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, inspected`);
    }
  },
};
