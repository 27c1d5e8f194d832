// What somebody with fresh eyes stopped at: what is drawn means what reports mean by it, and the page says what it does.

import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

async function prepare({ browser, studio }, options = {}) {
  if (!studio.process) {
    studio.record("cut.h5", 20);
    studio.kerfOrThrow("fit", "cut.h5", "--models", "kelvin,exponential", "--folds", "2", "-o", "cut.fit");
    await studio.serve();
  }
  return openPage(browser, options);
}

async function open(page, studio, tab) {
  await page.goto(studio.page(`recording/${await studio.id("recordings", "cut.h5")}/${tab}`));
  await page.waitForSelector(".tab_panel > *");
}

export const tests = {
  async CallsWorkOverAnAngleByWhatItIs({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await open(page, studio, "cycles");
    const heads = page.locator("table.cycles thead th");
    await until("the table is there", async () => (await heads.count()) > 0);
    const texts = await heads.allTextContents();
    expect(texts.includes("Work [N·rad]") && texts.includes("Peak [N]"), `units in ${texts}`);
    expect(studio.kerfOrThrow("inspect", "cut.h5").stdout.includes("work N·rad"), "and in the program");
    expectNoComplaints(page);
  },
};
