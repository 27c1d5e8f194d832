// What somebody with fresh eyes stopped at: what is drawn means what reports mean by it, and the page says what it does.

import { join } from "node:path";

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

/** Of two colours, "#rrggbb" or "rgb(r, g, b)": WCAG 2. */
function contrast(one, other) {
  const light = (colour) => {
    const channels = colour.startsWith("#")
      ? [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16))
      : colour.match(/\d+/g).map(Number);
    const [r, g, b] = channels.map((it) => {
      const share = it / 255;
      return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const [high, low] = [light(one), light(other)].sort((a, b) => b - a);
  return (high + 0.05) / (low + 0.05);
}

export const tests = {
  async TellsAllCyclesApartByTheirOrder({ browser, studio, screenshots }) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await prepare({ browser, studio }, { colorScheme });
      await open(page, studio, "loop");
      await page.waitForSelector(".loops_frame .curve");
      const colours = await page
        .locator(".loops_frame .curve")
        .evaluateAll((curves) => curves.map((it) => it.getAttribute("stroke")));
      expect(colours.length > 3, `${colours.length} cycles`);
      expectEqual(new Set(colours).size, colours.length, "cycles of one colour each");
      const ground = await page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
      for (const it of colours) expect(contrast(it, ground) >= 3, `${it} on ${ground}: ${contrast(it, ground)}`);
      const brighter = colours.map((it) => contrast(it, "#000000"));
      expectEqual(
        brighter,
        [...brighter].sort((a, b) => a - b),
        "lighter from cycle to cycle",
      );
      const legend = page.locator(".loops_frame .legend li");
      expectEqual(await legend.allTextContents(), [`cycle 1 to cycle ${colours.length}, in their order`], "the legend");
      expect((await legend.locator(".sample.ordered").count()) > 3, "shows the colours");
      await page.screenshot({ path: join(screenshots, `cycles-in-order-${colorScheme}.png`) });
      expectNoComplaints(page);
    }
  },

  // As in reports: tests/bench/analysis/report/charts_test.cpp and residual_charts_test.cpp.
  async DrawsClosingInBlueAndResidualsAsMeasuredLessLaw({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await open(page, studio, "loop?loops=average");
    await page.waitForSelector(".loops_frame .curve.closing");
    const classes = (name) => page.locator(`.loops_frame .curve.${name}`).getAttribute("class");
    expect((await classes("closing")).includes("blue"), "closing is blue");
    expect((await classes("opening")).includes("vermillion"), "opening is red");
    await open(page, studio, "time");
    const border = (name) => page.locator(`.key.${name}`).evaluate((it) => getComputedStyle(it).borderTopColor);
    const token = (name) =>
      page.evaluate((it) => {
        const probe = document.body.appendChild(document.createElement("i"));
        probe.style.color = `var(--${it})`;
        const { color } = getComputedStyle(probe);
        probe.remove();
        return color;
      }, name);
    expectEqual(await border("closing"), await token("blue"), "so are its bands over time");
    expectEqual(await border("opening"), await token("orange"), "opening is orange");
    await open(page, studio, "law");
    await page.waitForSelector(".editor .curve");
    const drawn = (name) => page.locator(`.editor .curve.${name}`).first().getAttribute("class");
    expect((await drawn("closing")).includes("blue") && (await drawn("opening")).includes("vermillion"), "the editor");
    await open(page, studio, "fits");
    await page.waitForSelector(".beside_laws .extremes");
    for (const k of [2, 3]) {
      const texts = await page.locator(".beside_laws figure").nth(k).locator(".axis").allTextContents();
      expect(
        texts.some((it) => it.startsWith("measured − law")),
        `an axis of ${texts} says which is taken from which`,
      );
    }
    expectNoComplaints(page);
  },

  async DrawsRowsThatNoLawIsJudgedByInGreyAndNoLawInThem({ browser, studio, screenshots }) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await prepare({ browser, studio }, { colorScheme, viewport: { width: 1280, height: 2400 } });
      await open(page, studio, "fits?laws=kelvin");
      await page.waitForSelector(".beside_laws .extremes.kelvin");
      const id = await studio.id("recordings", "cut.h5");
      const law = await studio.id("laws", "cut.fit/kelvin.law.toml");
      const { over_time: forces, smallest } = (
        await studio.api(`/api/residuals?id=${id}&axis=theta&law=${law}&columns=600`)
      ).json;
      const left = smallest.filter((it) => it === null).length;
      expect(left > 10, `${left} columns are out of contact`);
      smallest.forEach((it, i) => expectEqual(it === null, forces.law_smallest[i] === null, `column ${i}`));
      for (const k of [1, 2]) {
        const figure = page.locator(".beside_laws figure").nth(k);
        expect((await figure.locator(".band.grey").count()) > 1, "stretches are grey");
        const legend = await figure.locator(".legend li").allTextContents();
        expect(legend.includes("rows that no law is judged by"), `${legend} says what grey is`);
      }
      const pieces = (it) => it.getAttribute("d").split("M").length - 1;
      const residual = await page.locator(".beside_laws .extremes.kelvin").evaluate(pieces);
      const bands = await page.locator(".beside_laws figure").nth(2).locator(".plot .band").count();
      expect(Math.abs(residual - bands) <= 1, `${residual} pieces of a residual between ${bands} bands`);
      expect(
        (await page.locator(".beside_laws figure").nth(1).locator(".extremes.grey").count()) === 1,
        "what was measured there is grey",
      );
      await page.locator(".drawn_laws").screenshot({ path: join(screenshots, `judged-${colorScheme}.png`) });
      expectNoComplaints(page);
    }
  },

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

  async SaysNothingOfAChangeThatThePageMadeItself({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await open(page, studio, "cycles");
    await page.waitForSelector(".cycle_list li");
    await page.getByRole("button", { name: "Leave out cycle 2", exact: true }).click();
    const seen = [];
    await page.exposeFunction("noticed", (text) => seen.push(text));
    await page.evaluate(() => {
      const notice = document.querySelector("#notice");
      new MutationObserver(() => window.noticed(notice.textContent)).observe(notice, {
        childList: true,
        characterData: true,
        subtree: true,
      });
    });
    // The list sees the new file long before the page has read it.
    await page.route("**/api/recording?**", async (route) => {
      await new Promise((go) => setTimeout(go, 4000));
      await route.continue().catch(() => {});
    });
    await page.locator(".save_bar button.firm").click();
    await until("it is saved", async () => (await page.textContent(".save_bar [role=status]")) === "as saved");
    const worth = page.locator("table.cycles caption");
    await until("what it is worth follows", async () => /good: (?!.*\b2\b)/.test(await worth.textContent()));
    await page.unroute("**/api/recording?**");
    studio.record("later.h5", 4); // so that the list looks once more at all
    await until("the list has a later file", async () => (await page.textContent("#side")).includes("later"));
    expect(!seen.some((it) => it.includes("has changed")), `what was said: ${seen}`);
    await page.click("#tab_time");
    await page.waitForSelector(".time_plot");
    studio.kerfOrThrow("segment", "cut.h5");
    await until("another's change is told", async () => (await page.textContent("#notice")).includes("has changed"));
    expectNoComplaints(page);
  },

  async CountsTheStepsOfAFit({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const recording = await studio.id("recordings", "cut.h5");
    const order = { recording, axis: "theta", models: ["piecewise"], segments: "8", folds: 9 };
    const { job } = (await studio.api("/api/fit", order)).json;
    const shares = new Set();
    await until(
      "it is done",
      async () => {
        const its = (await studio.api("/api/jobs")).json.find((it) => it.job === job);
        if (its.state === "failed") throw new Error(its.error);
        shares.add(its.share);
        return its.state === "done";
      },
      120000,
    );
    // Of one law there was nothing between its begin and its end, which eleven of twelve steps are.
    const between = [...shares].filter((it) => it > 0 && it < 11 / 12);
    expect(between.length > 0, `steps within a law: ${[...shares]}`);
    for (const it of between) expect(Math.abs(12 * it - Math.round(12 * it)) < 1e-9, `${it} is so many of 12 steps`);
    await page.close();
  },

  async LeadsFromAnEmptyListToTheImport({ browser, studio }) {
    await studio.serve();
    const page = await openPage(browser);
    for (const [place, list] of [
      ["recordings", "main"],
      ["scope", "#side"],
    ]) {
      await page.goto(studio.page(place));
      const link = page.locator(`${list} a`, { hasText: "import a file" });
      await link.click();
      await until("Import is open", async () => page.url().includes("#/import"));
    }
    expectNoComplaints(page);
  },

  async LetsTextInWhatIsOpenedBePressed({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await open(page, studio, "time");
    await page.locator(".popover summary", { hasText: "Traces" }).click();
    const box = page.locator(".popover[open] label").first();
    const tick = box.locator("input");
    const before = await tick.isChecked();
    const { x, y, width, height } = await box.boundingBox();
    await page.mouse.click(x + width - 4, y + height / 2); // the words, not the box: the tab had crashed
    expectEqual(await tick.isChecked(), !before, "a press on the words ticks the box");
    expect(await page.locator(".popover[open]").count(), "it is open still");
    await page.locator(".recording_head").click({ position: { x: 5, y: 5 } });
    await until("a press elsewhere closes it", async () => (await page.locator(".popover[open]").count()) === 0);
    await page.locator("summary", { hasText: "Save plot" }).first().click();
    const menu = page.locator("details.out[open] > div").first();
    await menu.click({ position: { x: 2, y: 2 } });
    expect(await page.locator("details.out[open]").count(), "the menu is open still");
    expectNoComplaints(page);
  },

  async OrdersAnotherFitBesideTheFirst({ browser, studio, screenshots }) {
    for (const size of [
      [1024, 720],
      [1280, 720],
      [1920, 1080],
    ]) {
      const page = await prepare({ browser, studio }, { viewport: { width: size[0], height: size[1] } });
      await open(page, studio, "fits");
      await page.locator("table.fits").waitFor();
      await page.locator(".order_fold summary").first().click();
      const press = page.getByRole("button", { name: "Fit", exact: true });
      await press.scrollIntoViewIfNeeded();
      const isOnTop = await press.evaluate((it) => {
        const { x, y, width, height } = it.getBoundingClientRect();
        return it.contains(document.elementFromPoint(x + width / 2, y + height / 2));
      });
      expect(isOnTop, `nothing lies over the button at ${size.join(" x ")}`);
      await page.screenshot({ path: join(screenshots, `order-fit-${size[0]}.png`) });
      expectNoComplaints(page);
      await page.close();
    }
  },

  async KnowsWhoseAFitIsWhereNamesEndInNumbers({ browser, studio }) {
    studio.record("pork belly 1.h5", 10);
    studio.record("cut-2.h5", 10);
    studio.kerfOrThrow("fit", "pork belly 1.h5", "--models", "kelvin", "--folds", "2", "-o", "pork-belly-1.fit");
    studio.kerfOrThrow("fit", "cut-2.h5", "--models", "kelvin", "--folds", "2", "-o", "cut-2.fit");
    studio.record("cut.h5", 20);
    for (const name of ["cut.fit", "cut-3.fit"])
      studio.kerfOrThrow("fit", "cut.h5", "--models", "kelvin", "--folds", "2", "-o", name);
    studio.record("other.h5", 10);
    studio.kerfOrThrow("fit", "other.h5", "--models", "kelvin", "--folds", "2", "-o", "tuesday");
    await studio.serve();
    const page = await openPage(browser);
    const fitsOf = async (name) => {
      await page.goto(studio.page(`recording/${await studio.id("recordings", name)}/fits`));
      await page.locator("table.fits").waitFor();
      const list = page.locator(".tab_head select");
      return [await list.locator("option").allTextContents(), await list.locator("option:checked").textContent()];
    };
    expectEqual(await fitsOf("pork belly 1.h5"), [["pork-belly-1.fit"], "pork-belly-1.fit"], "of a name with blanks");
    expectEqual(await fitsOf("cut-2.h5"), [["cut-2.fit"], "cut-2.fit"], "of a recording called cut-2");
    expectEqual(await fitsOf("cut.h5"), [["cut.fit", "cut-3.fit"], "cut-3.fit"], "the newest is shown");
    expectEqual(await fitsOf("other.h5"), [["tuesday"], "tuesday"], "of a fit with a name of its own");
    expectNoComplaints(page);
  },
};
