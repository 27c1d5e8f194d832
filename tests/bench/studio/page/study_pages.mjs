// Studies: the list, a study's page held to what kerf study wrote, its way to the recordings, the report and the tables.

import { appendFile, mkdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

/**
 * A punch of a spring that gets stiffer, in and out eight times; `put_down`: the last time it stays in, out of contact;
 * `limit`: the fifth goes deeper, and no force is larger.
 */
export function punch(stiffness, { put_down = false, limit = Infinity } = {}) {
  const rows = ["Time [s]\tPosition [mm]\tForce [N]"];
  const period = 0.5;
  const moved = 8 * period;
  const end = put_down ? moved + 4 : moved;
  for (let i = 0; i < end * 200; ++i) {
    const time = i / 200;
    const last = put_down && time > moved - period / 2;
    const deepest = limit < Infinity && Math.floor(time / period) === 4 ? 5.5 : 5;
    const depth = last ? 5 : (deepest / 2) * (1 - Math.cos((2 * Math.PI * time) / period));
    const noise = 0.002 * Math.sin(1.7 * i * i);
    const force = last && time > moved ? noise : (stiffness * depth) / 1000 + 0.02 * depth * depth + noise;
    rows.push(`${time.toFixed(3)}\t${depth.toFixed(5)}\t${Math.min(force, limit).toFixed(5)}`);
  }
  return `${rows.join("\n")}\n`;
}

/** A drawer in the workspace with a study of it that was run: two tissues, a flagged cycle, a file that cannot be used. */
export async function makeStudy(studio) {
  const drawer = join(studio.folder, "drawer");
  await mkdir(drawer);
  for (const specimen of [1, 2]) {
    await writeFile(join(drawer, `liver_s${specimen}.txt`), punch(200 + 10 * specimen));
    await writeFile(join(drawer, `skin_s${specimen + 2}.txt`), punch(400 + 10 * specimen));
  }
  await writeFile(join(drawer, "skin_s5.txt"), punch(405, { put_down: true }));
  await writeFile(join(drawer, "skin_s6.txt"), punch(395));
  await writeFile(join(drawer, "notes.md"), "# What was cut\n");
  const map = "time=1[s],position=2[mm],force=3[N]";
  studio.kerfOrThrow("study", "new", "drawer", "--laws", "kelvin,exponential", "--map", map, "-o", "cuts");
  await writeFile(join(drawer, "skin_s6.txt"), "gone\n");
  const ran = studio.kerf("study", "run", "cuts/study.toml"); // 1: a file could not be used
  if (ran.status > 1) throw new Error(ran.stderr);
}

async function prepare({ browser, studio }, options = {}) {
  if (!studio.process) {
    await makeStudy(studio);
    await studio.serve();
  }
  return openPage(browser, options);
}

async function openStudy(page, studio) {
  await page.goto(studio.page("studies"));
  await page.click("table.studies a");
  await page.waitForSelector("table.drawer");
}

const found = async (studio) => JSON.parse(await readFile(join(studio.folder, "cuts/study.json"), "utf8"));

export const tests = {
  async ListsStudiesWithTheirState({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await page.goto(studio.page("studies"));
    await page.waitForSelector("table.studies");
    const cells = await page.locator("table.studies tbody tr :is(th, td)").allTextContents();
    expectEqual(
      cells.slice(0, 6),
      ["cuts", "● run", "6", "5", "1", "0"],
      "name, state, recordings, how many count, failed, doubted",
    );
    expectEqual(cells[6], "liver, skin", "tissues");
    await appendFile(join(studio.folder, "cuts/study.toml"), "# a word\n");
    await page.reload();
    await until("it has changed", async () => (await page.textContent("table.studies td")) === "◐ changed since");
    expectNoComplaints(page);
  },

  async ShowsWhatAStudyFound({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await openStudy(page, studio);
    const results = await found(studio);
    expectEqual(await page.textContent("h1"), "Study cuts", "the head");
    expectEqual(
      await page.locator(".conclusions li p").evaluateAll((all) => all.map((it) => it.lastChild.textContent)),
      results.conclusions.map((it) => it.sentence),
      "the conclusions",
    );
    const rows = page.locator("table.drawer tbody tr");
    expectEqual(await rows.count(), results.recordings.length, "rows of the drawer");
    expectEqual(await page.locator("table.drawer tr.failed").count(), 1, "a file that failed");
    const failed = results.recordings.find((it) => it.failure !== null);
    const said = await page.textContent("table.drawer tr.failed td:last-child");
    expect(said.includes(failed.failure), `${failed.failure} in ${said}`);
    await page.waitForFunction(() => document.querySelectorAll(".small_plot").length === 5);
    const label = await page.locator(".small_plot").last().getAttribute("aria-label");
    expect(/^skin_s5: force \[N\] over penetration \[mm\]; points: .*flagged/.test(label), label);
    await page.locator("table.drawer tr", { hasText: "skin_s5" }).locator("summary").first().click();
    await page
      .getByText(/cycle 8: .*the tool was put down/)
      .first()
      .waitFor();
    expectNoComplaints(page);
  },

  async LeadsToARecordingTheReportAndTheTables({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await openStudy(page, studio);
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("text=cycles.csv")]);
    const table = await readFile(join(studio.folder, "cuts/tables/cycles.csv"), "utf8");
    expectEqual(await readFile(await download.path(), "utf8"), table, "the table");
    const [report] = await Promise.all([page.context().waitForEvent("page"), page.click("text=Report")]);
    await report.waitForSelector("h1");
    expectEqual(await report.textContent("h1"), "Study cuts", "the report's head");
    const style = await report.evaluate(() => getComputedStyle(document.querySelector("p.answer")).borderLeftWidth);
    expect(style !== "0px", "the report has its styles");
    const address = report.url();
    expect(!address.includes(studio.token), "its address does not tell the token");
    await report.reload();
    expectEqual(await report.textContent("h1"), "Study cuts", "it is there again after a reload");
    const status = async (at) => (await fetch(at)).status;
    expectEqual(await status(address), 200, "for whoever is given the address");
    const elsewhere = address.replace("/api/study/report", "/api/study");
    expectEqual(
      [await status(elsewhere), await status(`${studio.origin}/?key=${new URL(address).searchParams.get("key")}`)],
      [403, 403],
      "and nothing else",
    );
    await report.close();
    await page.locator("table.drawer").getByRole("link", { name: "liver_s1" }).click();
    await page.waitForSelector(".time_plot");
    expectEqual(await page.textContent("h1"), "cuts/recordings/liver_s1/recording.h5", "the recording");
    expectNoComplaints(page);
  },

  async ShowsAStudyThatWasNotRun({ browser, studio }) {
    await mkdir(join(studio.folder, "drawer"));
    await writeFile(join(studio.folder, "drawer", "liver_s1.txt"), punch(200));
    studio.kerfOrThrow("study", "new", "drawer", "-o", "cuts");
    await studio.serve();
    const page = await openPage(browser);
    await openStudy(page, studio);
    expectEqual(
      await page.textContent(".state"),
      "○ not run Look through its study.toml, then: kerf study run cuts/study.toml",
      "state",
    );
    expectEqual(await page.locator("table.drawer tbody tr").count(), 1, "what takes part");
    expectEqual(await audit(page), [], "complaints");
    await writeFile(join(studio.folder, "cuts/study.toml"), "version = 7\n");
    await page.goto(studio.page("studies"));
    await page.getByText(/Cannot be read: .*expected version = 1/).waitFor();
    expectNoComplaints(page);
  },

  async IsAccessible({ browser, studio }) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await prepare({ browser, studio }, { colorScheme });
      await page.goto(studio.page("studies"));
      await page.waitForSelector("table.studies");
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, the list`);
      await openStudy(page, studio);
      for (const summary of await page.locator("summary").all()) await summary.click();
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, a study`);
    }
  },
};
