// What the segment editor works out in the page: breakpoints, steps back, errors. Run by
//
//     node tests/bench/studio/page/modules/editor_test.mjs [PAGE]
//
// where PAGE is a folder with the page's src and node_modules (default: bench/studio/page, after 'npm ci'). The
// modules are bundled by its esbuild as the program's page is. Exit status 1 if a test fails.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const page = resolve(process.argv[2] ?? join(here, "../../../../../bench/studio/page"));
const { build } = createRequire(join(page, "package.json"))("esbuild");
const bundle = await build({
  stdin: {
    contents: ["knots", "history", "error", "scale", "lines", "drawing"]
      .map((it) => `export * from "./src/editor/${it}";`)
      .join("\n"),
    resolveDir: page,
    loader: "ts",
  },
  bundle: true,
  write: false,
  format: "esm",
  preserveSymlinks: true,
});
const editor = await import(
  `data:text/javascript;base64,${Buffer.from(bundle.outputFiles[0].text).toString("base64")}`
);

const near = (a, b, share = 1e-12) =>
  assert.ok(Math.abs(a - b) <= share * Math.max(Math.abs(a), Math.abs(b), 1e-300), `${a} and ${b}`);

/** A closing of 2 N at 0, 4 N at 10 mm and an opening of -1 N, on a grid of 1 mm. */
const curve = () => ({
  recording: "0123456789abcdef",
  axis: "x_s",
  position_unit: "m",
  force_unit: "N",
  cycles: 3,
  segmented_here: false,
  contact_position: 0,
  closing_direction: 1,
  penetration: Array.from({ length: 11 }, (_, i) => i * 1e-3),
  closing: Array.from({ length: 11 }, (_, i) => 2 + 0.2 * i),
  opening: Array.from({ length: 11 }, () => -1),
  jnd: { weber_fraction: 0.07, threshold_n: 0.05 },
});
const line = () => ({ penetration: [0, 0.01], closing: [2, 4], opening: [-1, -1] });

test("the page's errors are those of the server", () => {
  const cases = JSON.parse(readFileSync(join(here, "../../editor/editor_errors.json"), "utf8"));
  assert.ok(cases.length >= 5);
  for (const { name, curve: of, knots, error } of cases) {
    const found = editor.lawError(of, knots);
    for (const [figure, value] of Object.entries(error)) {
      if (typeof value === "number") near(found[figure], value, 1e-9);
      else assert.equal(found[figure], value, name);
    }
  }
});

test("a law on the curve has no error, a raised one as much as it is raised", () => {
  assert.ok(editor.lawError(curve(), line()).rmse_n < 1e-14);
  const raised = editor.lawError(curve(), { penetration: [0, 0.01], closing: [2.5, 4.5], opening: [-0.5, -0.5] });
  near(raised.rmse_n, 0.5);
  near(raised.worst_n, 0.5);
});

test("a curve that nothing reached has no error to show", () => {
  const empty = { ...curve(), closing: Array(11).fill(null), opening: Array(11).fill(null) };
  assert.equal(editor.lawError(empty, line()), null);
});

test("the law holds before its first breakpoint and goes on beyond its last", () => {
  const knots = { penetration: [0.002, 0.004, 0.006], closing: [1, 3, 4], opening: [] };
  near(editor.forceAt(knots, "closing", 0), 1);
  near(editor.forceAt(knots, "closing", 0.003), 2);
  near(editor.forceAt(knots, "closing", 0.004), 3);
  near(editor.forceAt(knots, "closing", 0.01), 6);
  near(editor.forceAt(knots, "opening", 0.003), 2);
});

test("the averaged curve is linear between its points and the nearest one beyond", () => {
  const gaps = { ...curve(), closing: [null, null, 1, null, 3, null, null, null, null, null, null] };
  near(editor.meanAt(gaps, "closing", 0.003), 2);
  near(editor.meanAt(gaps, "closing", 0), 1);
  near(editor.meanAt(gaps, "closing", 0.01), 3);
  assert.equal(editor.meanAt({ ...gaps, closing: Array(11).fill(null) }, "closing", 0.003), null);
});

test("it starts with a line from end to end, with an opening if there was one", () => {
  assert.deepEqual(editor.startKnots(curve()), line());
  const closed = { ...curve(), opening: Array(11).fill(null) };
  assert.deepEqual(editor.startKnots(closed).opening, []);
});

test("a breakpoint goes between its neighbours, with the averaged force on the other branch", () => {
  const { knots, index } = editor.added(line(), curve(), { penetration: 0.004, force: 7, branch: "closing" });
  assert.equal(index, 1);
  assert.deepEqual(knots, { penetration: [0, 0.004, 0.01], closing: [2, 7, 4], opening: [-1, -1, -1] });
  const open = editor.added(line(), curve(), { penetration: 0.012, force: -2, branch: "opening" });
  assert.equal(open.index, 2);
  near(open.knots.closing[2], 4);
  assert.equal(open.knots.opening[2], -2);
});

test("where no cycle reached, the other branch takes the force of the line", () => {
  const blind = { ...curve(), opening: Array(11).fill(null) };
  const { knots } = editor.added({ ...line(), opening: [0, -2] }, blind, {
    penetration: 0.005,
    force: 3,
    branch: "closing",
  });
  near(knots.opening[1], -1);
});

