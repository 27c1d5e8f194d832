// What the plots over time work out in the page: live columns, calm limits, the stretch shown, what is fetched. Run by
//
//     node tests/bench/studio/page/modules/time_plot_test.mjs [PAGE]
//
// where PAGE is a folder with the page's src and node_modules (default: bench/studio/page, after 'npm ci').

import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const page = resolve(process.argv[2] ?? join(here, "../../../../../bench/studio/page"));
const { build } = createRequire(join(page, "package.json"))("esbuild");
const modules = [
  "requests",
  "ui/numbers",
  "ui/time/time_limits",
  "ui/time/time_line",
  "ui/time/time_range",
  "ui/time/stretch_loader",
  "scope/live_columns",
];
const bundle = await build({
  stdin: { contents: modules.map((it) => `export * from "./src/${it}";`).join("\n"), resolveDir: page, loader: "ts" },
  bundle: true,
  write: false,
  format: "esm",
  preserveSymlinks: true,
});
globalThis.window = globalThis; // its timers
const plot = await import(`data:text/javascript;base64,${Buffer.from(bundle.outputFiles[0].text).toString("base64")}`);
const soon = (milliseconds) => new Promise((go) => setTimeout(go, milliseconds));

/** Columns [first, first + n) of a trace that is its tick, but for a spike at one. */
function frame(first, n, ticks, spike = -1) {
  const smallest = [];
  const largest = [];
  for (let column = first; column < first + n; ++column) {
    const holds = spike >= column * ticks && spike < (column + 1) * ticks;
    smallest.push(column * ticks);
    largest.push(holds ? 1e6 : (column + 1) * ticks - 1);
  }
  return { from: first * ticks, ticks, period_s: 1e-3, smallest: [smallest], largest: [largest], events: [] };
}

test("a column is at most a pixel wide", () => {
  for (const window_s of [1, 2, 5, 10, 30, 60]) {
    for (const pixels of [100, 829, 1920, 3840]) {
      const ticks = plot.ticksInColumn(window_s, 1000, pixels);
      assert.ok(ticks === 1 || window_s * 1000 >= ticks * pixels, `${window_s} s over ${pixels} pixels`);
    }
  }
});

test("the newest columns stand at the end, in order, with their times", () => {
  const columns = new plot.LiveColumns(1, 5, 8);
  assert.ok(columns.push(frame(0, 3, 5)));
  assert.ok(columns.push(frame(3, 8, 5)));
  assert.deepEqual([...columns.smallest[0]], [15, 20, 25, 30, 35, 40, 45, 50]);
  assert.equal(columns.end_s, 0.055);
  assert.ok(Math.abs(columns.time[7] - 0.05) < 1e-12);
});

test("columns that did not come are empty, and null is empty", () => {
  const columns = new plot.LiveColumns(1, 1, 6);
  columns.push(frame(0, 2, 1));
  const holed = frame(4, 2, 1);
  holed.smallest[0][0] = holed.largest[0][0] = null;
  columns.push(holed);
  assert.deepEqual([...columns.smallest[0]], [0, 1, NaN, NaN, NaN, 5]);
});

test("a frame of another loop is refused, one of the past put where it belongs", () => {
  const columns = new plot.LiveColumns(1, 1, 8);
  columns.beginAt(100);
  assert.ok(columns.push({ ...frame(90, 5, 1), run: 1 }));
  assert.deepEqual([...columns.smallest[0]], [92, 93, 94, NaN, NaN, NaN, NaN, NaN]);
  assert.ok(columns.push({ ...frame(0, 5, 1), run: 1 }));
  assert.deepEqual([...columns.smallest[0]], [92, 93, 94, NaN, NaN, NaN, NaN, NaN]);
  assert.equal(columns.end_s, 0.1);
  assert.equal(columns.push({ ...frame(0, 3, 1), run: 2 }), false);
});

