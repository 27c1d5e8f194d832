// node router_test.mjs PAGE: when the address is written. PAGE is the built page's folder.

import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const page = resolve(process.argv[2]);
const { build } = createRequire(join(page, "package.json"))("esbuild");
const bundle = await build({
  stdin: { contents: `export * from "./src/shell/router";`, resolveDir: page, loader: "ts" },
  bundle: true,
  write: false,
  format: "esm",
  preserveSymlinks: true,
});
const code = Buffer.from(bundle.outputFiles[0].contents).toString("base64");

// A window whose time passes when it is told to.
let now_ms = 1000;
let timers = [];
const location = { hash: "#/recording/1f3a/loop" };
const written = [];
const write = (_state, _title, hash) => written.push((location.hash = hash));
Object.defineProperty(globalThis, "performance", { value: { now: () => now_ms } });
Object.assign(globalThis, {
  location,
  history: { pushState: write, replaceState: write },
  addEventListener: () => {},
  window: { setTimeout: (run, after_ms) => timers.push({ run, at_ms: now_ms + after_ms }) },
  clearTimeout: (number) => (timers = timers.filter((_, k) => k !== number - 1)),
});
const pass = (ms) => {
  now_ms += ms;
  const due = timers.filter((it) => it.at_ms <= now_ms);
  timers = timers.filter((it) => it.at_ms > now_ms);
  for (const it of due) it.run();
};
const { Router } = await import(`data:text/javascript;base64,${code}`);

let failed = 0;
function expectEqual(found, expected, what) {
  if (JSON.stringify(found) === JSON.stringify(expected)) return;
  ++failed;
  console.log(`FAILED  ${what}: found ${JSON.stringify(found)}, expected ${JSON.stringify(expected)}`);
}

const router = new Router(() => {});
router.set({ axis: "y" });
expectEqual(location.hash, "#/recording/1f3a/loop?axis=y", "a choice, at once");

// A drag of one second, an event each 10 ms.
written.length = 0;
for (let k = 1; k <= 100; ++k) {
  pass(10);
  router.set({ from: k });
}
expectEqual(written.length, 4, "writes in a second of dragging");
pass(250);
expectEqual(location.hash, "#/recording/1f3a/loop?axis=y&from=100", "where the drag ended");

router.set({ to: 7 });
router.set({ cycle: 3 }, "push");
expectEqual(
  written.slice(-2).map((it) => it.split("&").pop()),
  ["to=7", "cycle=3"],
  "what waited, then the step",
);

process.exit(failed ? 1 : 0);
