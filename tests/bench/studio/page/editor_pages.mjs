// The segment editor: a law is drawn over an averaged cycle by mouse, by keys alone and by numbers, and rendered.

import { existsSync, readFileSync } from "node:fs";
import { copyFile, rm } from "node:fs/promises";
import { join } from "node:path";

import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

/** Opens the editor of cut.h5 from the list of recordings. */
async function openEditor(page, studio) {
  await page.goto(`${studio.url}#/editor`);
  await page.locator(".choices a", { hasText: "cut.h5" }).click();
  await page.locator("g.knot").first().waitFor();
  await page.evaluate(() => new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(go))));
}

const breakpoints = (page, branch = "closing") =>
  page.locator(`g.knot.${branch}`).evaluateAll((nodes) => nodes.map((it) => it.getAttribute("aria-label")));
const count = async (page) => (await breakpoints(page)).length;
const figure = (page, name) => page.textContent(`#error_${name}`);
const error = async (page) => parseFloat(await figure(page, "rmse_jnd"));

/** What a law file says of a list of numbers. */
function numbersIn(file, name) {
  const line = new RegExp(`^${name} = \\{ value = \\[(.*?)\\]`, "m").exec(readFileSync(file, "utf8"));
  return line[1].split(",").map(Number);
}

/** Runs a saved law on the simulated scissors, in virtual time. */
function expectThatItRuns(studio, name) {
  const words = [
    "check",
    `${name}.law.toml`,
    "--device",
    "sim:scissors",
    "--seconds",
    "2",
    "--virtual",
    "--floor",
    "0",
  ];
  const check = studio.kerf(words);
  expectEqual(check.status, 0, `kerf ${words.join(" ")}: ${check.stdout} ${check.stderr}`);
}

async function save(page, name) {
  await page.getByLabel("Name", { exact: true }).fill(name);
  await page.getByRole("button", { name: "Save law" }).click();
}

/** A place of the plot on an averaged curve, in pixels of the window: a share of the way along it. */
async function onCurve(page, branch, share) {
  const box = await page.locator(".xy_plot").boundingBox();
  return page.locator(`.xy_plot .curve.${branch}`).evaluate(
    (curve, { share, box }) => {
      const point = curve.getPointAtLength(share * curve.getTotalLength());
      return { x: box.x + point.x, y: box.y + point.y };
    },
    { share, box },
  );
}

/** A page that is begun anew shows what was drawn, and one step back what it began with; so does a studio at the same address. */
async function keepWhatWasDrawn(page, studio) {
  await openEditor(page, studio);
  const begun = await breakpoints(page);
  const at = await onCurve(page, "closing", 0.4);
  await page.mouse.click(at.x, at.y);
  const drawn = await breakpoints(page);
  expectEqual(drawn.length, begun.length + 1, "breakpoints after a click");
  await page.reload();
  await page.locator("g.knot").first().waitFor();
  expectEqual(await breakpoints(page), drawn, "after a reload");
  const port = new URL(studio.origin).port;
  studio.process.kill("SIGKILL");
  await studio.ended;
  await studio.serve("--port", port);
  await openEditor(page, studio);
  expectEqual(await breakpoints(page), drawn, "after the studio was killed and begun anew");
  await page.getByRole("button", { name: "Undo", exact: true }).click();
  expectEqual(await breakpoints(page), begun, "one step back");
  await page.reload();
  await page.locator("g.knot").first().waitFor();
  expectEqual(await breakpoints(page), begun, "what was taken back stays so");
}

