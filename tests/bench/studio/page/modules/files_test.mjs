// What the page writes into files: tables, names, scales and ticks. Run by
//
//     node tests/bench/studio/page/modules/files_test.mjs [PAGE]
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
  "ui/numbers",
  "ui/page_words",
  "ui/plot/scale",
  "ui/plot/scaled",
  "ui/plot/out/csv_file",
  "ui/plot/out/download",
];
const bundle = await build({
  stdin: {
    contents: [...modules, "ui/figure_description"].map((it) => `export * from "./src/${it}";`).join("\n"),
    resolveDir: page,
    loader: "ts",
  },
  bundle: true,
  write: false,
  format: "esm",
  preserveSymlinks: true,
});
const files = await import(`data:text/javascript;base64,${Buffer.from(bundle.outputFiles[0].text).toString("base64")}`);

test("a table has its numbers to the last digit, and its texts as spreadsheets take them", () => {
  const cells = ['a,b "c"', "=1+2", "-x", "line\nbreak", "#1", null, -1.25, NaN, 0.1 + 0.2];
  assert.equal(
    files.csvOf([{ head: "what [N]", cells }]),
    `what [N]\r\n"a,b ""c"""\r\n'=1+2\r\n'-x\r\nline break\r\n"#1"\r\n\r\n-1.25\r\n\r\n0.30000000000000004\r\n`,
  );
});

test("curves over the same x share its column, with names before units", () => {
  const x = [1, 2];
  const figure = files.figureOf("time [s]", "force [N]", {
    curves: [files.lineOf("kelvin", x, [3, null]), files.lineOf("", [1, 2], [5, 6], { name: "cycle 1" })],
    areas: [
      { label: "measured", x, low: [0, 1], high: [2, 3], colour: "black", extremes: true },
      { label: "", x, low: [7, 8], high: [9, 10], colour: "blue", name: "kelvin interval" },
    ],
  });
  assert.deepEqual(
    files.figureColumns([figure]).map((it) => it.head),
    [
      "time [s]",
      "force measured smallest [N]",
      "force measured largest [N]",
      "force kelvin interval lower [N]",
      "force kelvin interval upper [N]",
      "force kelvin [N]",
      "force cycle 1 [N]",
    ],
  );
});

test("sentences of the program are put in words of the page", () => {
  const says = (text, here) => assert.equal(files.inPageWords(text), here);
  says("1 of 10 cycles are left out (--cycles all takes them): cycle 10", "1 of 10 cycles are left out: cycle 10");
  says("; 'kerf prepare --cycles 1-9' keeps the others", "; 'Prepare' under Work keeps the others");
  says("; --contact POSITION says where", "; the option 'contact' POSITION says where");
  says("a force of -3 N, 'a name' -- and more", "a force of -3 N, 'a name' -- and more");
});

test("names that stand below an axis stand in the table too, times do not", () => {
  const x_ticks = [
    { at: 1, name: "kelvin" },
    { at: 2, name: "maxwell" },
  ];
  const curves = [files.lineOf("error", [1, null, 2], [0.1, null, 0.2])];
  const [laws, errors] = files.figureColumns([files.figureOf("law", "error [N]", { curves, x_ticks })]);
  assert.deepEqual(laws, { head: "law", cells: ["kelvin", "", "maxwell"] });
  assert.deepEqual(errors.cells, [0.1, null, 0.2]);
  const seconds = [{ at: 1, name: "1.0" }];
  const [time] = files.figureColumns([files.figureOf("time [s]", "F [N]", { curves, x_ticks: seconds })]);
  assert.deepEqual(time.cells, [1, null, 2]);
});

test("a map is a row for each cell, whichever way its cells follow each other", () => {
  const cells = {
    x_edges: [0, 1, 2],
    y_edges: [5, 6, 7],
    kinds: [{ label: "no" }, { label: "yes" }],
    kind: [0, 0, 0, 1],
  };
  for (const upwards of [false, true]) {
    const figure = files.figureOf("K [N/m]", "B [N·s/m]", { cells: { ...cells, upwards } });
    const [left, , below, , what] = files.figureColumns([figure]).map((it) => it.cells);
    assert.deepEqual([left[3], below[3], what[3]], [1, 6, "yes"]);
    assert.deepEqual([left[1], below[1]], upwards ? [0, 6] : [1, 5]);
  }
});

test("names of files are taken by every file system", () => {
  assert.equal(
    files.fileName("Force against position: größe/é b.h5", "svg"),
    "Force-against-position-gro-e-e-b-h5.svg",
  );
  assert.equal(files.fileName("../..", "csv"), "kerf-plot.csv");
  assert.equal(files.fileName("con", "png"), "kerf-con.png");
  assert.ok(files.fileName("x".repeat(300), "csv").length < 70);
});

test("an axis has two labels or more, however it lies", () => {
  for (const [lower, upper] of [
    [0.6, 1.4],
    [0.41, 1.29],
    [-0.1, 0.9],
    [1e-9, 1.9e-9],
    [-7, 99],
  ]) {
    assert.ok(files.linearTicks(lower, upper, 2).length >= 2, `${lower} to ${upper}`);
    const few = files.linearTicks(lower, upper, 8);
    assert.ok(few.length >= 3 && few.length <= 12, `${lower} to ${upper}: ${few}`);
  }
  for (const [lower, upper] of [
    [2.1, 4.4],
    [0.3, 40],
    [1e-3, 1e3],
    [1e-6, 1e4],
  ]) {
    const ticks = files.logarithmicTicks(lower, upper, 6);
    assert.ok(ticks.length >= 3 && ticks.length <= 10, `${lower} to ${upper}: ${ticks}`);
    assert.ok(ticks.every((it) => it >= 0.999 * lower && it <= 1.001 * upper));
  }
});

test("a scale goes to pixels and back, and has no place for zero on a logarithmic axis", () => {
  for (const logarithmic of [false, true]) {
    const scale = new files.Scale([0.1, 10], 50, 450, logarithmic);
    for (const value of [0.1, 1, 7.3, 10]) assert.ok(Math.abs(scale.value(scale.at(value)) / value - 1) < 1e-12);
  }
  assert.ok(Number.isNaN(new files.Scale([0.1, 10], 0, 1, true).at(0)));
});

test("angles are in degrees, as reports have them; lengths take a prefix", () => {
  const angle = files.scaledFor("position", "rad", [[0, Math.PI / 6, null]]);
  assert.equal(angle.label, "position [deg]");
  assert.deepEqual(angle.of([Math.PI / 6, null]), [30, null]);
  const depth = files.scaledFor("penetration", "m", [[0.004]]);
  assert.deepEqual([depth.label, ...depth.of([0.004])], ["penetration [mm]", 4]);
});
