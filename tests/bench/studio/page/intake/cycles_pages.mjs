// Cycles found by other settings, mended by hand, and kept in the recording.

import { rmSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

import { audit } from "../accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "../harness.mjs";

async function prepare({ browser, studio }, options = {}) {
  if (!studio.process) {
    studio.record("cut.h5", 20);
    await studio.serve();
  }
  return openCycles(await openPage(browser, options), studio);
}

async function openCycles(page, studio, cycle) {
  const id = await studio.id("recordings", "cut.h5");
  await page.goto(studio.page(`recording/${id}/cycles${cycle ? `?cycle=${cycle}` : ""}`));
  await page.waitForSelector(".cycle_list li");
  return page;
}

const view = async (studio) => (await studio.api(`/api/cycles?id=${await studio.id("recordings", "cut.h5")}`)).json;
const info = (studio) => JSON.parse(studio.kerfOrThrow("info", "cut.h5", "--json").stdout).cycles;
const count = (page) => page.locator(".cycle_list li").count();
const state = (page) => page.textContent(".save_bar [role=status]");
/** Waits until all is kept; what stands in the way is told. */
const saved = (page) =>
  until(
    `it is saved`,
    async () => {
      const trouble = page.locator(".cycle_trouble");
      if (await trouble.isVisible()) throw new Error(`it is not saved: ${await trouble.textContent()}`);
      return (await state(page)) === "as saved";
    },
    60000,
  );
const save = (page) => page.locator(".save_bar button.firm").click();

/** Chooses a cycle, and gives back the handle of the begin of its closing. */
async function handleOf(page, cycle) {
  await page
    .getByRole("button", { name: `Show cycle ${cycle}`, exact: true })
    .first()
    .click();
  const handle = page.locator(".cycle_handle[aria-label='Boundary: closing begins']");
  await until("it has handles", async () =>
    (await handle.getAttribute("aria-valuetext"))?.startsWith(`cycle ${cycle}:`),
  );
  let was = "";
  await until("they have come to rest", async () => {
    await page.waitForTimeout(150);
    const now = JSON.stringify(await handle.boundingBox());
    const rests = now === was;
    was = now;
    return rests;
  });
  return handle;
}

async function drag(page, handle, pixels) {
  const { x, y, width, height } = await handle.boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + pixels / 2, y + height / 2);
  await page.mouse.move(x + width / 2 + pixels, y + height / 2);
  await page.mouse.up();
}

/** Drags, and gives back the row where the boundary comes to rest. */
async function dragged(page, handle, pixels) {
  const row = async () => Number(await handle.getAttribute("aria-valuenow"));
  const was = await row();
  await drag(page, handle, pixels);
  let before = was;
  await until("the boundary rests elsewhere", async () => {
    await page.waitForTimeout(300);
    const now = await row();
    const rests = now === before && now !== was;
    before = now;
    return rests;
  });
  return before;
}

