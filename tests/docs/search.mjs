// The site as a browser opens it from the disk: searched without a server, and nothing is asked of the net.
//     node search.mjs SITE NODE_MODULES
// Skipped (77) where there is no Chromium.

import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

import { expect, expectEqual, isThere, openBrowser, openPage, until } from "../bench/studio/page/harness.mjs";

if (!isThere()) {
  console.log("skipped: there is no Chromium; install Debian's package chromium");
  process.exit(77);
}
const [site, modules] = process.argv.slice(2).map((it) => resolve(it));
const browser = await openBrowser(modules);
try {
  const page = await openPage(browser);
  const asked = [];
  page.on("request", (request) => {
    if (!/^(file|blob|data):/.test(request.url())) asked.push(request.url());
  });
  await page.goto(pathToFileURL(`${site}/docs/laws.html`).href);
  await page.fill(".md-search__input", "hunt_crossley");
  const found = await until("there are results", async () => {
    const links = await page.$$eval(".md-search-result__link", (them) => them.map((it) => it.href));
    return links.length > 0 && links;
  });
  expect(
    found.some((it) => /\/reference\/laws\.html.*#hunt_crossley$/.test(it)),
    `the law's place is among ${found}`,
  );
  await page.goto(found[0]);
  expect((await page.title()).endsWith("Kerf"), "a result leads to a page");
  expectEqual(asked, [], "what was asked of the net");
  expectEqual(page.complaints, [], "what the browser complains about");
} finally {
  await browser.close();
}
