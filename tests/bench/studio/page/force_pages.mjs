// The bar of every page: zero force from anywhere, what there is of force in the hand, and who may let it back.

import { writeFile } from "node:fs/promises";
import { join } from "node:path";

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

const places = ["scope", "recordings", "editor", "fits", "chart", "stability", "sessions"];
const status = async (studio) => (await studio.api("/api/live/status")).json;
const state = (page) => page.getAttribute("#force_bar", "data-state");
const words = (page) => page.textContent("#force_bar p");
const letBack = (page) => page.getByRole("button", { name: "Let force back" });

async function open(browser, studio, place = "scope", options = {}) {
  const page = await openPage(browser, options);
  await page.goto(studio.page(place));
  await page.getByRole("heading", { level: 1 }).waitFor();
  return page;
}

async function isInState(page, wanted) {
  await until(`the bar says ${wanted}`, async () => (await state(page)) === wanted);
}

async function startLoop(studio, device = "sim:scissors") {
  expectEqual((await studio.api("/api/live/start", { device })).status, 200, "the loop starts");
}

async function isReleased(studio, why) {
  await until(why, async () => (await status(studio)).released);
}

const kelvin = `model = "kelvin"
axis = "theta"
position_unit = "rad"
[contact]
position = { value = 30, unit = "deg" }
direction = "decreasing"
[parameters]
parallel_stiffness = { value = 5.0, unit = "N/rad" }
series_stiffness = { value = 8.0, unit = "N/rad" }
damping = { value = 1.6, unit = "N·s/rad" }
`;