test("one breakpoint does not fall on another, and no more than seventeen are taken", () => {
  let knots = line();
  for (let i = 1; i < 16; ++i)
    knots = editor.added(knots, curve(), { penetration: i * 6e-4, force: 1, branch: "closing" }).knots;
  assert.equal(knots.penetration.length, 17);
  assert.equal(editor.added(knots, curve(), { penetration: 3e-4, force: 1, branch: "closing" }), null);
  const beside = editor.added(line(), curve(), { penetration: 0, force: 1, branch: "closing" });
  assert.ok(beside.knots.penetration[1] > 0);
  assert.equal(editor.faultOf(beside.knots), "");
});

test("a breakpoint moves between its neighbours, its other force stays", () => {
  const three = { penetration: [0, 0.005, 0.01], closing: [2, 3, 4], opening: [-1, -1, -1] };
  const moved = editor.moved(three, 1, { penetration: 0.02, force: 9, branch: "closing" }, 1e-6);
  near(moved.penetration[1], 0.01 - 1e-6);
  assert.deepEqual([moved.closing[1], moved.opening[1]], [9, -1]);
  assert.equal(editor.moved(three, 0, { penetration: -0.5, force: 0, branch: "opening" }, 1e-6).penetration[0], -0.5);
  assert.deepEqual(three.closing, [2, 3, 4], "what was stays as it was");
});

test("two breakpoints are kept", () => {
  const three = { penetration: [0, 0.005, 0.01], closing: [2, 3, 4], opening: [] };
  assert.deepEqual(editor.removed(three, 1), { penetration: [0, 0.01], closing: [2, 4], opening: [] });
  assert.equal(editor.removed(line(), 0), null);
});

test("faults are told before the server has to", () => {
  assert.equal(editor.faultOf(line()), "");
  assert.match(editor.faultOf({ penetration: [0, 0], closing: [1, 1], opening: [] }), /Breakpoint 2 must be deeper/);
  assert.match(editor.faultOf({ penetration: [0, 1], closing: [1, NaN], opening: [] }), /missing/);
  assert.match(editor.faultOf({ penetration: [0], closing: [1], opening: [] }), /2 to 17/);
});

test("steps go back and forth, and a drag is one", () => {
  const history = new editor.History(0);
  for (const value of [1, 2, 3]) history.record(value, "drag 1");
  history.record(4);
  history.record(5, "drag 2");
  const back = [];
  while (history.undo()) back.push(history.now);
  assert.deepEqual(back, [4, 3, 0]);
  assert.ok(history.redo());
  assert.equal(history.now, 3);
  history.record(9, "drag 1");
  assert.equal(history.canRedo, false, "a change forgets what was taken back");
  assert.ok(history.undo());
  assert.equal(history.now, 3, "the tag of a step that was taken back does not go on");
});

test("only so many steps are kept", () => {
  const history = new editor.History(0, 3);
  for (let i = 1; i < 10; ++i) history.record(i);
  while (history.undo());
  assert.equal(history.now, 6);
});

test("a drawing drags, undoes and removes in its own steps", () => {
  const drawing = new editor.Drawing(curve(), new editor.History(line()));
  const at = drawing.add({ penetration: 0.005, force: 5, branch: "closing" }, "drag 1");
  drawing.move(at, { penetration: 0.006, force: 6, branch: "closing" }, "drag 1");
  assert.deepEqual(drawing.knots.closing, [2, 6, 4]);
  drawing.undo();
  assert.deepEqual(drawing.knots, line());
  drawing.redo();
  assert.ok(drawing.remove(1));
  assert.equal(drawing.remove(0), false);
  drawing.ownOpening(false);
  assert.deepEqual(drawing.knots.opening, []);
  drawing.undo();
  assert.deepEqual(drawing.knots.opening, [-1, -1]);
});

test("one prefix serves a whole range, and angles are in degrees", () => {
  const scale = editor.scaleFor([0, 0.0123, -0.4], "m");
  assert.equal(scale.unit, "mm");
  assert.equal(editor.inUnits(0.0123, scale), "12.3 mm");
  assert.equal(editor.asField(0.0123456789, scale), "12.35");
  const angle = editor.scaleFor([0, Math.PI / 6], "rad");
  assert.equal(angle.unit, "deg");
  assert.equal(editor.inUnits(Math.PI / 12, angle), "15 deg");
  assert.equal(editor.asField(Math.PI / 12, angle), "15");
  assert.equal(editor.scaleFor([3.2], "N").unit, "N");
  assert.equal(editor.scaleFor([0], "N").unit, "N");
});

test("the band is a JND to either side, and breaks where the curve does", () => {
  const gap = { ...curve(), closing: [2, 2, 2, null, 0.1, 0.1, null, null, null, null, null] };
  const bands = editor.jndBands(new editor.Drawing(gap, new editor.History(line())), "closing");
  assert.equal(bands.length, 2);
  near(bands[0].y[0], 2.14, 1e-9);
  near(bands[0].y.at(-1), 1.86, 1e-9);
  near(bands[1].y[0], 0.15, 1e-9);
});
