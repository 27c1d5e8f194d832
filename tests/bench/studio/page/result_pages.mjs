// Fits, the speed-accuracy chart, the choice of a law, stability maps and devices, as a person works through them: each is
// ordered on the page, and what is shown is held to what the program's own verb says.

import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";

import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

const limit_ms = 60000; // jobs give way to everything else on the machine

async function jsonIn(studio, name) {
  return JSON.parse(await readFile(join(studio.folder, name), "utf8"));
}

/** Every text of the page's figure and its legend stands in the picture that the program drew, too. */
async function expectAsInPrint(page, studio, svg, except = []) {
  const print = await readFile(join(studio.folder, svg), "utf8");
  const texts = await page.locator(".figure .legend span, .figure .xy_plot :is(.axis, .note)").allTextContents();
  const left = texts.filter((it) => !print.includes(it) && !it.endsWith(" (nowhere here)"));
  expectEqual(
    left.filter((it) => !except.some((pattern) => pattern.test(it))),
    [],
    "what the page says and the picture does not",
  );
  return texts;
}

/** The heading of the page once it says so: a job's result opens by itself. */
async function heading(page, pattern) {
  await until(`the heading is ${pattern}`, async () => pattern.test((await page.textContent("h1")) ?? ""), limit_ms);
}

/** The tab of the recording shows this result: a job's opens by itself. */
async function result(page, recording, name) {
  await heading(page, new RegExp(`^${recording}$`));
  const chosen = page.locator(".tab_head select option:checked");
  await until(`${name} is shown`, async () => (await chosen.textContent().catch(() => "")) === name, limit_ms);
}

async function go(page, studio, place) {
  await page.goto(`${studio.url}#/${place}`);
  await page.waitForSelector("main form, main table");
}

/** Ticks these laws and no others. */
async function tick(page, ...laws) {
  await page.getByRole("button", { name: "None", exact: true }).click();
  for (const law of laws) await page.getByLabel(law, { exact: true }).check();
}

/** The tab of a recording, with its form. */
async function openTab(page, studio, name, tab) {
  await go(page, studio, `recording/${await studio.id("recordings", name)}/${tab}`);
}

/** The choice names an error that stands in a column of that name, and a straight line is there to hold laws against. */
async function expectNumbersOfTheSentence(page, written) {
  const { model, why } = written.choice;
  expect(why.includes("held-out data as rendered"), `the choice says which error it goes by: ${why}`);
  const heads = await page.locator("table.fits thead th").allTextContents();
  const at = heads.indexOf("held out as rendered [N]");
  const row = page.locator("table.fits tbody tr", { hasText: model });
  const shown = await row.locator("> *").nth(at).textContent();
  expect(new RegExp(`(^|[ (])${shown.replace(".", "[.]")} N`).test(why), `${shown} N stands in: ${why}`);
  const line = page.locator("table.fits tfoot tr", { hasText: "straight line" });
  const error = line.locator("> *").nth(heads.indexOf("error [N]"));
  expectEqual(Number(await error.getAttribute("data-value")), written.line_rmse, "the error of a straight line");
  const lineHeld = line.locator("> *").nth(heads.indexOf("held out [N]"));
  expectEqual(Number(await lineHeld.getAttribute("data-value")), written.line_cv_rmse, "a straight line held out");
  const floor = page.locator("table.fits tfoot tr", { hasText: "floor" });
  const held = floor.locator("> *").nth(heads.indexOf("held out [N]"));
  expectEqual(Number(await held.getAttribute("data-value")), written.floor.velocity, "the floor");
}

