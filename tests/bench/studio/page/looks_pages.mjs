// Every page in light and dark: what WCAG 2.1 AA asks, no complaint of the browser, a picture of each, and the size
// of it all.

import { join } from "node:path";
import { gzipSync } from "node:zlib";

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";
import { makePunch } from "./recordings_pages.mjs";
import { makeStudy } from "./study_pages.mjs";
import { makeSweep } from "./sweep_pages.mjs";

/** A workspace in which every page has something to show. */
export async function furnish(studio) {
  studio.record("cut.h5", 20);
  studio.record("another_cut.h5", 10);
  studio.kerfOrThrow("session", "key", "keeper.key");
  const protocol = new URL("../../../../examples/sessions/abx.protocol.toml", import.meta.url).pathname;
  studio.makeSession(protocol);
  await makePunch(studio);
  await makeStudy(studio);
  await makeSweep(studio);
  const search = ["--max-force", "2", "--z-width", "--rungs", "3", "--repeats", "1", "--resolution", "0.2"];
  studio.kerfOrThrow(
    "identify",
    "sim:axis?hand=off&coulomb=0.1N&step=0.01mm&limit=40N",
    "--free",
    search,
    "-o",
    "axis",
  );
  await studio.serve("--key-file", join(studio.folder, "keeper.key"));
  const recording = await studio.id("recordings", "cut.h5");
  const work = async (path, body) => {
    const answer = (await studio.api(path, body)).json;
    if (answer.error) throw new Error(`${path}: ${answer.error}`);
    const { job } = answer;
    return until(
      `${path} is done`,
      async () => {
        const it = (await studio.api("/api/jobs")).json.find((each) => each.job === job);
        if (it.state === "failed") throw new Error(`${path}: ${it.error}`);
        return it.state === "done" ? it.file : null;
      },
      120000,
    );
  };
  return {
    recording,
    another: await studio.id("recordings", "another_cut.h5"),
    punch: await studio.id("recordings", "punch.h5"),
    device: await studio.id("files", "axis/identify.json"),
    study: (await studio.api("/api/studies")).json[0].id,
    sweep: await studio.id("files", "walls.merged/sweep.h5"),
    fit: await work("/api/fit", { recording, axis: "theta", models: ["kelvin", "exponential", "piecewise"], folds: 2 }),
    chart: await work("/api/chart", { recording, axis: "theta", models: ["kelvin", "exponential"] }),
    stability: await work("/api/stability", { device: "sim:scissors", rate_hz: 1000, grip: "light", cells: 40 }),
  };
}

async function settled(page) {
  await page.waitForTimeout(1200);
}

export const tests = {
  async "every page is fit to be seen, in light and dark"({ browser, studio, screenshots }) {
    const ids = await furnish(studio);
    const law = await until("the fit's laws are there", async () =>
      (await studio.api("/api/workspace")).json.laws.find((it) => it.name === "cut.fit/kelvin.law.toml"),
    );
    await studio.api("/api/live/start", { device: "sim:scissors" });
    expectEqual((await studio.api("/api/live/feel", { law: law.id })).status, 200, "a law is felt");
    const places = {
      scope: "scope",
      recordings: "recordings",
      import: "import",
      recording: `recording/${ids.recording}/time`,
      overlay: `recording/${ids.recording}/time?over=${ids.another}&align=cycle`,
      loops: `recording/${ids.recording}/loop?loops=average&over=${ids.another}`,
      editor: `recording/${ids.recording}/law`,
      fits: `recording/${ids.recording}/fits?fit=${ids.fit}`,
      chart: `recording/${ids.recording}/chart?chart=${ids.chart}`,
      report: `recording/${ids.recording}/report`,
      stability: `stability/${ids.stability}`,
      sessions: "sessions",
      device: `devices/${ids.device}`,
      flags: `recording/${ids.punch}/time`,
      study: `studies/${ids.study}`,
      work: "work/prepare?recording=cut.h5",
      sweep: `sweeps/${ids.sweep}?by=mass`,
    };
    const complaints = [];
    for (const colorScheme of ["light", "dark"]) {
      for (const [name, place] of Object.entries(places)) {
        const page = await openPage(browser, { colorScheme, reducedMotion: "reduce" });
        const look = async (picture) => {
          await page.screenshot({ path: join(screenshots, `${picture}-${colorScheme}.png`) });
          for (const it of await audit(page, { focus: colorScheme === "light" }))
            complaints.push(`${picture} ${colorScheme}: ${it}`);
        };
        await page.goto(studio.page(place));
        if (name === "editor") {
          await page.locator("g.knot").first().waitFor();
          await page.getByRole("button", { name: "Fill in the best" }).click();
        }
        // The scope's stream never rests; its window has to fill.
        if (name === "scope") await page.waitForTimeout(5500);
        else await settled(page);
        if (name === "study") await page.waitForFunction(() => document.querySelectorAll(".small_plot").length === 5);
        if (name === "sweep") await page.waitForSelector("g.brush .overlay");
        await look(name);
        if (name === "flags") {
          await page.click("#tab_cycles");
          await page.waitForSelector(".inspection table");
          await look("inspect");
        }
        if (name === "recordings") {
          await page.keyboard.press("?");
          await look("keys");
          await page.keyboard.press("?");
          await page.keyboard.press("Control+k");
          await page.keyboard.type("cut");
          await look("palette");
        }
        expectNoComplaints(page);
        await page.context().close();
      }
    }
    expectEqual(complaints, [], "what is not accessible");
  },

  async "the page is less than 150 kB"({ studio }) {
    await studio.serve();
    let bytes = 0;
    for (const path of ["/", "/studio.js", "/studio.css", "/icon.svg"]) {
      const answer = await fetch(studio.origin + path, { headers: { "X-Kerf-Token": studio.token } });
      bytes += gzipSync(Buffer.from(await answer.arrayBuffer())).length;
    }
    expect(bytes > 10000 && bytes < 150000, `${bytes} bytes compressed`);
  },
};
