// Maps of an import as they are picked column by column, and which axis is laid over which. Run by
//
//     node tests/bench/studio/page/modules/mapping_test.mjs [PAGE]
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
const bundle = await build({
  stdin: {
    contents: ["intake/mapping", "recordings/laid_over"].map((it) => `export * from "./src/${it}";`).join("\n"),
    resolveDir: page,
    loader: "ts",
  },
  bundle: true,
  write: false,
  format: "esm",
  preserveSymlinks: true,
});
const it = await import(`data:text/javascript;base64,${Buffer.from(bundle.outputFiles[0].text).toString("base64")}`);

const preview = (count, mapped = []) => ({
  columns: Array.from({ length: count }, (_, k) => ({ number: k + 1 })),
  mapped,
});

test("a map of columns by number is picked and written back as it was", () => {
  for (const map of [
    "time=1[s],position=2[mm],force=3[N]",
    "time=1,position=2:4[mm],orientation=5:8[quaternion xyzw],force=9:11[N sensor],torque=12:14[N·m sensor]",
    "position.y=1[mm],position.z=2[m],position.x=3[mm]",
    "orientation=1:3[euler xyz deg],position=4:6[mm]",
    "position=1:3[mm],force=4:6[counts/1000000 N world],temperature=7[degC]",
  ])
    assert.equal(it.mapOf(it.choicesOf(preview(14), map)), map);
});

test("what stands above each column of a vector and of an orientation", () => {
  const choices = it.choicesOf(preview(8), "position=1:3[mm],orientation=4:7[quaternion wxyz]");
  assert.deepEqual(
    choices.map(({ channel }) => channel),
    ["position.x", "position.y", "position.z", "orientation", "orientation.2", "orientation.3", "orientation.4", ""],
  );
  assert.deepEqual(
    choices.map(({ unit }) => unit),
    ["mm", "mm", "mm", "quaternion wxyz", "", "", "", ""],
  );
});

test("a map by headings is picked where it says one column a channel, a wrench by text alone", () => {
  const mapped = [{ channel: "force_measured", column: 2, unit: "N", unit_from_file: false, si: "N" }];
  assert.ok(it.isPlain(preview(3, mapped), "force=Load[N]"));
  assert.equal(it.mapOf(it.choicesOf(preview(3, mapped), "force=Load[N]")), "force=2[N]");
  const spatial = [{ channel: "force.x", column: 2, unit: "N", unit_from_file: false, si: "N" }];
  assert.ok(!it.isPlain(preview(9, spatial), "wrench=fx:mz[N N·m sensor]"));
  assert.ok(!it.isPlain(preview(9, []), "position=x:z[mm]"));
});

const recording = (axes, ...channels) => ({
  axes: axes.map(([name, position_unit]) => ({ name, position_unit, force_unit: "N" })),
  traces: axes
    .flatMap(([name, unit]) => [
      { name: `position ${name}`, unit },
      { name: `force measured ${name}`, unit: "N" },
    ])
    .concat(channels),
});

test("single axes of one unit are a pair, whatever they are called", () => {
  const scissors = recording([["theta", "rad"]]);
  const punch = recording([["position", "rad"]]);
  assert.equal(it.axisOver(scissors, 0, punch), 0);
  assert.equal(it.traceOver(scissors, scissors.traces[1], punch), 1);
  assert.equal(it.whyNotOver(scissors, punch), "");
});

test("of several axes the names decide, and another unit is no pair", () => {
  const plane = recording([
    ["x", "m"],
    ["y", "m"],
  ]);
  const turned = recording([
    ["y", "m"],
    ["x", "m"],
  ]);
  assert.equal(it.axisOver(plane, 0, turned), 1);
  const scissors = recording([["theta", "rad"]]);
  assert.equal(it.axisOver(scissors, 0, recording([["x", "m"]])), -1);
  assert.equal(it.axisOver(scissors, 0, plane), -1);
  const counts = {
    axes: [{ name: "n", position_unit: "1", force_unit: "1" }],
    traces: [{ name: "position n", unit: "1" }],
  };
  assert.match(it.whyNotOver(scissors, counts), /^it has no trace of the same name and unit \(n \[1, 1\] beside theta/);
});