async function testFits(page, studio) {
  await openTab(page, studio, "cut.h5", "fits");
  await tick(page, "kelvin", "exponential");
  await page.getByRole("button", { name: "Fit", exact: true }).click();
  await result(page, "cut.h5", "cut.fit");
  const written = await jsonIn(studio, "cut.fit/fit.json");
  expectEqual(
    await page.locator("table.fits tbody th").allTextContents(),
    ["kelvin", "exponential"],
    "laws, the least error first",
  );
  await expectNumbersOfTheSentence(page, written);
  expect((await page.textContent("main p.choice")).includes(written.choice.why), "the choice says why");
  // One law has another error here and in the segment editor (finding S24): both pages say why.
  const text = await page.textContent("main");
  expect(
    text.includes("those of the tab Law, and its JND, are of the averaged cycle"),
    "it says what the errors are over",
  );
  const { model, within_jnd } = written.choice;
  const mark = within_jnd ? "simplest within the JND" : "as good as the best, not within the JND";
  const row = page.locator("table.fits tbody tr", { hasText: model });
  expect((await row.textContent()).includes(mark), `${model} is marked as what it is: ${mark}`);
  await page.getByRole("button", { name: "exponential", exact: true }).click();
  await until("the parameters are those of the exponential law", async () =>
    (await page.locator(".detail tbody th").allTextContents()).includes("exponent"),
  );
  const rmse = written.fits.find((it) => it.model === "exponential").rmse;
  const shown = await until("residuals are shown", async () =>
    /exponential: Error ([\d.]+) mN/.exec((await page.textContent(".residuals .figures")) ?? ""),
  );
  expect(
    Math.abs(Number(shown[1]) / (1000 * rmse) - 1) < 0.01,
    `residuals of ${shown[1]} mN are the fit's ${1000 * rmse} mN`,
  );
  expect(
    (await page.locator(".residuals .extremes.exponential").getAttribute("d")).length > 1000,
    "residuals are drawn over time",
  );
  expectEqual(
    await page.locator(".detail svg.interval").count(),
    Object.keys(written.fits[0].parameters).length,
    "bars of intervals",
  );
  return written;
}

/** Why a law with a small error is not chosen stands beside it. */
async function testRemarks(page, studio) {
  const file = join(studio.folder, "cut.fit/fit.json");
  const written = await readFile(file, "utf8");
  const changed = JSON.parse(written);
  const law = changed.fits.find((it) => it.model !== changed.choice.model);
  Object.assign(law, { converged: false, r2: -0.1, free_fraction: 0.8, undetermined_arms: 1 });
  await writeFile(file, JSON.stringify(changed));
  await page.reload();
  const remark = page.locator("table.fits tbody tr", { hasText: law.model }).locator("td").last();
  const all = "did not converge, worse than the mean, felt in free air, an arm not told";
  await until(`${law.model} has its remarks`, async () => (await remark.textContent().catch(() => "")) === all);
  await writeFile(file, written);
  await page.reload();
  await until("it has none", async () => (await remark.textContent().catch(() => "?")) === "");
}

/** The law that was fitted goes into the running loop by one press. */
async function testFeeling(page) {
  const ask = (path) =>
    page.evaluate(async (where) => {
      const token = document.querySelector("meta[name=kerf-token]").content;
      const headers = { "X-Kerf-Token": token, "Content-Type": "application/json" };
      return (
        await fetch(where, where.endsWith("status") ? { headers } : { method: "POST", headers, body: "{}" })
      ).json();
    }, path);
  await page.getByRole("button", { name: "kelvin", exact: true }).click();
  await ask("/api/live/start");
  await page.getByRole("button", { name: "Feel it now" }).click();
  await until("the loop renders it", async () => (await ask("/api/live/status")).law.includes("kelvin"));
  expect((await page.textContent("#notice")).startsWith("kelvin is rendered now"), "the page says so");
  await ask("/api/live/stop");
}

