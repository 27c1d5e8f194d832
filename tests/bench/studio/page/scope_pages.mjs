// The scope, and what has to work when nothing else does: recordings, zero force, a studio that is killed.

import { existsSync, readdirSync } from "node:fs";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";

import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

async function openScope(browser, studio, options = {}) {
  const page = await openPage(browser, options);
  await page.goto(studio.page("scope"));
  await page.getByRole("heading", { name: "Scope" }).waitFor();
  return page;
}

async function startLoop(page) {
  await page.getByRole("button", { name: "Start", exact: true }).click();
  await page.getByText("Running at 1000 Hz").waitFor();
}

const status = async (studio) => (await studio.api("/api/live/status")).json;

/** What a plot shows, as a number that changes with every pixel. */
async function picture(page) {
  const bytes = await page.locator("#view").screenshot();
  let sum = 0;
  for (const byte of bytes) sum = (sum * 31 + byte) >>> 0;
  return sum;
}

async function record(page, studio, name) {
  await page.getByLabel("New recording's name").fill(name);
  await page.getByRole("button", { name: "Record", exact: true }).click();
  await until("a second is recorded", async () => (await status(studio)).recording?.rows >= 1000);
}

export const tests = {
  async "a trace moves, and what is recorded is a recording"({ browser, studio, screenshots }) {
    await studio.serve();
    const page = await openScope(browser, studio);
    await startLoop(page);
    const first = await picture(page);
    await until("the trace has moved", async () => (await picture(page)) !== first);
    await record(page, studio, "live");
    await page.screenshot({ path: join(screenshots, "scope_recording.png") });
    await page.getByRole("button", { name: "Stop recording" }).click();
    await page.getByRole("link", { name: "Saved as live.h5" }).waitFor();
    await until("the recording is there", () => existsSync(join(studio.folder, "live.h5")));
    expectEqual(studio.kerf("validate", "live.h5").status, 0, "kerf validate live.h5");
    const facts = JSON.parse(studio.kerfOrThrow("info", "live.h5", "--json").stdout);
    expect(facts.samples >= 1000, `${facts.samples} rows are recorded`);
    await page.goto(studio.page("recordings"));
    await page.locator("main").getByRole("link", { name: "live.h5", exact: true }).click();
    await page.getByRole("heading", { name: "live.h5" }).waitFor();
    expectNoComplaints(page);
  },

  async "a paused scope stands still, and goes on"({ browser, studio }) {
    await studio.serve();
    const page = await openScope(browser, studio);
    await startLoop(page);
    await page.getByRole("button", { name: "Pause" }).click();
    const plots = page.locator(".time_over canvas").first();
    const look = async () => (await plots.screenshot()).toString("base64");
    await page.waitForTimeout(300);
    const still = await look();
    await page.waitForTimeout(500);
    expectEqual((await look()) === still, true, "nothing moves");
    await page.getByRole("button", { name: "Go on" }).click();
    await until("the trace moves again", async () => (await look()) !== still);
  },

  async "the button takes the force at once, and lets it back"({ browser, studio }) {
    await studio.serve();
    const page = await openScope(browser, studio);
    await startLoop(page);
    await page.getByRole("button", { name: "Zero force" }).click();
    await until("the force is released", async () => (await status(studio)).released);
    await page.getByRole("button", { name: "Let force back" }).click();
    await until("the force is back", async () => !(await status(studio)).released);
    await page.keyboard.press("Escape");
    await until("Escape releases it too", async () => (await status(studio)).released);
  },

  async "a law is rendered by a press alone, and only one that suits the device"({ browser, studio, screenshots }) {
    const example = new URL("../../../../examples/kelvin.law.toml", import.meta.url);
    const law = await readFile(example, "utf8");
    for (const name of ["a", "b", "c"]) await writeFile(join(studio.folder, `${name}.law.toml`), law);
    await writeFile(join(studio.folder, "punch.law.toml"), law.replace("axis = 'theta'", "axis = 'punch'"));
    await studio.serve();
    const page = await openScope(browser, studio);
    await startLoop(page);
    const rendered = (what) => page.getByText(`Rendered now: ${what}`, { exact: true }).waitFor();
    await rendered("nothing");
    let orders = 0;
    page.on("request", (request) => (orders += request.url().includes("/feel") ? 1 : 0));
    const list = page.getByLabel("Law to feel");
    await list.focus();
    for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowDown");
    expectEqual([orders, (await status(studio)).law], [0, ""], "what going through the list renders");
    expectEqual(await list.inputValue(), await studio.id("laws", "c.law.toml"), "the last that suits");
    const punch = list.locator("option", { hasText: "punch" });
    expectEqual(await punch.textContent(), "punch.law.toml (for punch in rad, N)", "why it does not suit");
    expect(await punch.evaluate((it) => it.disabled), "it cannot be picked");
    await page.getByRole("button", { name: "Render" }).click();
    await rendered("c");
    expectEqual([orders, (await status(studio)).law], [1, "c.law.toml"], "what is rendered");
    await page.screenshot({ path: join(screenshots, "scope_law.png") });
    await page.keyboard.press("Escape");
    await page.getByText("Held back: c", { exact: true }).waitFor();
    await page.getByRole("button", { name: "Let force back" }).click();
    await rendered("c");
    const refused = await studio.api("/api/live/feel", { law: await studio.id("laws", "punch.law.toml") });
    expectEqual(refused.status, 400, "past the page");
    expect(refused.json.error.includes("the law is for axis 'punch' (N over rad)"), refused.json.error);

    // What somebody renders elsewhere shows here, and leaves the list as it is.
    await studio.api("/api/live/feel", { toml: law });
    await rendered("kelvin");
    expectEqual(await list.inputValue(), await studio.id("laws", "c.law.toml"), "what is picked");
    await writeFile(join(studio.folder, "d.law.toml"), law);
    await until("a new law is offered", async () =>
      (await list.locator("option").allTextContents()).includes("d.law.toml"),
    );
    expectEqual(await list.inputValue(), await studio.id("laws", "c.law.toml"), "what stays picked");
    expect(await punch.evaluate((it) => it.disabled), "what does not suit still cannot be picked");
    await list.selectOption({ label: "nothing" });
    await page.getByRole("button", { name: "Render" }).click();
    await rendered("nothing");
    expectNoComplaints(page);
  },

  async "a law that is drawn is shown as rendered"({ browser, studio }) {
    studio.record("cut.h5", 10);
    await studio.serve();
    const page = await openScope(browser, studio);
    await startLoop(page);
    const recording = await studio.id("recordings", "cut.h5");
    const knots = { penetration: [0, 0.1, 0.3], closing: [0, 1, 2], opening: [] };
    expectEqual((await studio.api("/api/editor/feel", { recording, axis: 0, knots })).status, 200, "it is felt");
    await page.getByText("Rendered now: a drawn law").waitFor();
  },

  async "the button works on a page that has lost everything else"({ browser, studio }) {
    await studio.serve();
    const page = await openScope(browser, studio);
    await startLoop(page);
    // The stream breaks and every other answer stays away, as on a page that was left open for days.
    await page.route("**/api/**", (route) =>
      route.request().url().includes("/zero") ? route.continue() : route.abort(),
    );
    await page.evaluate(() => window.dispatchEvent(new Event("offline")));
    await page.getByRole("button", { name: "Zero force" }).click();
    await until("the force is released", async () => (await status(studio)).released);
  },

  async "a studio that is killed leaves its recording intact"({ browser, studio }) {
    await studio.serve();
    const page = await openScope(browser, studio);
    await startLoop(page);
    await record(page, studio, "cut_short");
    const { recording } = await status(studio);
    await studio.stop("SIGKILL");
    expectEqual(readdirSync(studio.folder), ["cut_short.h5.partial"], "what is left");
    studio.kerfOrThrow("repair", "cut_short.h5");
    expectEqual(studio.kerf("validate", "cut_short.h5").status, 0, "kerf validate cut_short.h5");
    const facts = JSON.parse(studio.kerfOrThrow("info", "cut_short.h5", "--json").stdout);
    expect(facts.samples >= recording.rows - 500, `${facts.samples} rows of ${recording.rows}`);
    await until("the page says so", async () => /stale|answer/i.test(await page.textContent("body")));
  },

  async "Ctrl-C lets go of the hand though a job is at work"({ browser, studio }) {
    studio.record();
    await studio.serve();
    const page = await openScope(browser, studio);
    await startLoop(page);
    await record(page, studio, "ended");
    const recording = await studio.id("recordings", "cut.h5");
    await studio.api("/api/chart", { recording, axis: "theta", models: [] });
    await until("the chart is under way", async () => (await studio.api("/api/jobs")).json[0]?.state === "running");
    expectEqual((await studio.stop("SIGINT")).status, 0, "exit status");
    expect(existsSync(join(studio.folder, "ended.h5")), "the recording is closed");
    expect(!existsSync(join(studio.folder, "cut.chart")), "nothing half-made is left");
  },

  async "Ctrl-C closes the recording that is under way"({ browser, studio }) {
    await studio.serve();
    const page = await openScope(browser, studio);
    await startLoop(page);
    await record(page, studio, "ended");
    const end = await studio.stop("SIGINT");
    expectEqual(end.status, 0, "exit status");
    expectEqual(readdirSync(studio.folder), ["ended.h5"], "what is left");
    expectEqual(studio.kerf("validate", "ended.h5").status, 0, "kerf validate ended.h5");
  },
};