test("no spike is lost when columns become longer or shorter", () => {
  for (const [before, after] of [
    [2, 6],
    [2, 5],
    [6, 2],
    [5, 3],
    [7, 7],
  ]) {
    const old = new plot.LiveColumns(1, before, 60);
    old.push(frame(0, 60, before, 37));
    const fresh = new plot.LiveColumns(1, after, Math.ceil((60 * before) / after) + 2);
    fresh.takeFrom(old);
    const holding = [...fresh.largest[0]]
      .map((it, k) => (it === 1e6 ? fresh.time[k] : NaN))
      .filter((it) => !Number.isNaN(it));
    assert.ok(holding.length > 0, `${before} to ${after}`);
    for (const time of holding)
      assert.ok(time <= 0.037 + before * 1e-3 && time + after * 1e-3 >= 0.037 - before * 1e-3);
    const smallest = [...fresh.smallest[0]].filter((it) => !Number.isNaN(it));
    assert.equal(Math.min(...smallest), 0);
  }
});

test("limits hold the values, and stay while these fill them well", () => {
  const first = plot.calmLimits(0, 10, null, false);
  assert.ok(first[0] <= 0 && first[1] >= 10 && first[1] - first[0] < 14);
  assert.deepEqual(plot.calmLimits(1, 9, first, false), first);
  assert.notDeepEqual(plot.calmLimits(1, 2, first, false), first);
  assert.notDeepEqual(plot.calmLimits(1, 30, first, false), first);
  assert.deepEqual(plot.calmLimits(-5.4, -3.9, null, true), [-6, -3]);
  const flat = plot.calmLimits(3, 3, null, false);
  assert.ok(flat[0] < 3 && flat[1] > 3);
  assert.deepEqual(plot.calmLimits(Infinity, -Infinity, first, false), first);
});

test("an axis has the prefix of its largest value, where its unit takes one", () => {
  assert.deepEqual(plot.unitFor(0.02, "N"), { factor: 1e-3, text: "mN" });
  assert.deepEqual(plot.unitFor(2e-5, "s"), { factor: 1e-6, text: "µs" });
  assert.deepEqual(plot.unitFor(0.02, "N·m"), { factor: 1e-3, text: "mN·m" });
  assert.deepEqual(plot.unitFor(0.02, "deg"), { factor: 1, text: "deg" });
  assert.deepEqual(plot.unitFor(0.02, "1"), { factor: 1, text: "" });
  assert.deepEqual(plot.unitFor(0, "N"), { factor: 1, text: "N" });
});

const line = (time, smallest, largest = smallest) => ({
  name: "",
  unit: "N",
  look: 0,
  time: Float64Array.from(time),
  smallest: Float64Array.from(smallest),
  largest: Float64Array.from(largest),
  shift_s: 0,
  step_s: 1,
  middle_s: 0,
});

test("the cursor reads the column that it is in, and nothing in a gap", () => {
  const it = line([0, 1, 2, 8, 9], [10, 11, NaN, 18, 19]);
  assert.equal(plot.columnAt(it, 1.5), 1);
  assert.equal(plot.columnAt(it, 1), 1);
  assert.equal(plot.columnAt(it, 2.5), -1);
  assert.equal(plot.columnAt(it, 6), -1);
  assert.equal(plot.columnAt(it, 8.2), 3);
  assert.equal(plot.columnAt({ ...it, shift_s: 100 }, 101.5), 1);
});

test("values are sought in what is shown and one column on either side", () => {
  const found = { lower: Infinity, upper: -Infinity };
  plot.widen(found, line([0, 1, 2, 3, 4, 5], [0, 99, 2, 3, -99, 5]), 2.5, 2.6, false);
  assert.deepEqual(found, { lower: 2, upper: 3 });
});

function range() {
  let changes = 0;
  const it = new plot.TimeRange(
    () => ++changes,
    () => {},
  );
  it.bound(0, 100, 0.01);
  it.whole();
  return { it, changes: () => changes };
}