async function drawByMouse(page, studio) {
  await openEditor(page, studio);
  expectEqual(await count(page), 2, "breakpoints at first");
  const caption = await page.textContent("table.figures caption");
  expect(caption.includes("without what cycles differ by"), "it says what the error is towards");
  const before = await error(page);
  for (const share of [0.15, 0.45, 0.7]) {
    const at = await onCurve(page, "closing", share);
    await page.mouse.click(at.x, at.y);
  }
  expectEqual(await count(page), 5, "breakpoints after three clicks");
  expectEqual((await breakpoints(page, "opening")).length, 5, "breakpoints on the other branch");
  expect((await error(page)) < 0.5 * before, "what was drawn is closer than a line");
  expectEqual(await figure(page, "segments"), "4", "segments");

  const drawn = await breakpoints(page);
  const circle = await page.locator("g.knot.closing .mark").nth(2).boundingBox();
  const from = { x: circle.x + 0.5 * circle.width, y: circle.y + 0.5 * circle.height };
  const close = await figure(page, "rmse");
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let step = 1; step <= 10; ++step) await page.mouse.move(from.x + step, from.y + 8 * step);
  expect((await figure(page, "rmse")) !== close, "the error follows while a breakpoint is dragged");
  await page.mouse.up();
  const dragged = await breakpoints(page);
  expect(dragged[2] !== drawn[2], "the drag moved it");
  await page.getByRole("button", { name: "Undo", exact: true }).click();
  expectEqual(await breakpoints(page), drawn, "a drag is one step back");
  await page.getByRole("button", { name: "Redo", exact: true }).click();
  expectEqual(await breakpoints(page), dragged, "and one forth");
  await page.keyboard.press("Control+z");
  expectEqual(await breakpoints(page), drawn, "a key takes it back too");

  await save(page, "by_mouse");
  await page.getByText("kerf check by_mouse.law.toml").waitFor();
  const file = join(studio.folder, "by_mouse.law.toml");
  expectEqual(numbersIn(file, "knot").length, 5, "breakpoints in the file");
  expectThatItRuns(studio, "by_mouse");
}

