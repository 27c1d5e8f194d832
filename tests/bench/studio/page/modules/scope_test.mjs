// node scope_test.mjs PAGE: what triggers, and what a spectrum is. PAGE is the built page's folder.

import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const page = resolve(process.argv[2]);
const { build } = createRequire(join(page, "package.json"))("esbuild");
const modules = ["live_columns", "trigger", "views/spectrum", "deadline_strip"];
const bundle = await build({
  stdin: {
    contents: modules.map((it) => `export * from "./src/scope/${it}";`).join("\n"),
    resolveDir: page,
    loader: "ts",
  },
  bundle: true,
  write: false,
  format: "esm",
  preserveSymlinks: true,
});
const code = Buffer.from(bundle.outputFiles[0].contents).toString("base64");
globalThis.matchMedia = () => ({ addEventListener: () => {} });
const all = await import(`data:text/javascript;base64,${code}`);
const { LiveColumns, TriggerFinder, crossingRow, spectrumOf, peakOf, powerOfTwo, deadlineAt, missedTicks } = all;

let failed = 0;
function expectEqual(found, expected, what) {
  if (JSON.stringify(found) === JSON.stringify(expected)) return;
  ++failed;
  console.log(`FAILED  ${what}: found ${JSON.stringify(found)}, expected ${JSON.stringify(expected)}`);
}

const frame = (from, values) => ({
  run: 1,
  from,
  ticks: 1,
  period_s: 1e-3,
  smallest: [values],
  largest: [values],
  events: [],
});
/** When it triggers [ticks] as the values come in frames of 10. */
function triggers(values, settings, window = 20, capacity = 60) {
  const columns = new LiveColumns(1, 1, capacity);
  const finder = new TriggerFinder();
  const found = [];
  for (let from = 0; from < values.length; from += 10) {
    columns.push(frame(from, values.slice(from, from + 10)));
    const at = finder.look(
      columns,
      { mode: "normal", trace: 0, level: 0.5, edge: "rising", ...settings },
      window * 1e-3,
    );
    if (at !== null) found.push(Math.round(at * 1000));
  }
  return found;
}
const ramp = Array.from({ length: 220 }, (_, k) => (k % 50) / 50);

expectEqual(triggers(ramp), [25, 75, 125, 175], "every rise through the level");
expectEqual(triggers(ramp, { edge: "falling" }), [50, 100, 150, 200], "every fall");
expectEqual(triggers(ramp, { level: 2 }), [], "a level that is never met");
expectEqual(triggers(ramp, {}, 100), [25, 125], "none within a window that is shown");
expectEqual([triggers(ramp.slice(0, 40)), triggers(ramp.slice(0, 50))], [[], [25]], "not before its window is whole");
// About the level noise is no crossing: the value has to come from beyond.
const noisy = Array.from({ length: 2000 }, (_, k) => (k % 1000) / 1000 + (k % 2 ? -0.009 : 0.009));
const again = triggers(noisy, {}, 4, 1200).filter((it) => it > 1000);
expectEqual(again, [1492], "once a rise, though it flickers at the level");
const gap = ramp.map((it, k) => (k > 20 && k < 40 ? null : it));
expectEqual(triggers(gap)[0], 40, "a crossing within a gap is that after it");

const steps = [0, 1, 2, 3, 4, 5].map((k) => 1e-3 * k);
const rises = [0.9, 0.1, 0.4, 0.6, 0.7, 0.2];
const rows = ["rising", "falling"].map((edge) => crossingRow(steps, rises, { level: 0.5, edge }, 1e-3));
expectEqual(
  [...rows, crossingRow(steps, rises, { level: 2, edge: "rising" }, 0)],
  [3e-3, 1e-3, null],
  "rows of a crossing",
);

expectEqual([powerOfTwo(1), powerOfTwo(1023), powerOfTwo(1024)], [0, 512, 1024], "powers of two");
const tone = Array.from({ length: 1024 }, (_, k) => 5 + 0.25 * Math.sin(2 * Math.PI * 125 * k * 1e-3));
const { hz, amplitude } = peakOf(spectrumOf(tone, 1e-3));
expectEqual([hz, Number(amplitude.toFixed(6))], [125, 0.25], "a tone has its frequency and its amplitude");
expectEqual(spectrumOf([1, 2, 3], 1e-3), null, "three values have no spectrum");
const holed = tone.map((it, k) => (k === 500 ? NaN : it));
expectEqual(peakOf(spectrumOf(holed, 1e-3)).hz, 125, "with a value missing");

const line = (...largest) => ({ largest });
const kinds = [0, 1, 2, 3].map((k) => deadlineAt(line(1e-5, 9e-4, NaN), line(1e-4, 2e-4, NaN), k, 1e-3));
expectEqual(kinds, ["met", "late", "missed", "none"], "deadlines");
expectEqual(missedTicks("3 ticks are not in the file"), 3, "ticks that an event tells of");

process.exit(failed ? 1 : 0);
