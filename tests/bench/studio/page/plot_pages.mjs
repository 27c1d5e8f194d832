// Plots: handed out as SVG, PNG and CSV and held to what was recorded, zoomed and read by keys, laws beside each other over
// their recording, and the way from an error to its rows.

import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

async function prepare({ browser, studio }, options = {}) {
  if (!studio.process) {
    studio.record("cut.h5", 8);
    studio.kerfOrThrow("record", "--device", "sim:scissors?seed=7", "--seconds", "6", "--virtual", "-o", "other.h5");
    studio.kerfOrThrow("segment", "other.h5");
    studio.kerfOrThrow("fit", "cut.h5", "--models", "kelvin,exponential,piecewise", "--folds", "2", "-o", "cut.fit");
    await studio.serve();
  }
  return openPage(browser, options);
}

async function open(page, studio, tab, state = "") {
  const id = await studio.id("recordings", "cut.h5");
  await page.goto(studio.page(`recording/${id}/${tab}${state}`));
}

/** Presses an entry of a menu that hands something out, and reads the file. */
async function save(page, scope, kind, column = null) {
  await scope.locator(".out summary").first().click();
  if (column) await scope.locator(".out select").first().selectOption(column);
  const button = scope.locator(".out").first().getByRole("button", { name: kind, exact: true });
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
}