test("zooming leaves the time where it points, and ends at the ends", () => {
  const { it } = range();
  it.zoom(0.5, 20);
  assert.deepEqual([it.from, it.to], [10, 60]);
  it.panBy(-30);
  assert.deepEqual([it.from, it.to], [0, 50]);
  it.pan(5);
  assert.deepEqual([it.from, it.to], [50, 100]);
  it.zoom(1e-9, 70);
  assert.ok(Math.abs(it.span - 0.01) < 1e-9);
  it.zoom(1e9, 70);
  assert.deepEqual([it.from, it.to], [0, 100]);
});

test("a range that follows the loop cannot be moved by hand, and takes its cursor along", () => {
  const { it, changes } = range();
  it.following = true;
  const before = changes();
  it.point(60);
  it.follow(130, 100);
  assert.deepEqual([it.from, it.to, it.cursor], [30, 130, 90]);
  it.zoom(0.5);
  it.pan(1);
  assert.deepEqual([it.from, it.to, changes()], [30, 130, before]);
});

test("only the newest wish is fetched, and its neighbours when nothing more is wished", async () => {
  const asked = [];
  const shown = [];
  const { it } = range();
  const loader = new plot.StretchLoader(
    async (from, to, columns) => {
      asked.push([from, to, columns]);
      return { rowsPerColumn: 10, prepared: 1, time: new Float64Array(0), traces: [] };
    },
    (view) => shown.push(view),
    assert.fail,
  );
  it.show(40, 50);
  loader.want(it, 100);
  it.show(42, 52);
  loader.want(it, 100);
  await soon(120);
  assert.deepEqual(asked, [[42, 52, 100]]);
  await soon(400);
  assert.deepEqual(asked.slice(1), [[32, 62, 300]]);
  it.panBy(5);
  loader.want(it, 100); // it is there already
  await soon(120);
  assert.equal(asked.length, 2);
  assert.equal(shown.length, 2);
  loader.end();
});

test("what was made of some rows is asked for again until it is of all", async () => {
  const prepared = [0.4, 0.9, 1];
  const shown = [];
  const { it } = range();
  const loader = new plot.StretchLoader(
    async () => ({ rowsPerColumn: 10, prepared: prepared.shift(), time: new Float64Array(0), traces: [] }),
    (view) => shown.push(view.prepared),
    assert.fail,
  );
  it.show(it.first, it.last);
  loader.want(it, 100);
  await soon(150);
  assert.deepEqual(shown, [0.4]);
  await soon(3500);
  assert.deepEqual(shown, [0.4, 0.9, 1]); // and no more
  loader.end();
});

test("at most three requests are under way, in order, and all can be given up", async () => {
  const requests = new plot.Requests();
  const begun = [];
  const go = [];
  const run = (name) =>
    requests.take((signal) => {
      begun.push(name);
      return new Promise((done, fail) => {
        go.push(done);
        signal.addEventListener("abort", () => fail(new Error("given up")));
      });
    });
  const all = ["a", "b", "c", "d", "e"].map((name) => run(name).catch((error) => error.message));
  await soon(5);
  assert.deepEqual(begun, ["a", "b", "c"]);
  go[1]("done");
  await soon(5);
  assert.deepEqual(begun, ["a", "b", "c", "d"]);
  requests.giveUp();
  await soon(5);
  go[4]("done");
  assert.deepEqual(await Promise.all(all), ["given up", "done", "given up", "given up", "done"]);
});

test("a request that is given up while it waits does not hold up the next", async () => {
  const requests = new plot.Requests();
  const go = [];
  const held = [0, 1, 2].map(() => requests.take(() => new Promise((done) => go.push(done))));
  const impatient = new AbortController();
  const left = requests.take(
    (signal) => (signal.aborted ? Promise.reject(new Error("left")) : Promise.resolve("ran")),
    impatient.signal,
  );
  const next = requests.take(() => Promise.resolve("ran"));
  await soon(5);
  impatient.abort();
  await assert.rejects(left, /left/);
  go[0]("done");
  assert.equal(await next, "ran");
  go.forEach((it) => it());
  await Promise.all(held);
});
