// The scope on a running loop: what it draws, what it lets a person do, and what it does when the server is away.

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

const start = (page) => page.click(".controls form button[type=submit]");
const state = (page) => page.textContent(".ended");
const live = async (studio) => (await studio.api("/api/live/status")).json;

async function openScope({ browser, studio }, options = {}) {
  if (!studio.process) await studio.serve();
  const page = await openPage(browser, options);
  await page.goto(studio.page("scope"));
  await until("the page knows the loop", async () => (await state(page)) !== "");
  return page;
}

async function startLoop(page) {
  await start(page);
  await until("the loop runs", async () => (await state(page)).startsWith("Running at"));
  await until("plots are there", async () => (await page.locator(".time_plot").count()) >= 4);
}

/** How many pixels of the lines of each plot are inked. */
function inked(page) {
  return page.$$eval(".time_plot", (plots) =>
    plots.map((it) => {
      const canvas = it.querySelector("canvas.time_layer:last-of-type");
      if (!canvas || canvas.width < 2) return 0;
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 3; i < data.length; i += 4) count += data[i] > 0 ? 1 : 0;
      return count;
    }),
  );
}

export const tests = {
  async DrawsEveryPlotOfARunningLoop({ browser, studio, screenshots }) {
    const page = await openScope({ browser, studio });
    await startLoop(page);
    await until("lines are drawn", async () => (await inked(page)).every((it) => it > 300));
    await page.screenshot({ path: `${screenshots}/scope.png` });
    expectNoComplaints(page);
  },

  async PausesZoomsAndGoesOn({ browser, studio }) {
    const page = await openScope({ browser, studio });
    await startLoop(page);
    await until("lines are drawn", async () => (await inked(page)).every((it) => it > 300));
    await page.focus(".time_focus");
    await page.keyboard.press("Space");
    expectEqual(await page.textContent(".scope_head button"), "Go on", "the button");
    const asked = page.waitForResponse((it) => it.url().includes("/api/live/view") && it.status() === 200);
    await page.keyboard.press("End");
    for (let i = 0; i < 5; ++i) await page.keyboard.press("+");
    await asked;
    await until("all five steps are shown", async () => (await page.textContent(".time_reading")).includes("(156 ms)"));
    const still = await page.textContent(".time_reading");
    await page.waitForTimeout(300);
    expectEqual(await page.textContent(".time_reading"), still, "what is shown while it is paused");
    await page.keyboard.press("ArrowLeft");
    await until("the cursor reads values", async () => (await page.textContent(".time_value")) !== "");
    await page.keyboard.press("Space");
    await until("it goes on", async () => (await page.textContent(".time_reading")).includes("(5 s)"));
    expectNoComplaints(page);
  },

  async ReleasesTheForceFromTheKeyboardAndLetsItBack({ browser, studio }) {
    const page = await openScope({ browser, studio });
    await startLoop(page);
    await page.keyboard.press("Escape");
    await until("the loop has released the force", async () => (await live(studio)).released);
    await until("the page says so", async () => (await state(page)).startsWith("Zero force"));
    await page.getByRole("button", { name: "Let force back" }).click();
    await until("the force is back", async () => !(await live(studio)).released);
    await page.keyboard.press("?");
    expect(await page.isVisible("#help"), "the help is open");
    await page.locator("#zero").dispatchEvent("pointerdown");
    await until("the button works beside the help", async () => (await live(studio)).released);
    expectNoComplaints(page);
  },

  async RecordsUnderTheGivenName({ browser, studio }) {
    const page = await openScope({ browser, studio });
    await startLoop(page);
    await page.fill(".record input", "from_the_scope");
    await page.click(".record button");
    await until("rows are counted", async () => /^[1-9][\d,]* rows/.test(await page.textContent(".recorded")));
    await page.click(".record button");
    await until("it is closed", async () => (await page.textContent(".recorded")).startsWith("Saved as"));
    expect(await studio.id("recordings", "from_the_scope.h5"), "the recording is in the workspace");
    expectNoComplaints(page);
  },

  async SaysWhatIsWrongWithADevice({ browser, studio }) {
    const page = await openScope({ browser, studio });
    await page.fill(".controls form input", "nonsense:device");
    await start(page);
    await until("the notice says why", async () => (await page.textContent("#notice")).includes("nonsense"));
    expectNoComplaints(page, [/status of 4\d\d/, /status of 500/]);
  },

  async SaysSinceWhenItIsStaleAndComesBackByItself({ browser, studio }) {
    const page = await openScope({ browser, studio });
    await startLoop(page);
    studio.process.kill("SIGSTOP");
    await until("it is stale", async () => /^Stale since \d+ s$/.test(await page.textContent(".stale")));
    studio.process.kill("SIGCONT");
    await until("it is not any more", async () => (await page.textContent(".stale")) === "");
    await until("lines are drawn", async () => (await inked(page)).every((it) => it > 300));
  },

  async IsAccessible({ browser, studio, screenshots }) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await openScope({ browser, studio }, { colorScheme });
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, nothing runs`);
      await startLoop(page);
      expectEqual(await audit(page), [], `complaints, ${colorScheme}`);
      await page.screenshot({ path: `${screenshots}/scope_${colorScheme}.png` });
      await page.keyboard.press("?");
      expectEqual(await audit(page, { focus: false }), [], `complaints, ${colorScheme}, with the help`);
      await studio.api("/api/live/stop", {});
      await until("the loop has ended", async () => !(await live(studio)).running);
    }
  },

  async NothingMovesWhileItRuns({ browser, studio }) {
    const page = await openScope({ browser, studio });
    await startLoop(page);
    await until("lines are drawn", async () => (await inked(page)).every((it) => it > 300));
    await page.evaluate(() => {
      window.shifts = [];
      // In the list at the left the recording that begins takes its place, whenever the folder is next looked at.
      const besideTheList = (source) => !source.node?.parentElement?.closest(".side_list");
      new PerformanceObserver((list) => {
        for (const it of list.getEntries())
          window.shifts.push(
            ...it.sources
              .filter(besideTheList)
              .map((source) => (source.node?.parentElement ?? document.body).outerHTML.slice(0, 120)),
          );
      }).observe({ type: "layout-shift" });
    });
    const box = await page.locator(".time_over").first().boundingBox();
    await page.mouse.move(box.x + 200, box.y + 20);
    await page.mouse.move(box.x + 300, box.y + 20, { steps: 10 });
    await page.keyboard.press("Escape");
    await until("the page says so", async () => (await state(page)).startsWith("Zero force"));
    await page.click(".record button");
    await page.waitForTimeout(1500);
    expectEqual(await page.evaluate(() => window.shifts), [], "what has moved");
  },
};