/** A table as it was written: its heads, and its columns by them. */
function tableIn(bytes) {
  const [head, ...rows] = bytes
    .toString("utf8")
    .trimEnd()
    .split("\r\n")
    .map((line) => line.split(/,(?=(?:[^"]*"[^"]*")*[^"]*$)/).map((it) => it.replace(/^"|"$/g, "")));
  return { head, column: (name) => rows.map((row) => row[head.indexOf(name)]) };
}

/** Chunks of a PNG by name. */
function chunksOf(bytes) {
  const chunks = new Map();
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at))
    chunks.set(bytes.toString("latin1", at + 4, at + 8), bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at)));
  return chunks;
}

const degrees = (rad) => (rad * 180) / Math.PI;
const near = (found, wanted) => Math.abs(found - wanted) <= 1e-6 * Math.max(1, Math.abs(wanted));

export const tests = {
  async HandsAPlotOutAsItIsPrinted({ browser, studio }) {
    const page = await prepare({ browser, studio }, { colorScheme: "dark" });
    await open(page, studio, "loop", "?loops=average");
    await page.waitForSelector(".loops_frame .plot .curve");
    const plot = page.locator(".loops_frame figure");
    const id = await studio.id("recordings", "cut.h5");
    const { average } = (await studio.api(`/api/recording/loops?id=${id}&axis=0&first=1&count=1`)).json;

    const csv = await save(page, plot, "CSV");
    expectEqual(csv.name, "Force-against-position-cut-h5.csv", "a name that every file system takes");
    const table = tableIn(csv.bytes);
    expectEqual(table.head[0], "position theta [deg]", "the head of the position has its unit");
    const positions = table.column("position theta [deg]").map(Number);
    expect(
      average.position.every((it, i) => near(positions[i], degrees(it))),
      "every position is there, in degrees",
    );
    const forces = table.column("force theta closing [N]");
    expect(
      average.closing.every((it, i) => (it === null ? forces[i] === "" : near(Number(forces[i]), it))),
      "every force is there, and none where there is none",
    );

    for (const [column, mm] of [
      ["one", 88],
      ["two", 180],
    ]) {
      const svg = (await save(page, plot, "SVG", column)).bytes.toString("utf8");
      const found = await page.evaluate((text) => {
        const root = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
        const all = (name) => [...root.querySelectorAll(name)];
        return {
          root: root.nodeName,
          width: root.getAttribute("width"),
          sizes: [...new Set(all("text").map((it) => it.getAttribute("font-size")))],
          widths: all("[stroke-width]").map((it) => Number(it.getAttribute("stroke-width"))),
          texts: all("text").map((it) => it.textContent),
          about: root.querySelector("desc").textContent,
          dashed: all("path[stroke-dasharray]").length,
          pictures: all("image, foreignObject, style, script").length,
        };
      }, svg);
      expectEqual(found.root, "svg", "it is well-formed");
      expectEqual(found.width, `${mm}mm`, "as wide as a column");
      expectEqual(found.sizes, ["8"], "letters of 8 pt");
      expect(
        found.widths.every((it) => it >= 0.25 && it <= 1.5),
        `thin lines: ${found.widths}`,
      );
      for (const text of ["position theta [deg]", "force theta [N]", "closing", "opening"])
        expect(found.texts.includes(text), `${text} in ${found.texts}`);
      expect(found.about.startsWith("Averages of the cycles"), found.about);
      expectEqual([found.dashed, found.pictures], [0, 0], "dashes on what was measured, and what is no line or text");
      expect(!svg.includes("NaN") && !svg.includes("Infinity"), "no number that is none");
    }

    const chunks = chunksOf((await save(page, plot, "PNG", "two")).bytes);
    expectEqual(chunks.get("IHDR").readUInt32BE(0), Math.round((180 / 25.4) * 600), "600 dots an inch");
    expectEqual(chunks.get("pHYs").readUInt32BE(0), 23622, "as the file says");
    expect(chunks.get("iTXt").toString("utf8").includes("Averages of the cycles"), "and what its numbers are");
    expectNoComplaints(page);
  },

  async WritesEveryRowOrSaysThatItDoesNot({ browser, studio }) {
    const page = await prepare({ browser, studio });
    studio.kerfOrThrow("convert", "cut.h5", "-o", "cut.csv");
    const rows = (await readFile(join(studio.folder, "cut.csv"), "utf8")).trimEnd().split("\n");
    const head = rows.findIndex((it) => !it.startsWith("#"));
    const names = rows[head].split(",");
    const force = names.findIndex((it) => /force_measured/.test(it));
    const written = rows.slice(head + 1).map((it) => it.split(",").map(Number));
    await open(page, studio, "time", "?from=2&to=2.5");
    await page.waitForSelector(".time_plot");
    await until("rows are there", async () => {
      await page.focus(".time_focus");
      await page.keyboard.press("ArrowRight");
      return (await page.locator(".time_value").allTextContents()).every((it) => it !== "");
    });
    const shown = async () => (await save(page, page.locator(".time_bar"), "SVG")).bytes.toString("utf8");
    await until("it says that every row is there", async () => (await shown()).includes("Every row is there."));
    const near_ = tableIn((await save(page, page.locator(".time_bar"), "CSV")).bytes);
    const name = near_.head.find((it) => /force measured theta/.test(it));
    const unit = /\[(m?)N\]/.exec(name)[1] === "m" ? 1e3 : 1;
    const times = near_.column("time [s]").map(Number);
    const values = near_.column(name).map(Number);
    const wanted = written.filter((it) => it[0] > 2.001 && it[0] < 2.499);
    for (const row of wanted) {
      const at = times.findIndex((it) => Math.abs(it - row[0]) < 1e-6);
      expect(at >= 0, `the row at ${row[0]} s is there`);
      expect(Math.abs(values[at] / unit - row[force]) < 1e-6, `${values[at]} at ${row[0]} s is ${row[force]} N`);
    }
    expect(wanted.length > 400, `${wanted.length} rows were compared`);
    await page.focus(".time_focus");
    await page.keyboard.press("0");
    await until("the whole is there", async () =>
      /smallest and largest value of every [\d.]+ ms, at its middle; no spike is lost/.test(await shown()),
    );
    expectNoComplaints(page);
  },

  async DrawsWhatThePageMarksAndSaysHowLongARowOfATableIs({ browser, studio, screenshots }) {
    const page = await prepare({ browser, studio });
    studio.kerfOrThrow("inspect", "cut.h5", "--flag", "2=the tissue slipped");
    await open(page, studio, "time");
    await page.locator(".tab_tools summary", { hasText: /Cycles \d+, 1 flagged/ }).waitFor();
    const bar = page.locator(".time_bar");
    for (const column of ["one", "two"]) {
      const svg = (await save(page, bar, "SVG", column)).bytes.toString("utf8");
      const { texts, sizes } = await page.evaluate((text) => {
        const all = [...new DOMParser().parseFromString(text, "image/svg+xml").querySelectorAll("text")];
        return {
          texts: all.map((it) => it.textContent),
          sizes: [...new Set(all.map((it) => it.getAttribute("font-size")))],
        };
      }, svg);
      const legend = ["force measured theta", "closing", "opening", "event", "cycle", "flagged cycle"];
      const at = legend.map((it) => texts.lastIndexOf(it));
      expectEqual(
        at,
        [...at].sort((a, b) => a - b),
        `${legend} in their order, marks last, in ${texts}`,
      );
      expect(at[0] >= 0 && !texts.includes("no rows"), "what is there is in the legend, and nothing else");
      expectEqual(sizes, ["8"], "letters of 8 pt");
    }
    const { bytes } = await save(page, bar, "PNG", "one");
    await writeFile(join(screenshots, "time_marks_88mm.png"), bytes);

    const whole = tableIn((await save(page, bar, "CSV")).bytes);
    expectEqual(whole.head.slice(0, 2), ["time [s]", "time covered by a row [s]"], "what a row is of");
    const times = whole.column("time [s]").map(Number);
    const step = (times.at(-1) - times[0]) / (times.length - 1);
    const [covered] = whole.column("time covered by a row [s]").map(Number);
    expect(Math.abs(covered / step - 1) < 0.01, `${covered} s, rows are ${step} s apart`);
    const forces = whole.head.filter((it) => /force/.test(it)).map((it) => /\[(.*)\]/.exec(it)[1]);
    expectEqual(new Set(forces).size, 1, `one unit: ${forces}`);

    // Of two recordings each trace has a plot, whose axis goes as far as it needs: the table has one unit for both.
    const other = await studio.id("recordings", "other.h5");
    await open(page, studio, "time", `?over=${other}&traces=force_commanded theta,force_measured theta`);
    await page.locator(".time_plot").nth(1).waitFor();
    await until("all units are one", async () => {
      const { head } = tableIn((await save(page, bar, "CSV")).bytes);
      const units = head.filter((it) => /force/i.test(it)).map((it) => /\[(.*)\]/.exec(it)[1]);
      return units.length >= 4 && new Set(units).size === 1;
    });
    expectNoComplaints(page);
  },

  async IsZoomedAndReadByKeysAndPointer({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await open(page, studio, "loop", "?loops=average");
    await page.waitForSelector(".loops_frame .plot .curve");
    const svg = page.locator(".loops_frame svg.xy_plot");
    const ticks = () => page.locator(".loops_frame .tick").allTextContents();
    const all = await ticks();
    await svg.focus();
    await page.keyboard.press("+");
    const zoomed = await ticks();
    expect(JSON.stringify(zoomed) !== JSON.stringify(all), "plus shows less");
    await page.keyboard.press("Shift+ArrowRight");
    expect(JSON.stringify(await ticks()) !== JSON.stringify(zoomed), "Shift and an arrow move along");
    await page.keyboard.press("0");
    expectEqual(await ticks(), all, "0 shows all");
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    const read = await page.textContent(".loops_frame .plot_reading");
    expect(/^(closing|opening): position theta [\d.]+ deg, force theta −?[\d.]+ N$/.test(read), `a point: ${read}`);
    await page.keyboard.press("ArrowDown");
    expect((await page.textContent(".loops_frame .plot_reading")) !== read, "down leads to the other line");
    const box = await svg.boundingBox();
    await page.mouse.move(box.x + 0.4 * box.width, box.y + 0.3 * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.6 * box.height, { steps: 4 });
    await page.mouse.up();
    expect(JSON.stringify(await ticks()) !== JSON.stringify(all), "a rectangle that is dragged out is shown");
    await page.mouse.dblclick(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
    expectEqual(await ticks(), all, "a double click shows all");
    expectNoComplaints(page);
  },

  async PutsLawsBesideEachOtherAndLeadsToTheRows({ browser, studio, screenshots }) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await prepare({ browser, studio }, { colorScheme });
      await open(page, studio, "fits", "?laws=kelvin,exponential");
      await page.waitForSelector(".beside_laws .curve");
      const plots = page.locator(".beside_laws svg.xy_plot");
      expectEqual(await plots.count(), 4, "over penetration and time, forces and what is left of them");
      const first = plots.first();
      const dash = (name) => first.locator(`.curve.${name}`).first().getAttribute("stroke-dasharray");
      expectEqual(await dash("measured_closing"), null, "what was measured is solid");
      for (const law of ["kelvin_closing", "exponential_closing"]) expect(await dash(law), `${law} is dashed`);
      expect((await first.locator(".area").count()) >= 4, "intervals of both laws, in and out");
      for (let i = 0; i < 4; ++i)
        expect((await plots.nth(i).locator(".tick").count()) >= 6, "axes have more labels than one");
      expectEqual(await page.locator(".beside_laws .figures > div").count(), 2, "a sentence for each law");
      expectEqual(await audit(page), [], `complaints, ${colorScheme}`);
      await page.screenshot({ path: join(screenshots, `compared-${colorScheme}.png`), fullPage: true });
      if (colorScheme === "dark") continue;
      await page.getByLabel("Draw piecewise").check();
      await until("it is in the address", () => page.url().includes("piecewise"));
      await page.waitForSelector(".beside_laws .curve.piecewise_closing");
      const table = await save(page, page.locator(".beside_laws figure").nth(1), "CSV");
      const heads = tableIn(table.bytes).head;
      for (const it of ["force measured smallest [N]", "force kelvin [N]"])
        expect(
          heads.some((head) => head === it || head === it.replace(" [N]", " largest [N]")),
          `${it} in ${heads}`,
        );
      const link = page.locator(".places a").first();
      const said = await link.textContent();
      await link.click();
      await page.waitForSelector(".time_plot");
      const id = await studio.id("recordings", "cut.h5");
      const law = await studio.id("laws", "cut.fit/kelvin.law.toml");
      const { places } = (await studio.api(`/api/residuals?id=${id}&axis=theta&law=${law}&columns=10`)).json;
      expect(said.startsWith(`cycle ${places[0].cycle}`), `${said} is what the server says: ${places[0].cycle}`);
      const [from, to] = (await page.textContent(".time_reading")).match(/[\d.]+/g).map(Number);
      expect(from < places[0].from_s && to > places[0].to_s && to - from < 4, `${from} to ${to} s are its rows`);
      expectNoComplaints(page);
    }
  },

  async SaysTheSameErrorsAsTheFitAndHandsThemOut({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await open(page, studio, "fits");
    await page.waitForSelector("table.fits");
    const fit = JSON.parse(await readFile(join(studio.folder, "cut.fit/fit.json"), "utf8"));
    const button = page.getByRole("button", { name: /^Save CSV of the table fits/ });
    const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
    const table = tableIn(await readFile(await download.path()));
    const rows = table.column("law");
    for (const it of fit.fits) {
      const at = rows.indexOf(it.model);
      expectEqual(Number(table.column("error [N]")[at]), it.rmse, `the error of ${it.model}, to the last digit`);
      expectEqual(Number(table.column("held-out error [N]")[at]), it.cv_rmse, `the held-out error of ${it.model}`);
    }
    const law = page.locator(".detail");
    const file = await save(page, law, "Law file");
    const name = file.name.replace(/\.law\.toml$/, "");
    expect(file.bytes.toString("utf8").includes(`model = "${name}"`), "the law's file");
    await law.locator(".out summary").first().click();
    await until("hosts are listed", async () => (await law.locator(".out option").count()) >= 7);
    await page.keyboard.press("Escape");
    await law.locator(".out summary").first().click();
    const c = await save(page, law, "For the program", "c");
    expectEqual(c.name, `${name}-c.c`, "the name of the export");
    studio.kerfOrThrow("export", `cut.fit/${name}.law.toml`, "--as", "c", "-o", "exported");
    expectEqual(
      c.bytes.toString(),
      await readFile(join(studio.folder, `exported/${name}.c`), "utf8"),
      "as kerf export",
    );
    expectNoComplaints(page);
  },

  async ShowsRecordingsSideBySideOnTheSameAxes({ browser, studio, screenshots }) {
    const page = await prepare({ browser, studio });
    const other = await studio.id("recordings", "other.h5");
    await open(page, studio, "loop", `?loops=average&over=${other}`);
    await until("both are drawn", async () => (await page.locator(".loops_frame .plot .curve").count()) === 4);
    const dashed = await page.locator(".loops_frame .plot .curve[stroke-dasharray]").count();
    expectEqual(dashed, 0, "dashes look like missing samples");
    expect((await page.locator(".loops_frame .along").count()) >= 4, "and shapes tell them apart");
    await page.getByLabel("side by side").check();
    await until("side by side", async () => (await page.locator(".loops_frame figure").count()) === 2);
    const ticks = (k) => page.locator(".loops_frame figure").nth(k).locator(".tick").allTextContents();
    expectEqual(await ticks(0), await ticks(1), "the numbers of both axes");
    await page.screenshot({ path: join(screenshots, "beside.png") });
    await page.reload();
    await until("the address has it", async () => (await page.locator(".loops_frame figure").count()) === 2);
    expectNoComplaints(page);
  },

  async DrawsForceAgainstPositionWithoutCycles({ browser, studio }) {
    const rows = ["time [s]\tposition [mm]\tforce [N]"];
    for (let i = 0; i < 400; ++i)
      rows.push(`${i / 100}\t${(i / 100).toFixed(3)}\t${(0.3 * (i / 100) ** 2).toFixed(4)}`);
    await writeFile(join(studio.folder, "ramp.txt"), `${rows.join("\n")}\n`);
    studio.kerfOrThrow("import", "ramp.txt", "--map", "time=1[s],position=2[mm],force=3[N]", "-o", "ramp.h5");
    await studio.serve();
    const page = await openPage(browser);
    const id = await studio.id("recordings", "ramp.h5");
    await page.goto(studio.page(`recording/${id}/loop`));
    await page.waitForSelector(".loops_frame .plot .curve");
    expect((await page.textContent(".loops_text")).includes("All rows are drawn"), "it says what is drawn");
    const axis = await page.locator(".loops_frame .axis").first().textContent();
    expect(!/(\w+) \1/.test(axis), `an axis is named once: ${axis}`);
    expectNoComplaints(page);
  },
};
