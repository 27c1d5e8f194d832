// node run.mjs SUITE KERF NODE_MODULES SCREENSHOTS: runs the tests of SUITE_pages.mjs, each with a studio of its own.

import { mkdir } from "node:fs/promises";
import { resolve } from "node:path";

import { isThere, openBrowser, Studio } from "./harness.mjs";

const [suite, ...paths] = process.argv.slice(2);
const [program, modules, screenshots] = paths.map((it) => resolve(it));
if (!isThere()) {
  console.log("skipped: there is no Chromium; install Debian's package chromium");
  process.exit(77);
}
await mkdir(screenshots, { recursive: true });
const { tests } = await import(`./${suite}_pages.mjs`);
const browser = await openBrowser(modules);
let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  const studio = await Studio.make(program);
  try {
    await test({ browser, studio, screenshots });
    console.log(`passed  ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAILED  ${name}: ${error.stack}\n${studio.said ?? ""}`);
  } finally {
    for (const context of browser.contexts()) await context.close();
    await studio.remove();
  }
}
await browser.close();
process.exit(failed ? 1 : 0);
