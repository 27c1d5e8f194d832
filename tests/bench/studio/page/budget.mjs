// node budget.mjs KERF NODE_MODULES SECONDS: what the page costs the browser, as JSON. For scripts/benchmark studio page:
// these are durations, which a test has no business with.

import { copyFile } from "node:fs/promises";
import { join, resolve } from "node:path";
import { gzipSync } from "node:zlib";

import { openBrowser, openPage, Studio, until } from "./harness.mjs";

const [program, modules] = process.argv.slice(2, 4).map((it) => resolve(it));
const seconds = Number(process.argv[4] ?? 60);
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

async function compressed(studio) {
  let bytes = 0;
  for (const path of ["/", "/studio.js", "/studio.css", "/icon.svg"]) {
    const answer = await fetch(studio.origin + path, { headers: { "X-Kerf-Token": studio.token } });
    bytes += gzipSync(Buffer.from(await answer.arrayBuffer())).length;
  }
  return bytes;
}

/** First contentful paint and when the heading of the page was there [ms], each time in a browser profile of its own. */
async function paints(browser, studio, times) {
  const first = [];
  for (let i = 0; i < times; ++i) {
    const page = await openPage(browser);
    await page.goto(studio.page("scope"));
    await page.getByRole("heading", { name: "Scope" }).waitFor();
    first.push(
      await until("it is painted", () =>
        page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0]?.startTime),
      ),
    );
    await page.context().close();
  }
  return first;
}

/** From the key that asks for a tab to the next frame in which it shows something [ms], each tab by turns. */
async function tabChanges(browser, studio, rounds) {
  const page = await openPage(browser);
  await page.goto(studio.page(`recording/${await studio.id("recordings", "cut.h5")}/time`));
  await page.waitForSelector(".time_plot");
  const found = {};
  for (let round = 0; round < rounds; ++round) {
    for (const tab of ["loop", "cycles", "law", "fits", "chart", "report", "time"]) {
      const taken = await page.evaluate(async (name) => {
        const begin = performance.now();
        document.getElementById(`tab_${name}`).click();
        const panel = document.getElementById("tab_panel");
        while (panel.childElementCount === 0) await new Promise((go) => setTimeout(go));
        await new Promise((go) => requestAnimationFrame(() => setTimeout(go)));
        return performance.now() - begin;
      }, tab);
      (found[tab] ??= []).push(taken);
      await page.waitForTimeout(400);
    }
  }
  await page.context().close();
  return Object.fromEntries(Object.entries(found).map(([tab, all]) => [tab, median(all)]));
}

/** From the page's start to a list that counts 5,000 recordings [ms]. */
async function longList(browser, program) {
  const studio = await Studio.make(program);
  try {
    studio.kerfOrThrow("record", "--device", "sim:scissors", "--seconds", "0.1", "--virtual", "-o", "r.h5");
    for (let k = 1; k < 5000; ++k) await copyFile(join(studio.folder, "r.h5"), join(studio.folder, `r${k}.h5`));
    await studio.serve();
    const page = await openPage(browser);
    await page.goto(studio.page("scope"));
    const count = page.locator(".list_count", { hasText: "5,000" });
    await count.waitFor();
    const taken = await page.evaluate(() => performance.now());
    await page.context().close();
    return taken;
  } finally {
    await studio.remove();
  }
}

/** What a page does while the scope runs: long tasks, frames, shifts of the layout, memory after a collection. */
async function watch(browser, studio) {
  const page = await openPage(browser);
  await page.addInitScript(() => {
    window.kerfTasks = [];
    window.kerfShift = 0;
    window.kerfFrames = 0;
    new PerformanceObserver((list) => window.kerfTasks.push(...list.getEntries().map((it) => it.duration))).observe({
      type: "longtask",
    });
    new PerformanceObserver((list) => list.getEntries().forEach((it) => (window.kerfShift += it.value))).observe({
      type: "layout-shift",
    });
    const count = () => {
      ++window.kerfFrames;
      requestAnimationFrame(count);
    };
    requestAnimationFrame(count);
  });
  await page.goto(studio.page("scope"));
  await studio.api("/api/live/start", { device: "sim:scissors" });
  await page.waitForTimeout(70000); // until the longest window is full, and everything is compiled
  const tools = await page.context().newCDPSession(page);
  const memory = async () => {
    await tools.send("HeapProfiler.collectGarbage");
    const { usedSize } = await tools.send("Runtime.getHeapUsage");
    return usedSize / 1e6;
  };
  await page.evaluate(() => {
    window.kerfTasks = [];
    window.kerfFrames = 0;
  });
  const heap = [await memory()];
  const begin = Date.now();
  while (Date.now() - begin < 1000 * seconds) {
    await page.waitForTimeout(Math.min(60000, 1000 * seconds));
    heap.push(await memory());
  }
  const found = await page.evaluate(() => ({
    tasks: window.kerfTasks,
    shift: window.kerfShift,
    frames: window.kerfFrames,
  }));
  const watched = (Date.now() - begin) / 1000;
  return {
    seconds: watched,
    frames_per_second: found.frames / watched,
    long_tasks: found.tasks.length,
    longest_task_ms: Math.max(0, ...found.tasks),
    layout_shift: found.shift,
    heap_mb: heap,
  };
}

/** Wake latency of the loop [us] with the scope open in a browser of this machine and without, by turns of 12 s. */
async function wakes(browser, studio, turns) {
  const found = { without: [], with: [] };
  const page = await openPage(browser);
  for (let turn = 0; turn < turns; ++turn) {
    for (const how of turn % 2 ? ["with", "without"] : ["without", "with"]) {
      await page.goto(how === "with" ? studio.page("scope") : "about:blank");
      await page.waitForTimeout(2000);
      await page.waitForTimeout(10000);
      const { wake_s, missed } = (await studio.api("/api/live/status")).json; // of the last ten seconds
      found[how].push({ p50: 1e6 * wake_s.p50, p999: 1e6 * wake_s.p999, missed });
    }
  }
  await page.context().close();
  return found;
}

const studio = await Studio.make(program);
const browser = await openBrowser(modules);
try {
  studio.record("cut.h5", 20);
  await studio.serve();
  const paint = await paints(browser, studio, 9);
  const tab_ms = await tabChanges(browser, studio, 9);
  const list_ms = await longList(browser, program);
  const watched = await watch(browser, studio);
  for (const context of browser.contexts()) await context.close();
  const wake = await wakes(browser, studio, 7);
  console.log(
    JSON.stringify({
      bytes: await compressed(studio),
      first_paint_ms: median(paint),
      tab_ms,
      list_ms,
      slowest_paint_ms: Math.max(...paint),
      watched,
      wake,
    }),
  );
} finally {
  await browser.close();
  await studio.remove();
}