export const tests = {
  async DragsABoundaryTakesItBackAndKeepsIt({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const before = await view(studio);
    const handle = await handleOf(page, 2);
    const row = async () => Number(await handle.getAttribute("aria-valuenow"));
    const was = await row();
    await drag(page, handle, 12);
    await until("it has moved", async () => (await row()) > was);
    const to = await row();
    await page.getByRole("button", { name: "Undo", exact: true }).click();
    await until("it is back", async () => (await row()) === was);
    await page.getByRole("button", { name: "Redo", exact: true }).click();
    await until("it is forth again", async () => (await row()) === to);
    await page.getByLabel("Edited by").fill("Anna Ω");
    await save(page);
    await saved(page);
    const [edit] = info(studio).edits;
    expectEqual(edit.author, "Anna Ω", "who has edited");
    expect(edit.what.includes("cycle 2: closing begins at") && edit.what.includes(`(row ${to})`), edit.what);
    studio.kerfOrThrow("validate", "cut.h5");
    await page.getByRole("button", { name: "Undo", exact: true }).click();
    await until("what was saved can be taken back", async () => (await state(page)) === "not saved");
    await save(page);
    await saved(page);
    const after = await view(studio);
    expectEqual(after.phases, before.phases, "phases, as they were before");
    expectEqual(after.average, before.average, "averages, as they were before");
    expectNoComplaints(page);
  },

  async NudgesByTheKeys({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const handle = await handleOf(page, 3);
    const row = async () => Number(await handle.getAttribute("aria-valuenow"));
    const was = await row();
    await handle.focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Shift+ArrowLeft");
    await until("rows by one and by ten", async () => (await row()) === was - 8);
    await page.keyboard.press("Control+z");
    await until("nudges of one handle are one step", async () => (await row()) === was);
    expectNoComplaints(page);
  },

  async FindsCyclesWhileSettingsChange({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const all = await count(page);
    let asked = 0;
    await page.route("**/api/cycles/look", async (route) => {
      const { settings } = route.request().postDataJSON();
      ++asked;
      if (settings && settings.prominence < 0.5) await new Promise((go) => setTimeout(go, 1500)); // a late answer
      await route.continue().catch(() => {});
    });
    await page.getByText("How cycles are found").click();
    const stroke = page.getByLabel("A stroke covers [% of the range]");
    await stroke.fill("20");
    await until("it is asked for", () => asked > 0);
    await page.getByLabel("Closing is").selectOption("decreasing");
    await stroke.fill("60");
    await until(
      "the last one is shown",
      async () => (await page.textContent(".save_bar button.firm")) === "Save these cycles",
    );
    await page.waitForTimeout(2000);
    const { draft } = JSON.parse(
      await page.evaluate(() => Object.entries(sessionStorage).find(([key]) => key.startsWith("kerf-cycles-"))[1]),
    );
    expectEqual(draft.settings.prominence, 0.6, "the settings of what is shown, though an answer came later");
    await page.getByRole("button", { name: "Undo", exact: true }).click();
    await until("it is as it was", async () => (await state(page)) === "as saved" && (await count(page)) === all);
    await page.getByRole("button", { name: "Redo", exact: true }).click();
    await save(page);
    await saved(page);
    expectEqual((await view(studio)).closing_direction, -1, "the direction of closing");
    expect(info(studio).edits[0].what.startsWith("found anew"), info(studio).edits[0].what);
    expectNoComplaints(page);
  },

  async LeavesACycleOutAndTakesItBack({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await page.getByLabel("Why a cycle is left out or taken").fill("the tissue slipped");
    await page.getByRole("button", { name: "Leave out cycle 4" }).click();
    await until("it is left out", async () =>
      (await page.textContent(".cycle_list li:nth-child(4)")).includes("the tissue slipped"),
    );
    await save(page);
    await saved(page);
    expectEqual(info(studio).flagged, [4, 10], "cycles that fits leave out; the last never opens again");
    await page.getByRole("button", { name: "Restore cycle 4" }).click();
    await save(page);
    await until("it is taken back", () => info(studio).flagged.length === 1);
    expectNoComplaints(page);
  },

  async SplitsACycleAndMergesItAgain({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const before = await view(studio);
    const all = await count(page);
    await handleOf(page, 3);
    await page.keyboard.press("m");
    await until("two are one", async () => (await count(page)) === all - 1);
    await page.getByRole("button", { name: "Undo", exact: true }).click();
    await until("they are two again", async () => (await count(page)) === all);
    await page.getByRole("button", { name: "Merge with the next" }).click();
    await until("by a button too", async () => (await count(page)) === all - 1);
    await page.getByLabel("Edited by").fill("Mo");
    await save(page);
    await saved(page);
    expect(info(studio).edits[0].what.startsWith("cycles 3 and 4, which met at"), info(studio).edits[0].what);
    expectEqual(info(studio).count, all - 1, "cycles in the recording");

    // By the pointer: in the closing of what was the fourth.
    await page.getByRole("button", { name: "Show cycle 3", exact: true }).first().click();
    const { begin, end } = await page.evaluate(() => {
      const handles = [...document.querySelectorAll(".cycle_handle")].map((it) => it.getBoundingClientRect().x + 12);
      return { begin: Math.min(...handles), end: Math.max(...handles) };
    });
    const over = await page.locator(".cycle_plots .time_over").first().boundingBox();
    await page.getByRole("button", { name: "Split …" }).click();
    await page.mouse.click(begin + 0.5 * (end - begin), over.y + over.height / 2);
    await until("one is two", async () => (await count(page)) === all);
    await page.keyboard.press("Control+z");
    await until("it is one again", async () => (await count(page)) === all - 1);
    await page.mouse.move(begin + 0.5 * (end - begin), over.y + over.height / 2);
    await page.keyboard.press("s");
    await until("by its key it is two", async () => (await count(page)) === all);
    await save(page);
    await saved(page);
    expect(/^cycle 3 split at .* into 3 and 4$/.test(info(studio).edits[1].what), info(studio).edits[1].what);
    studio.kerfOrThrow("validate", "cut.h5");
    const after = await view(studio);
    expectEqual(
      after.phases.map((it) => it[0]),
      before.phases.map((it) => it[0]),
      "cycles of the phases",
    );
    expectNoComplaints(page);
  },

  async SaysWhyACycleCannotBeSplit({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const all = await count(page);
    await handleOf(page, 3);
    const x = await page.evaluate(() =>
      Math.max(...[...document.querySelectorAll(".cycle_handle")].map((it) => it.getBoundingClientRect().x + 12)),
    );
    const over = await page.locator(".cycle_plots .time_over").first().boundingBox();
    await page.mouse.move(x - 20, over.y + over.height / 2); // in its opening, beside the handle
    await page.keyboard.press("s");
    await until("why not is said", async () => (await page.textContent(".cycle_trouble")).includes("hold no closing"));
    expectEqual(await count(page), all, "cycles");
    expectEqual(await state(page), "as saved", "nothing has changed");
    expectNoComplaints(page, [/400/]);
  },

  async RefusesTheSecondOfTwoTabsAndLosesNothing({ browser, studio }) {
    const [one, two] = [await prepare({ browser, studio }), await prepare({ browser, studio })];
    await dragged(one, await handleOf(one, 2), 12);
    const wanted = await dragged(two, await handleOf(two, 3), 12);
    await one.getByLabel("Edited by").fill("One");
    await two.getByLabel("Edited by").fill("Two");
    await save(one);
    await saved(one);
    await save(two);
    await until("the second is refused in a line", async () =>
      (await two.textContent(".cycle_trouble")).includes("have changed since you began. One saved at"),
    );
    const refusal = await two.textContent(".cycle_trouble");
    expect(!/\dT\d\d:/.test(refusal) && /saved at \d+ \w+ \d{4}, \d\d:\d\d/.test(refusal), `by the wall: ${refusal}`);
    await two.getByRole("button", { name: "Load them, mine on top" }).click();
    await until("its own change is there still", async () => (await state(two)) === "not saved");
    await save(two);
    await saved(two);
    expectEqual(
      info(studio).edits.map((it) => it.author),
      ["One", "Two"],
      "both edits",
    );
    const { phases } = await view(studio);
    expectEqual(phases.find((it) => it[0] === 3 && it[1] === 3)[2], wanted, "the row of the second");
    expectNoComplaints(two, [/409/]);
  },

  async PutsOneEditOnTopOfAnotherWhereNobodyHadSavedCycles({ browser, studio }) {
    const punch = fileURLToPath(new URL("../../../../../examples/data/punch.txt", import.meta.url));
    const map = "time=time,position=angle,force=force";
    studio.kerfOrThrow("import", punch, "--map", map, "-o", "cut.h5"); // whose cycles are found unasked
    await studio.serve();
    const [one, two] = [await prepare({ browser, studio }), await prepare({ browser, studio })];
    const first = await dragged(one, await handleOf(one, 2), 12);
    const second = await dragged(two, await handleOf(two, 3), 12);
    await save(one);
    await saved(one);
    await one.getByRole("button", { name: "Undo", exact: true }).click();
    await until(
      "the first save leaves what was before to come back to",
      async () => (await state(one)) === "not saved",
    );
    await one.getByRole("button", { name: "Redo", exact: true }).click();
    await until("and it stands as saved again", async () => (await state(one)) === "as saved");
    await save(two);
    await two.getByRole("button", { name: "Load them, mine on top" }).click();
    await until("its own change is there still", async () => (await state(two)) === "not saved");
    await save(two);
    await saved(two);
    const { phases } = await view(studio);
    const closing = (cycle) => phases.find((it) => it[0] === cycle && it[1] === 3)[2];
    expectEqual([closing(2), closing(3)], [first, second], "the rows of both");
    expectNoComplaints(two, [/409/]);
  },

  async LosesNothingWhereTheRecordingOrTheStudioGoes({ browser, studio }) {
    let page = await prepare({ browser, studio });
    const wanted = await dragged(page, await handleOf(page, 2), 12);
    await page.reload();
    await until("it outlives a reload", async () => (await state(page)) === "not saved");
    const context = page.context();
    await page.close();
    const other = await openCycles(await context.newPage(), studio, 2);
    await until("it outlives its tab", async () => (await state(other)) === "not saved");
    expect((await other.textContent("#notice")).includes("as they were left"), "and says what it is");
    await other.getByRole("button", { name: "Undo", exact: true }).click();
    await until("which can be undone", async () => (await state(other)) === "as saved");
    await other.getByRole("button", { name: "Redo", exact: true }).click();
    page = other;
    await studio.stop("SIGKILL");
    await save(page);
    await until("that nobody answers is said", async () =>
      (await page.textContent(".cycle_trouble")).includes("does not answer"),
    );
    await studio.serve();
    await openCycles(page, studio, 2); // another port: another origin, as the studio's address says
    await page.context().close();

    const again = await prepare({ browser, studio });
    await dragged(again, await handleOf(again, 2), 12);
    rmSync(join(studio.folder, "cut.h5"));
    await save(again);
    await until("that it is gone is said", async () =>
      (await again.textContent(".cycle_trouble")).includes("no such recording"),
    );
    expectEqual(await state(again), "not saved", "what was changed is still there");
    studio.record("cut.h5", 20);
    await save(again);
    await until("that another took its place is said", async () =>
      (await again.textContent(".cycle_trouble")).includes("Another recording has taken the place"),
    );
    await again.getByRole("button", { name: "Read that one, without what was changed here" }).click();
    await until("the other one is read", async () => (await state(again)) !== "not saved");
    expect(await again.locator(".cycle_trouble").isHidden(), "nothing is in the way any more");
    expect(wanted > 0, "a boundary was moved");
  },

  async TellsOfFitsOfEarlierCycles({ browser, studio }) {
    studio.record("cut.h5", 20);
    studio.kerfOrThrow("fit", "cut.h5", "--models", "kelvin", "--folds", "2", "-o", "cut.fit");
    await studio.serve();
    const page = await prepare({ browser, studio });
    expect(await page.locator(".earlier_fits").isHidden(), "the fit is of these cycles");
    await page.getByRole("button", { name: "Leave out cycle 4" }).click();
    await save(page);
    await until("the fit is said to be of earlier ones", async () =>
      ((await page.textContent(".earlier_fits").catch(() => "")) ?? "").includes("cut.fit: It is of earlier cycles"),
    );
    expectNoComplaints(page);
  },

  async IsAccessible({ browser, studio, screenshots }) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await prepare({ browser, studio }, { colorScheme });
      await handleOf(page, 2);
      await page.waitForSelector(".inspection table");
      await page.locator(".cycle_loop .legend", { hasText: "cycle 2" }).waitFor();
      await until("it rests", async () => (await state(page)) === "as saved");
      await page.screenshot({ path: join(screenshots, `cycles-${colorScheme}.png`) });
      expectEqual(await audit(page), [], `complaints, ${colorScheme}`);
      await page.context().close();
    }
  },
};
