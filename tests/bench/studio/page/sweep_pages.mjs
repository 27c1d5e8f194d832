// Sweeps: heat maps held to what the merged file says, filters, brushes, and the address that brings all of it back.

import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

/** A sweep of walls in the workspace, merged while the last tenth of its cells is missing. */
export async function makeSweep(studio) {
  const toml = `version = 1
verb = "stability"
shards = 10
[cells]
mass = [0.05, 0.1]
delay = [0, 0.001, 0.004]
damping = [0, 10]
seconds = 0.1
stiffness = { from = 100, to = 100000, count = 15, scale = "logarithmic" }
`;
  await writeFile(join(studio.folder, "walls.toml"), toml);
  studio.kerfOrThrow("sweep", "plan", "walls.toml", "--no-sample");
  for (let shard = 0; shard < 9; ++shard)
    studio.kerfOrThrow("sweep", "run", "walls.plan.json", "--shard", String(shard), "-j", "1");
  const merged = studio.kerf("sweep", "merge", "walls.plan.json"); // 1: cells are missing
  if (merged.status > 1) throw new Error(merged.stderr);
}

async function openSweep({ browser, studio }, options = {}, state = "") {
  if (!studio.process) {
    await makeSweep(studio);
    await studio.serve();
  }
  const page = await openPage(browser, options);
  await page.goto(studio.page(`sweeps/${await studio.id("files", "walls.merged/sweep.h5")}${state}`));
  await page.waitForSelector(".heat_legend .steps li");
  return page;
}

const counted = (page) => page.textContent(".counted");
const said = (page) => page.textContent(".heat_maps output");
const where = (page) => JSON.parse(new URLSearchParams(page.url().split("?").pop()).get("where") ?? "{}");