/** Presses Tab until what has the focus is wanted. */
async function tabTo(page, what, isWanted) {
  for (let presses = 0; presses < 60; ++presses) {
    if (await page.evaluate(isWanted)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`no Tab leads to ${what}`);
}

async function press(page, ...keys) {
  for (const key of keys) await page.keyboard.press(key);
}

async function drawByKeys(page, studio) {
  await page.goto(`${studio.url}#/editor`);
  await page.locator(".choices a").first().waitFor();
  await tabTo(page, "the recording", () => document.activeElement?.textContent === "cut.h5");
  await press(page, "Enter");
  await page.locator("g.knot").first().waitFor();

  await tabTo(page, "the plot", () => document.activeElement?.matches(".xy_plot") ?? false);
  await press(page, "Home", ...Array(25).fill("Shift+ArrowRight"), " ", ...Array(6).fill("Shift+ArrowUp"), "Enter");
  expectEqual(await count(page), 3, "Enter adds at the cursor");
  await press(page, ...Array(20).fill("Shift+ArrowRight"), " ", ...Array(3).fill("Shift+ArrowUp"), "a");
  expectEqual(await count(page), 4, "A adds at the cursor");

  await tabTo(
    page,
    "a breakpoint",
    () => document.activeElement?.getAttribute("aria-label")?.startsWith("Breakpoint 3 of 4, closing") ?? false,
  );
  const [, , before] = await breakpoints(page);
  await press(page, "ArrowUp", "ArrowUp", "Shift+ArrowUp");
  const [, , up] = await breakpoints(page);
  expect(up !== before, "arrows move the breakpoint");
  await press(page, "Control+z");
  expectEqual((await breakpoints(page))[2], before, "nudges of one stay are one step back");
  await press(page, "Control+Shift+z");
  expectEqual((await breakpoints(page))[2], up, "and forth");
  await press(page, "Insert");
  expectEqual(await count(page), 5, "Insert adds beside it");
  await press(page, "Delete");
  expectEqual(await count(page), 4, "Delete removes it");
  expect(
    await page.evaluate(() => document.activeElement?.matches("g.knot") ?? false),
    "the focus stays at a breakpoint",
  );

  await tabTo(page, "the name", () => document.activeElement?.matches(".save input") ?? false);
  await press(page, "Control+a");
  await page.keyboard.type("by_keys");
  await press(page, "Enter");
  await page.getByText("kerf check by_keys.law.toml").waitFor();
  expectThatItRuns(studio, "by_keys");
}

async function workOnALaw(page, studio) {
  await openEditor(page, studio);
  await page.locator(".optima select").selectOption("4");
  await page.getByRole("button", { name: "Fill in the best" }).click();
  await until("the best breakpoints are filled in", async () => (await count(page)) === 5);
  const best = await error(page);
  await page.getByLabel("Closing force of breakpoint 3 in N").fill("2.5");
  await page.keyboard.press("Tab");
  expect((await error(page)) > best, "a number that was changed is drawn");
  expect((await breakpoints(page))[2].endsWith("2.5 N"), "as it was given");
  await page.getByRole("button", { name: "Best forces here" }).click();
  await until("the best forces are back", async () => (await error(page)) === best);
  await page.getByLabel("Penetration of breakpoint 2", { exact: false }).fill("9999");
  await page.keyboard.press("Tab");
  await page.locator("#notice.wrong", { hasText: "must be deeper" }).waitFor();

  await save(page, "worked");
  await page.getByText("kerf check worked.law.toml").waitFor();
  const file = join(studio.folder, "worked.law.toml");
  const saved = numbersIn(file, "closing");
  await page.getByRole("button", { name: "Undo", exact: true }).click();
  await page.getByRole("button", { name: "Save law" }).click();
  await page.getByRole("button", { name: "Keep it" }).click();
  expectEqual(numbersIn(file, "closing"), saved, "a law that is there is kept");
  await page.getByRole("button", { name: "Save law" }).click();
  await page.getByRole("button", { name: "Replace it" }).click();
  await page.getByText("kerf check worked.law.toml").waitFor();
  expect(numbersIn(file, "closing")[2] !== saved[2], "and replaced when that is asked for");

  await page.getByRole("button", { name: "Opening as its own branch" }).click();
  expectEqual((await breakpoints(page, "opening")).length, 0, "one branch");
  await save(page, "one_branch");
  await page.getByText("kerf check one_branch.law.toml").waitFor();
  expectThatItRuns(studio, "one_branch");

  await page.reload();
  await page.locator("g.knot").first().waitFor();
  expectEqual((await breakpoints(page, "opening")).length, 0, "one branch, as it was left");
  await page.getByLabel("Start from law").selectOption({ label: "worked.law.toml" });
  await until("the law's breakpoints are there", async () => (await breakpoints(page, "opening")).length === 5);
  await save(page, "again");
  await page.getByText("kerf check again.law.toml").waitFor();
  for (const part of ["knot", "closing", "opening"])
    expectEqual(
      numbersIn(join(studio.folder, "again.law.toml"), part),
      numbersIn(file, part),
      `${part} of a law that was gone on with`,
    );
}

/** Nothing runs, so that there is nothing to feel it on; Escape is the loop's and leaves the drawing as it is. */
async function leaveTheLoopAlone(page, studio) {
  await openEditor(page, studio);
  await page.getByRole("button", { name: "Feel it now" }).click();
  await page.locator("#notice.wrong").waitFor();
  const at = await onCurve(page, "closing", 0.5);
  await page.mouse.click(at.x, at.y);
  const drawn = await breakpoints(page);
  await page.keyboard.press("Escape");
  expectEqual(await breakpoints(page), drawn, "what Escape leaves");
  expect(!existsSync(join(studio.folder, "cut_drawn.law.toml")), "nothing is saved unasked");
}

/** On a running loop: the law once, then along with every change, and not past a zero force. */
async function feelWhileDrawing(page, studio) {
  await openEditor(page, studio);
  const started = await studio.api("/api/live/start", { device: "sim:scissors", rate_hz: 500 });
  expectEqual(started.status, 200, `the loop starts: ${JSON.stringify(started.json)}`);
  const law = async () => (await studio.api("/api/live/status")).json.law;
  await page.getByRole("button", { name: "Feel it now" }).click();
  await page.locator("#notice", { hasText: "renders the drawn law" }).waitFor();
  await until("the loop renders it", async () => (await law()) === "a drawn law");
  await studio.api("/api/live/feel", {});
  await until("the loop renders nothing", async () => (await law()) === "");
  let sent = 0;
  page.on("request", (request) => (sent += request.url().includes("/api/editor/feel") ? 1 : 0));
  await page.getByRole("button", { name: "Feel while drawing" }).click();
  await until("the loop renders what is drawn", async () => (await law()) === "a drawn law");
  await page.locator("g.knot.closing").nth(1).focus();
  const begin = Date.now();
  for (let nudge = 0; nudge < 60; ++nudge) await page.keyboard.press("ArrowUp");
  const seconds = (Date.now() - begin) / 1000;
  expect(sent <= 2 + 4 * seconds, `${sent} laws in ${seconds} s are at most 4 a second`);
  await page.keyboard.press("Escape");
  await until("the force is released", async () => (await studio.api("/api/live/status")).json.released);
  await page.getByRole("button", { name: "Feel it now" }).click();
  await page.locator("#notice", { hasText: "Zero force stays on" }).waitFor();
  expect((await studio.api("/api/live/status")).json.released, "a law that is felt leaves it released");
}

const optionsOf = (page, name) => page.getByLabel(name).locator("option").allTextContents();

/** Wherever laws are picked, one that was saved can be, and one that is gone cannot, without a reload. */
async function pickWhatIsThere(page, studio) {
  await openEditor(page, studio);
  expectEqual(await optionsOf(page, "Start from law"), ["none here fits"], "laws at first");
  await save(page, "drawn");
  await until("it can be started from", async () =>
    (await optionsOf(page, "Start from law")).includes("drawn.law.toml"),
  );

  await page.goto(studio.page("stability"));
  await page.getByLabel("Map of").selectOption({ label: "drawn.law.toml" });
  await copyFile(join(studio.folder, "drawn.law.toml"), join(studio.folder, "beside.law.toml"));
  await until("another is offered", async () => (await optionsOf(page, "Map of")).includes("beside.law.toml"));
  expectEqual(
    await page.getByLabel("Map of").inputValue(),
    await studio.id("laws", "drawn.law.toml"),
    "what is picked",
  );
  await page.getByLabel("Depth of the tool [mm]").waitFor();
  await rm(join(studio.folder, "drawn.law.toml"));
  await until("it is gone", async () => !(await optionsOf(page, "Map of")).includes("drawn.law.toml"));
  expectEqual(await page.getByLabel("Map of").inputValue(), "", "walls are mapped where the law is gone");
  await page.getByLabel("Depth of the tool [mm]").waitFor({ state: "hidden" });

  await page.goto(studio.page("scope"));
  await until("the scope has it", async () => (await optionsOf(page, "Law to feel")).includes("beside.law.toml"));
  await rm(join(studio.folder, "beside.law.toml"));
  await until("nor has the scope", async () => (await optionsOf(page, "Law to feel")).join() === "nothing");
}

/** A studio and a page for each. */
function alone(part, except = []) {
  return async ({ browser, studio, screenshots }) => {
    studio.record();
    await studio.serve();
    const page = await openPage(browser);
    await part(page, studio);
    await page.screenshot({ path: join(screenshots, `editor_${part.name}.png`) });
    expectNoComplaints(page, except);
  };
}

const refused = [/status of 4\d\d/]; // what the browser says of an answer that a test asks for

export const tests = {
  "a law is drawn by mouse, taken back, saved and runs": alone(drawByMouse),
  "what was drawn outlives the page and the studio": alone(keepWhatWasDrawn, [
    /ERR_CONNECTION_(REFUSED|RESET)/,
    /status of 403/,
  ]),
  "a law is drawn, changed and saved by keys alone": alone(drawByKeys),
  "a law is made by numbers and optima, replaced and gone on with": alone(workOnALaw, refused),
  "a law is felt while it is drawn": alone(feelWhileDrawing),
  "laws are picked from among those that are there": alone(pickWhatIsThere),
  "the loop is left alone": alone(leaveTheLoopAlone, refused),
};