export const tests = {
  async "in a small window the words of every state are whole, and the button that takes the force stays"({
    browser,
    studio,
    screenshots,
  }) {
    await studio.serve();
    const status = (await studio.api("/api/live/status")).json;
    const page = await openPage(browser, { viewport: { width: 640, height: 360 } });
    let told = {};
    await page.route("**/api/live/status", (route) => route.fulfill({ json: { ...status, ...told } }));
    await page.goto(studio.page("recordings"));
    const zero = page.locator("#zero");
    const before = await zero.boundingBox();
    for (const [force, more, words] of [
      ["free", { running: true }, "Running without force"],
      ["rendered", { running: true, law: "a_long_name_of_a_law_that_somebody_gave.law.toml" }, "Force on"],
      ["zero", {}, "no loop is running"],
      ["held", { running: true, force_reason: "the position has jumped" }, "See where the tool is"],
      ["lost", { force_reason: "the device /dev/serial/by-id/usb-u6 has not answered for 0.25 s" }, "Ended by a fault"],
    ]) {
      told = { force, ...more };
      const said = page.locator("#force_bar p").filter({ hasText: words });
      await said.waitFor();
      expect(await said.evaluate((it) => it.scrollHeight <= it.clientHeight + 1), `${force}: its words are cut`);
      expectEqual(await zero.boundingBox(), before, `${force}: where the button is`);
      await page.screenshot({ path: join(screenshots, `bar_${force}_640.png`) });
    }
    expectNoComplaints(page);
  },

  async "a tab from before the studio was started anew makes zero force, and says that it is old"({ browser, studio }) {
    await studio.serve();
    const old = await open(browser, studio, "fits");
    await isInState(old, "idle");
    await studio.stop();
    await isInState(old, "silent");
    expect((await words(old)).startsWith("No answer from the studio"), "nobody is there");
    await studio.serve("--port", new URL(studio.origin).port);
    await isInState(old, "outdated");
    expect((await words(old)).includes("older than the studio that runs"), await words(old));
    await startLoop(studio);
    await old.getByRole("button", { name: "Zero force" }).click();
    await isReleased(studio, "the old tab's zero force is heard");
    await until("the old tab says so", async () => (await words(old)).startsWith("Zero force was heard."));

    await old.getByRole("button", { name: "Reload" }).click();
    await until("no tab knows the address", async () => /open the address/.test(await old.textContent("#notice")));
    const young = await old.context().newPage();
    await young.goto(studio.page("scope"));
    await isInState(young, "zero");
    await old.getByRole("button", { name: "Reload" }).click();
    await isInState(old, "zero");
    await letBack(old).click();
    await until("the force is back", async () => !(await status(studio)).released);
  },

  async "old tabs ask rarely, and make zero force also where the studio has had enough of refusing"({
    browser,
    studio,
  }) {
    await studio.serve();
    const tabs = [];
    for (const place of ["scope", "sessions"]) tabs.push(await open(browser, studio, place));
    for (const tab of tabs) await isInState(tab, "idle");
    await studio.stop("SIGKILL");
    await studio.serve("--port", new URL(studio.origin).port);
    for (const tab of tabs) await isInState(tab, "outdated");
    // Of their own studio they would ask for its stream, and for the state of sessions twice a second.
    const asked = tabs.map(() => []);
    tabs.forEach((tab, k) => tab.on("request", (it) => asked[k].push(new URL(it.url()).pathname)));
    await until("they go on to ask for the status", () => asked.every((it) => it.length >= 3));
    const others = asked.flat().filter((it) => it !== "/api/live/status");
    if (others[0] === "/api/live/stream") others.shift(); // the browser may have been opening it again
    expectEqual(others, [], "what else is asked for");
    const [old] = tabs;
    await old.route("**/api/live/status", (route) => route.fulfill({ status: 429, body: "Too Many Requests" }));
    await startLoop(studio);
    await old.getByRole("button", { name: "Zero force" }).click();
    await isReleased(studio, "its zero force is heard");
    await until("it says so", async () => (await words(old)).startsWith("Zero force was heard."));
    expect(await old.getByRole("button", { name: "Reload" }).isVisible(), "it can be reloaded");
  },

  async "a refusal is told in the studio's words, and only silence is called so"({ browser, studio }) {
    await studio.serve();
    const page = await open(browser, studio);
    const answers = { status: 503, contentType: "application/json", body: '{"error":"too much to do; try again"}' };
    await page.route("**/api/live/status", (route) => route.fulfill(answers));
    await isInState(page, "refused");
    expect((await words(page)).includes("too much to do"), await words(page));
    await page.unroute("**/api/live/status");
    await isInState(page, "idle");
    // What else is slow does not make the studio silent.
    await page.route("**/api/**", (route) => (route.request().url().endsWith("/status") ? route.continue() : null));
    await page.goto(studio.page("sessions")); // which asks twice a second
    await page.waitForTimeout(4000);
    expectEqual(await state(page), "idle", "what the bar says of a studio whose other answers stay away");
  },

  async "Escape makes zero force at the first press, whatever is open or has the focus"({ browser, studio }) {
    studio.record("cut.h5", 10);
    await studio.serve();
    await startLoop(studio);
    const recording = await studio.id("recordings", "cut.h5");
    const everywhere = [...places, `recordings/${recording}`, `editor/${recording}`];
    const page = await openPage(browser);
    const press = async (where) => {
      await studio.api("/api/live/resume", {});
      await isInState(page, "free");
      await page.keyboard.press("Escape");
      await isReleased(studio, `Escape is heard ${where}`);
    };
    for (const place of everywhere) {
      await page.goto("about:blank");
      await page.goto(studio.page(place));
      await page.getByRole("heading", { level: 1 }).waitFor();
      await press(`on ${place}`);
      await page.locator("#help_opener").click();
      await press(`on ${place}, with the help open`);
      for (const kind of ["select", "input", "summary", "[tabindex='0']"]) {
        const control = page.locator(`main ${kind}:visible:enabled`).first();
        if ((await control.count()) === 0) continue;
        await control.focus();
        if (kind === "select") await control.click(); // its list is open
        await press(`on ${place}, in ${kind}`);
      }
    }
  },

  async "an Escape that is kept down in an open list is heard before it is let go"({ browser, studio }) {
    await studio.serve();
    await startLoop(studio);
    const page = await open(browser, studio);
    await page.getByLabel("Window").click();
    await page.keyboard.down("Escape");
    await page.keyboard.down("Escape"); // as a key repeats itself
    await isReleased(studio, "it is heard");
    await page.keyboard.up("Escape");
  },

  async "the bar says on every page what there is of force"({ browser, studio }) {
    await writeFile(join(studio.folder, "a.law.toml"), kelvin);
    await studio.serve();
    const page = await openPage(browser);
    const everywhere = async (wanted, text) => {
      for (const place of places) {
        await page.goto(studio.page(place));
        await isInState(page, wanted);
        expect((await words(page)).includes(text), `${place}: ${await words(page)}`);
      }
    };
    await everywhere("idle", "No loop is running");
    await startLoop(studio);
    await everywhere("free", "without force");
    await studio.api("/api/live/feel", { law: await studio.id("laws", "a.law.toml") });
    await everywhere("rendered", "Force on: a");
    await studio.api("/api/live/zero", {});
    await everywhere("zero", "Zero force is held");
    await letBack(page).click();
    await isInState(page, "rendered");
    expect(!(await letBack(page).isVisible()), "there is nothing to let back");
  },

  async "a device that is lost is told on every page, until it is dismissed or another loop starts"({
    browser,
    studio,
  }) {
    await studio.serve();
    const page = await openPage(browser);
    await startLoop(studio, "sim:scissors?fault=unplug@0.1");
    for (const place of places) {
      await page.goto(studio.page(place));
      await isInState(page, "lost");
      expect((await words(page)).includes("the device was lost"), `${place}: ${await words(page)}`);
    }
    await page.getByRole("button", { name: "Dismiss" }).click();
    await isInState(page, "idle");
    await startLoop(studio, "sim:scissors?fault=unplug@0.1");
    await isInState(page, "lost");
    await startLoop(studio);
    await isInState(page, "free");
  },

  async "zero force after a jump is held on every page until somebody confirms where the tool is"({ browser, studio }) {
    await studio.serve();
    await startLoop(studio, "sim:scissors?fault=jump@0.2:20mm");
    const page = await openPage(browser);
    for (const place of places) {
      await page.goto(studio.page(place));
      await isInState(page, "held");
      expect((await words(page)).includes("the position has jumped"), `${place}: ${await words(page)}`);
    }
    await page.keyboard.press("Escape");
    await isInState(page, "zero");
    await letBack(page).click();
    await isInState(page, "held");
    await page.getByRole("button", { name: "It is there: confirm" }).click();
    await isInState(page, "free");
  },

  async "what takes the force does not let it back: no double click, no Escape, no key that is kept down"({
    browser,
    studio,
  }) {
    await studio.serve();
    await startLoop(studio);
    const page = await open(browser, studio);
    let resumed = 0;
    page.on("request", (request) => (resumed += request.url().includes("/resume") ? 1 : 0));
    const zero = page.getByRole("button", { name: "Zero force" });
    await zero.dblclick();
    await isInState(page, "zero");
    await zero.focus();
    for (const key of ["Enter", "Enter", "Space", "Escape", "Escape"]) await page.keyboard.press(key);
    await isInState(page, "zero");
    const [taken, back] = [await zero.boundingBox(), await letBack(page).boundingBox()];
    expect(back.x + back.width + 20 <= taken.x, "they are apart");
    await page.keyboard.press("Escape");
    await isInState(page, "zero");
    await letBack(page)
      .click({ timeout: 50, force: true })
      .catch(() => {}); // too soon to be meant
    expectEqual([resumed, (await status(studio)).released], [0, true], "what was let back");
    // By the keyboard, one before the other.
    await until("it can be pressed", () => letBack(page).isEnabled());
    await zero.focus();
    await page.keyboard.press("Shift+Tab");
    await page.keyboard.press("Enter");
    await until("the force is back", async () => !(await status(studio)).released);
    await isInState(page, "free");
    expectEqual(await page.evaluate(() => document.activeElement.id), "zero", "where the focus is then");
  },

  async "every state can be read, by day and in the dark, on a narrow page too"({ browser, studio, screenshots }) {
    await studio.serve();
    const now = await status(studio);
    const states = {
      idle: {},
      free: { running: true },
      rendered: { running: true, law: "cut.fit/kelvin.law.toml", recording: { name: "a.h5", rows: 1000, seconds: 1 } },
      zero: { running: true, released: true },
      held: { running: true, force_reason: "the position has jumped" },
      lost: {
        ended: "sim:scissors: the device was lost: it said nothing for 100 ms",
        force_reason: "the device was lost: it said nothing for 100 ms",
      },
      session: { session: true },
      starting: { starting: true },
      silent: null,
      outdated: null,
    };
    const complaints = [];
    const grounds = new Map();
    for (const colorScheme of ["light", "dark"]) {
      const page = await openPage(browser, { colorScheme, reducedMotion: "reduce" });
      let force = "idle";
      await page.route("**/api/live/status", (route) => {
        if (force === "silent") return route.abort();
        if (force === "outdated") return route.fulfill({ status: 403, body: "This address is not valid." });
        return route.fulfill({ json: { ...now, ...states[force], force } });
      });
      await page.goto(studio.page("recordings"));
      for (force of Object.keys(states)) {
        await isInState(page, force);
        await page.waitForTimeout(800); // the button may be pressed by then
        for (const it of await audit(page, { focus: false })) complaints.push(`${force} ${colorScheme}: ${it}`);
        grounds.set(
          `${force} ${colorScheme}`,
          await page.$eval("#force_bar", (it) => getComputedStyle(it).backgroundColor),
        );
        for (const [name, width] of [
          ["", 1280],
          ["_narrow", 480],
        ]) {
          await page.setViewportSize({ width, height: 720 });
          const bar = page.locator("#force_bar");
          await bar.screenshot({ path: join(screenshots, `force_${force}_${colorScheme}${name}.png`) });
          const cut = await bar.evaluate((it) => {
            const boxes = [...it.children]
              .filter((child) => !child.hidden)
              .map((child) => child.getBoundingClientRect());
            return (
              boxes.some((box) => box.left < 0 || box.right > innerWidth) ||
              it.querySelector("p").scrollHeight > it.querySelector("p").clientHeight
            );
          });
          expect(!cut, `${force} at ${width} is seen as a whole`);
        }
        await page.setViewportSize({ width: 1280, height: 720 });
      }
      const own = ["idle", "free", "rendered", "zero", "lost", "silent"].map((it) =>
        grounds.get(`${it} ${colorScheme}`),
      );
      expectEqual(new Set(own).size, own.length, `colours of their own, ${colorScheme}`);
    }
    expectEqual(complaints, [], "what is not accessible");
  },
};