export const tests = {
  async ListsAndOpensSweeps({ browser, studio }) {
    await makeSweep(studio);
    await studio.serve();
    const page = await openPage(browser);
    await page.goto(studio.page("sweeps"));
    await page.click("main .links a");
    await page.waitForSelector(".heat_legend .steps li");
    expectEqual(await page.textContent("h1"), "Sweep walls", "the head");
    const facts = await page.textContent("main .quiet");
    expect(/over 180 cells, by kerf .*walls: 162 computed, 18 missing\./.test(facts), facts);
    expectEqual(await counted(page), "180 cells count, 162 of them have a number, 18 are missing.", "the counts");
    expectNoComplaints(page);
  },

  async SaysOfATileWhatIsBehindIt({ browser, studio }) {
    const page = await openSweep(
      { browser, studio },
      {},
      "?x=stiffness&y=delay&by=mass&of=spectral_radius&stat=largest",
    );
    const id = await studio.id("files", "walls.merged/sweep.h5");
    const question = {
      id,
      table: "walls",
      by: ["stiffness", "delay", "mass"],
      of: "spectral_radius",
      statistic: "largest",
    };
    const found = (await studio.api("/api/sweep/answer", question)).json;
    await page.focus(".heat_maps canvas");
    await page.keyboard.press("ArrowRight"); // onto the first tile
    for (const key of ["ArrowRight", "ArrowRight", "ArrowUp"]) await page.keyboard.press(key);
    const at = 1 * 15 + 2;
    const words = await said(page);
    expect(words.startsWith("stiffness 268 N/m, delay 0.001 s, mass 0.05 kg: "), words);
    expect(words.includes(`${found.known[at]} of ${found.computed[at]} computed cells have a number`), words);
    const value = Number(/kg: ([^;]+);/.exec(words)[1]);
    expect(Math.abs(value - found.value[at]) <= 0.01 * Math.abs(found.value[at]), `${value} for ${found.value[at]}`);
    const csv = page.getByRole("button", { name: "Save CSV" });
    const [download] = await Promise.all([page.waitForEvent("download"), csv.click()]);
    const [heads, ...rows] = (await readFile(await download.path(), "utf8")).trim().split("\r\n");
    expect(heads.startsWith("stiffness [N/m],delay [s],mass [kg],largest spectral_radius"), heads);
    expectEqual(rows.length, found.value.length, "a row for each part");
    const cells = rows[at].split(",").map(Number);
    const there = found.axes.map((axis, k) => axis.values[[at % 15, 1, 0][k]]);
    expectEqual(cells.slice(0, 5), [...there, found.value[at], found.computed[at]], "what the row is of");
    await page.focus(".heat_maps canvas");
    await page.keyboard.press("PageDown"); // the next panel
    for (let i = 0; i < 20; ++i) await page.keyboard.press("ArrowRight");
    for (let i = 0; i < 3; ++i) await page.keyboard.press("ArrowUp");
    expect(
      /mass 0.1 kg: no number; 0 of 0 computed cells have a number, 2 are missing$|are missing/.test(await said(page)),
      await said(page),
    );
    expectNoComplaints(page);
  },

  async KeepsWhatIsSeenInTheAddress({ browser, studio }) {
    const page = await openSweep({ browser, studio });
    await page.getByRole("combobox", { name: "Across" }).selectOption("damping");
    await page.getByRole("combobox", { name: "Colour" }).selectOption("passive_stiffness");
    await until(
      "the address has it",
      () => page.url().includes("x=damping") && page.url().includes("of=passive_stiffness"),
    );
    await until(
      "it is drawn",
      async () => (await page.textContent(".heat_legend p")) === "mean passive_stiffness [N/m]",
    );
    await page.reload();
    await page.waitForSelector(".heat_legend .steps li");
    expectEqual(await page.getByRole("combobox", { name: "Across" }).inputValue(), "damping", "across, after a reload");
    expectEqual(
      await page.textContent(".heat_legend p"),
      "mean passive_stiffness [N/m]",
      "what is drawn, after a reload",
    );
    await page.goBack();
    await until(
      "the step is undone",
      async () => (await page.getByRole("combobox", { name: "Colour" }).inputValue()) === "comes_to_rest",
    );
    expectEqual(await page.getByRole("combobox", { name: "Across" }).inputValue(), "damping", "the step before stays");
    expectNoComplaints(page);
  },

  async FiltersByABrushAndByHand({ browser, studio }) {
    const page = await openSweep({ browser, studio });
    await page.waitForSelector("g.brush .overlay");
    const axis = page.locator('g.brush[data-axis="delay"] .overlay');
    await axis.scrollIntoViewIfNeeded();
    const box = await axis.boundingBox();
    const middle = box.x + box.width / 2;
    await page.mouse.move(middle, box.y + 1);
    await page.mouse.down();
    await page.mouse.move(middle, box.y + 0.3 * box.height, { steps: 4 });
    await page.mouse.up();
    await until("the brush filters", () => JSON.stringify(where(page)) === '{"delay":["0.004"]}');
    await until("the counts follow", async () => (await counted(page)).startsWith("60 cells count"));
    await page.waitForSelector('g.brush[data-axis="delay"] .selection[height]');
    await page.locator(".filter summary").click();
    await page.getByLabel("0.001", { exact: true }).check();
    await until("a box adds a value", () => JSON.stringify(where(page)) === '{"delay":["0.001","0.004"]}');
    await until("the counts follow", async () => (await counted(page)).startsWith("120 cells count"));
    await page.getByRole("button", { name: "No filter", exact: true }).click();
    await until("all count", async () => (await counted(page)).startsWith("180 cells count"));
    expectNoComplaints(page);
  },

  async PullsABrushAlongAndByItsEndsAndTakesItAway({ browser, studio }) {
    const page = await openSweep({ browser, studio }, {}, `?where=${JSON.stringify({ delay: ["0.001"] })}`);
    const brush = page.locator('g.brush[data-axis="delay"]');
    await brush.scrollIntoViewIfNeeded();
    // From a place of one part to a height of the axis, as a share of it from above.
    const drag = async (part, y, share) => {
      await brush.evaluate((it) => (it.dataset.before = "")); // until the lines are drawn anew
      const box = await brush.locator(part).boundingBox();
      const along = await brush.locator(".overlay").boundingBox();
      await page.mouse.move(box.x + box.width / 2, box.y + y * box.height);
      await page.mouse.down();
      await page.mouse.move(box.x + box.width / 2, along.y + share * along.height, { steps: 4 });
      await page.mouse.up();
    };
    const left = async (cells, ...values) => {
      await until(`delays are ${values}`, () => JSON.stringify(where(page).delay ?? []) === JSON.stringify(values));
      await until("the counts follow", async () => (await counted(page)).startsWith(`${cells} cells count`));
      await page.waitForSelector('g.brush[data-axis="delay"]:not([data-before])');
    };
    await left(60, "0.001");
    await drag(".selection", 0.5, 0); // beyond the upper end, where it stops
    await left(60, "0.004");
    await drag(".handle >> nth=1", 0.5, 0.55);
    await left(120, "0.001", "0.004");
    await drag(".handle >> nth=0", 0.5, 1); // past the other end
    await left(60, "0");
    await drag(".overlay", 0.2, 0.2);
    await left(180);
    expectNoComplaints(page);
  },

  async DrawsTheShareOfCellsWithACondition({ browser, studio }) {
    const page = await openSweep({ browser, studio });
    const share = page.getByLabel("or the share of cells with");
    await share.fill("spectral_radius < 1 & comes_to_rest >= 1");
    await share.press("Enter");
    await until("it is drawn", async () =>
      (await page.textContent(".heat_legend p")).startsWith("share of cells with spectral_radius < 1"),
    );
    expectEqual(await page.locator(".heat_legend .swatch").count(), 10, "tenths");
    await share.fill("spectral_radius is 1");
    await share.press("Enter");
    await page.getByText("'spectral_radius is 1' is no condition").waitFor();
    expectNoComplaints(page, [/400/]);
  },

  async IsAccessible({ browser, studio }) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await openSweep({ browser, studio }, { colorScheme }, "?by=mass,damping");
      await page.waitForSelector("g.brush .overlay");
      expectEqual(await audit(page), [], `complaints, ${colorScheme}`);
    }
  },
};