async function testChart(page, studio) {
  await openTab(page, studio, "short.h5", "chart");
  await tick(page, "kelvin");
  await page.getByRole("button", { name: "Chart", exact: true }).click();
  await result(page, "short.h5", "short.chart");
  const { points } = await jsonIn(studio, "short.chart/chart.json");
  expectEqual(await page.locator("g.point").count(), points.length, "points");
  const texts = await expectAsInPrint(page, studio, "short.chart/chart.svg");
  for (const it of ["kelvin", "front, median", "JND"]) expect(texts.includes(it), `${it} is named`);
  expect(
    texts.some((it) => it.includes("a tick at 1000 Hz")),
    "the deadline of the loop is named",
  );
  await page.locator('g.point[tabindex="0"]').focus();
  await page.keyboard.press("ArrowRight");
  const label = await page.evaluate(() => document.activeElement.getAttribute("aria-label"));
  expectEqual(await page.textContent(".chart_plot .readout"), label, "the read-out of the point that the arrow led to");
  expect(
    label.includes("stable: not judged: no hand pressed and held it"),
    `what nobody judged is not stable: ${label}`,
  );
  const all = `The stability of ${points.length} of ${points.length} points was not judged.`;
  expect((await page.textContent("main")).includes(all), all);
  const verdicts = await page.locator("table tr td:nth-child(9)").allTextContents();
  expect(verdicts.length >= points.length && verdicts.every((it) => it.startsWith("not judged: ")), verdicts.join());
  await page.keyboard.press("Enter");
  await until("its law is open", async () =>
    label.startsWith((await page.textContent(".law h2").catch(() => "")) || "?"),
  );
  expect(await page.evaluate(() => document.activeElement.classList.contains("opened")), "the point keeps the focus");
  expect((await page.textContent(".law .equation")).startsWith("F ="), "the law's equation");
  expectEqual(await page.locator(".law tbody tr").count(), 3, "parameters of Kelvin's law");
  await page.locator("th button", { hasText: "p50" }).click();
  const costs = (await page.locator("table tr td:nth-child(3)").allTextContents()).map(Number).slice(-points.length);
  expectEqual(
    costs,
    [...costs].sort((a, b) => a - b),
    "the table, sorted by cost",
  );
}

async function testChoice(page, studio) {
  await page.getByRole("button", { name: "Choose", exact: true }).click();
  await page.waitForSelector("section.choice h2:has-text('Chosen')", { timeout: limit_ms });
  const written = await jsonIn(studio, "short.choice/choose.json");
  expect((await page.textContent("section.choice h2")).endsWith(written.choice.law), "the law that was taken");
  expect((await page.textContent("section.choice")).includes(written.choice.why), "why it was taken");
  expectEqual(
    await page
      .locator(".candidates td:nth-child(7)")
      .filter({ hasText: /^taken$/ })
      .count(),
    written.choice.serves ? 1 : 0,
    "a law is taken where it serves",
  );
  expectEqual(await page.locator(".candidates tbody tr").count(), written.candidates.length, "the candidates");
  const stable = { true: "yes", false: "no", null: "not judged" };
  expectEqual(
    await page.locator(".candidates td:nth-child(6)").allTextContents(),
    written.candidates.map((it) => stable[it.stable]),
    "which are stable",
  );
  await page.getByRole("button", { name: `Open ${written.choice.law}` }).click();
  await until(
    "the chosen law is open",
    async () => (await page.textContent(".law h2").catch(() => "")) === written.choice.law,
  );
}

async function testStability(page, studio) {
  await go(page, studio, "stability");
  await page.getByLabel("Cells a side").fill("12");
  await page.getByRole("button", { name: "Map", exact: true }).click();
  await heading(page, /sim-scissors\.stability$/);
  const run = studio.kerf(["stability", "--device", "sim:scissors", "--grip", "light", "--cells", "12", "--json"]);
  const { cells, in_words: words } = JSON.parse(run.stdout);
  expectEqual(await page.locator(".words li").allTextContents(), words, "what the verb says");
  const added = [/theory says otherwise$/, /^the device's own damping/];
  const texts = await expectAsInPrint(page, studio, "sim-scissors.stability/wall.svg", added);
  for (const it of ["comes to rest", "eigenvalues"]) expect(texts.includes(it), `${it} is named`);
  await page.locator(".map svg.xy_plot").focus();
  for (const key of ["ArrowUp", "ArrowLeft", "ArrowLeft"]) await page.keyboard.press(key);
  // The first press leads to the middle.
  const { B, stable, theory } = cells[4 * 12 + 6];
  const what = stable ? "comes to rest" : "does not come to rest";
  const agrees = stable === theory ? "agrees" : "says otherwise";
  const expected = `: ${what}; theory (the eigenvalues) ${agrees}`;
  const told = await page.textContent(".map .readout");
  expect(told.endsWith(expected), `the cell at the cursor${expected}`);
  expect(Math.abs(Number(/B ([\d.]+) N·s/.exec(told)?.[1]) / B - 1) < 0.01, `its damping is ${B}: ${told}`);
}

/** A law's map, whose cells follow each other to the right. */
async function testMapOfALaw(page, studio) {
  const arguments_ = ["--depth", "0.01", "--cells", "5", "--json", "-o", "kelvin.stability"];
  const { cells } = JSON.parse(studio.kerf(["stability", "cut.fit/kelvin.law.toml", ...arguments_]).stdout);
  await page.goto(`${studio.url}#/stability/${await studio.id("files", "kelvin.stability/stability.json")}`);
  await heading(page, /kelvin\.stability$/);
  const texts = await expectAsInPrint(page, studio, "kelvin.stability/law.svg", [/otherwise$/, /^asked for: 10 mm/]);
  expect(texts.includes("this device"), "the device's own rate is named");
  await page.locator(".map svg.xy_plot").focus();
  for (const key of ["ArrowUp", "ArrowLeft"]) await page.keyboard.press(key);
  const told = await page.textContent(".map .readout");
  const depth_mm = 1000 * cells[2 * 5 + 1].depth_m;
  expect(told.includes(`depth ${depth_mm} mm: ${cells[11].stable ? "passive" : "gains energy"}`), told);
}

/** A device that was identified: what its file tells stands on its page, and a chart that somebody adds to it is drawn. */
async function testDevice(page, studio) {
  const search = ["--max-force", "2", "--z-width", "--rungs", "2", "--repeats", "1", "--resolution", "0.3"];
  const excitation = ["--free", "--seconds", "8", "--period", "0.5", "--band", "2", "40"];
  const uri = "sim:axis?hand=off&coulomb=0.1N&step=0.01mm&limit=40N";
  studio.kerfOrThrow("identify", uri, excitation, search, "-o", "axis");
  const written = await jsonIn(studio, "axis/identify.json");
  const [axis] = written.axes;
  await page.goto(`${studio.url}#/devices`);
  await page.getByRole("link", { name: "axis", exact: true }).click();
  await heading(page, /^Device axis$/);
  expect((await page.textContent("main .verdict")).includes(axis.verdict), "its verdict");
  expectEqual(
    await page.locator("main tbody td:nth-child(1)").allTextContents(),
    axis.numbers.map((it) => it.name),
    "its numbers",
  );
  const unknown = await page
    .locator("main tbody td:nth-child(2)")
    .filter({ hasText: /^unknown$/ })
    .count();
  expectEqual(unknown, axis.numbers.filter((it) => it.value === null).length, "what is unknown is said to be");
  const titles = axis.charts.map((it) => it.figure.title);
  expectEqual(await page.locator("main figcaption").allTextContents(), titles, "its charts");
  expect(titles.length === 5 && titles[4].startsWith("Z-width"), `response, coherence, friction, Z-width: ${titles}`);
  const marks = axis.charts[0].figure.curves.find((it) => it.mark === "points").x.length;
  expectEqual(
    await page.locator("main figure").first().locator(".plot .mark").count(),
    marks,
    "points of the response",
  );
  written.charts = [{ name: "others", figure: { ...axis.charts[3].figure, title: "What somebody adds" } }];
  await writeFile(join(studio.folder, "axis/identify.json"), JSON.stringify(written));
  await page.reload();
  await until("the chart that was added is drawn", async () =>
    (await page.locator("main figcaption").allTextContents()).includes("What somebody adds"),
  );
}

/** All of it on a page of a studio whose folder has cut.h5, segmented. */
export async function testResults(page, studio) {
  studio.kerf(["record", "--device", "sim:scissors", "--seconds", "6", "--virtual", "-o", "short.h5"]);
  studio.kerf(["segment", "short.h5"]);
  await testFits(page, studio);
  await testRemarks(page, studio);
  await testFeeling(page);
  await testChart(page, studio);
  await testChoice(page, studio);
  await testStability(page, studio);
  await testMapOfALaw(page, studio);
  await testDevice(page, studio);
}

export const tests = {
  async "fits, chart, choice and stability maps are ordered and looked at"({ browser, studio, screenshots }) {
    studio.record();
    await studio.serve();
    const page = await openPage(browser);
    await testResults(page, studio);
    await page.screenshot({ path: join(screenshots, "stability.png") });
    expectNoComplaints(page);
  },
};
