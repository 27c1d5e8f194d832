// The scope as an instrument: trigger, cursors, views, markers, deadlines, and what it shows of a loop that has ended.

import { existsSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { join } from "node:path";

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

async function openScope(browser, studio, state = "", options = {}) {
  const page = await openPage(browser, options);
  await page.goto(studio.page(`scope${state}`));
  await page.getByRole("heading", { name: "Scope" }).waitFor();
  return page;
}

async function startLoop(studio) {
  expectEqual((await studio.api("/api/live/start", { device: "sim:scissors" })).status, 200, "the loop starts");
  await until("it runs", async () => (await studio.api("/api/live/status")).json.ticks > 3000);
}

const reading = (page) => page.locator(".time_reading").textContent();

export const tests = {
  async "a trigger holds the window about an edge"({ browser, studio, screenshots }) {
    await studio.serve();
    await startLoop(studio);
    const state = "?trigger=single&channel=position+theta&edge=rising&level=0.3";
    const page = await openScope(browser, studio, state);
    await page.getByText(/^triggered at \d+\.\d{3} s$/).waitFor();
    await page.getByRole("button", { name: "Go on" }).waitFor();
    expect(/^−1\.0+ s to 4\.0+ s/.test(await reading(page)), await reading(page));
    // At the trigger the position goes up through the level.
    const traces = (await studio.api("/api/live/traces")).json;
    const position = traces.findIndex((it) => it.name === "position theta");
    const rowsAbout = async (at) => {
      const answer = await fetch(
        `${studio.origin}/api/live/view?traces=${position}&from=${at - 0.02}&to=${at + 0.0201}&columns=100`,
        { headers: { "X-Kerf-Token": studio.token } },
      );
      const bytes = await answer.arrayBuffer();
      const [columns] = new Uint32Array(bytes, 0, 1);
      return { time: new Float64Array(bytes, 32, columns), values: new Float32Array(bytes, 32 + 8 * columns, columns) };
    };
    await until("it is the row that is the first at the level, not the column", async () => {
      const at = Number(/[\d.]+/.exec(await page.locator(".scope_trigger .scope_reading").textContent())[0]);
      const { time, values } = await rowsAbout(at);
      const row = values.findIndex((it) => it >= 0.3);
      return row > 0 && Math.abs(time[row] - at) < 6e-4;
    });
    const level = Number(await page.getByLabel("Level [deg]").inputValue());
    expect(Math.abs(level - (0.3 * 180) / Math.PI) < 1e-6, `${level} degrees are 0.3 rad`);
    await page.screenshot({ path: join(screenshots, "scope_trigger.png") });
    await page.getByRole("button", { name: "Go on" }).click();
    await page.getByRole("button", { name: "Go on" }).waitFor(); // and has it again
    await page.getByLabel("Trigger").selectOption("off");
    await page.getByRole("button", { name: "Go on" }).click();
    await page.getByRole("button", { name: "Pause" }).waitFor();
    await until("the address has no trigger any more", () => !page.url().includes("trigger="));
    await page.getByLabel("Trigger").selectOption("normal");
    await page.getByLabel("Level [deg]").fill("20");
    await page.getByLabel("Level [deg]").blur();
    await until("the address has it in rad", () => page.url().includes("level=0.349065850399"));
    expectNoComplaints(page);
  },

  async "a level that is never met waits, or lets time run"({ browser, studio }) {
    await studio.serve();
    await startLoop(studio);
    const page = await openScope(browser, studio, "?trigger=normal&channel=position+theta&level=99");
    await page.getByText("waiting", { exact: true }).waitFor();
    const plots = page.locator(".time_plots").first();
    const look = async () => (await plots.screenshot()).toString("base64");
    const first = await look();
    await until("time runs until the first", async () => (await look()) !== first);
  },

  async "two cursors tell what lies between them"({ browser, studio, screenshots }) {
    await studio.serve();
    await startLoop(studio);
    const page = await openScope(browser, studio);
    await page.getByRole("button", { name: "Pause" }).click();
    const box = await page.locator(".time_over").first().boundingBox();
    await page.mouse.move(box.x + 0.25 * box.width, box.y + 5);
    await page.getByRole("button", { name: "A here" }).focus();
    await page.keyboard.press("Enter");
    await page.mouse.move(box.x + 0.75 * box.width, box.y + 5);
    await page.getByRole("button", { name: "B here" }).focus();
    await page.keyboard.press("Enter");
    const text = await until("the difference is told", async () => {
      const it = await page.locator(".scope_cursors .scope_reading").textContent();
      return it.startsWith("B − A: ") ? it : null;
    });
    const apart = Number(/B − A: ([\d.]+) s/.exec(text)?.[1]);
    expect(Math.abs(apart - 2.5) < 0.05, `half of the window: ${text}`);
    expect(text.includes("0.4"), `its inverse: ${text}`);
    const row = page.locator(".scope_cursors tr", { hasText: "position theta" });
    const value = (it) => {
      expect(it.endsWith(" deg"), `in degrees, as the plot: ${it}`);
      return parseFloat(it);
    };
    // At one moment: what came in before the pause may still be drawn.
    const cells = await until("there are values", async () => {
      const it = await row.evaluate((each) => [...each.querySelectorAll("td")].map((cell) => cell.textContent));
      return it.every((cell) => /\d/.test(cell)) ? it : null;
    });
    const [a, b, difference] = cells.slice(0, 3).map((it) => value(it.replace("−", "-")));
    expect(Math.abs(b - a - difference) < 0.1, `${b} - ${a} is ${difference}`);
    const seen = await page.locator(".time_value").first().textContent(); // the pointer is at B still
    const between = /^([−\d.]+) to ([−\d.]+) deg$/.exec(seen)?.slice(1) ?? [parseFloat(seen), parseFloat(seen)];
    const [least, most] = between.map((it) => Number(String(it).replace("−", "-")));
    expect(b > least - 0.1 && b < most + 0.1, `${b} at B is what the plot reads, ${seen}`);
    await page.screenshot({ path: join(screenshots, "scope_cursors.png") });
    await page.getByRole("button", { name: "No cursors" }).click();
    await page.locator(".scope_cursors table").waitFor({ state: "hidden" });
  },

  async "force over position, and the spectrum, are views that a link opens again"({ browser, studio, screenshots }) {
    await studio.serve();
    await startLoop(studio);
    const page = await openScope(browser, studio);
    await page.getByRole("button", { name: "XY" }).click();
    await page.locator(".scope_canvas").first().waitFor();
    const drawn = async () => (await page.locator(".scope_view:not([hidden]) canvas").screenshot()).toString("base64");
    const first = await drawn();
    await until("it moves", async () => (await drawn()) !== first);
    await page.screenshot({ path: join(screenshots, "scope_xy.png") });
    await page.getByRole("button", { name: "Spectrum" }).click();
    expect(page.url().includes("view=spectrum"), page.url());
    await page.getByLabel("Spectrum of").selectOption("position theta");
    await until("the address says so", () => page.url().includes("spectrum=position"));
    await page.getByText(/Largest: [\d.]+ deg at .* Hz/).waitFor();
    await page.screenshot({ path: join(screenshots, "scope_spectrum.png") });
    await page.goBack();
    await page.locator(".scope_view:not([hidden]) >> text=Across").waitFor();
    await page.goForward();
    await page.reload();
    await page.getByText(/Largest: .* Hz/).waitFor();
    expectEqual(await page.getByLabel("Spectrum of").inputValue(), "position theta", "what the link says");
    expectNoComplaints(page);
  },

  async "force over position, and the spectrum, are handed out as they are drawn"({ browser, studio }) {
    await studio.serve();
    await startLoop(studio);
    const page = await openScope(browser, studio, "?view=xy");
    await page.getByRole("button", { name: "Pause" }).click();
    const given = async (kind) => {
      const menu = page.locator(".scope_view:not([hidden]) .out");
      await menu.locator("summary").click();
      const [file] = await Promise.all([
        page.waitForEvent("download"),
        menu.getByRole("button", { name: kind, exact: true }).click(),
      ]);
      return readFile(await file.path(), "utf8");
    };
    const tableOf = (text) => {
      const [heads, ...rows] = text.trim().split("\r\n");
      return { heads: heads.split(","), rows: rows.map((it) => it.split(",").map(Number)) };
    };
    const xy = tableOf(await given("CSV"));
    expectEqual(xy.heads, ["position theta [deg]", "force measured theta [N]"], "what is over what");
    expect(xy.rows.length > 100, `${xy.rows.length} places`);
    expect((await given("SVG")).includes("position theta [deg]"), "the axis says its unit");
    await page.getByRole("button", { name: "Spectrum" }).click();
    await page.getByLabel("Spectrum of").selectOption("position theta");
    const text = await until("it is there", async () => {
      const reading = await page.locator(".scope_view:not([hidden]) .scope_reading").textContent();
      return /Largest: .* at ([\d.]+) Hz/.exec(reading);
    });
    const { heads, rows } = tableOf(await given("CSV"));
    expectEqual(heads, ["frequency [Hz]", "amplitude of position theta [deg]"], "what is over what");
    const [hz] = rows.reduce((most, row) => (row[1] > most[1] ? row : most));
    expect(Math.abs(hz - Number(text[1])) < 1e-3 * hz, `${hz} Hz, and the page says ${text[1]}`);
    expectNoComplaints(page);
  },

  async "a marker goes into the recording"({ browser, studio }) {
    await studio.serve();
    await startLoop(studio);
    const page = await openScope(browser, studio);
    await studio.api("/api/live/record", { name: "marked" });
    await until("rows are recorded", async () => (await studio.api("/api/live/status")).json.recording?.rows > 100);
    await page.getByLabel("Marker").fill("the tissue tears");
    await page.getByRole("button", { name: "Mark", exact: true }).click();
    await page.locator(".event_list").getByText("mark: the tissue tears").waitFor();
    await studio.api("/api/live/record/stop", {});
    await until("the recording is there", () => existsSync(join(studio.folder, "marked.h5")));
    expectEqual(studio.kerf("validate", "marked.h5").status, 0, "kerf validate marked.h5");
    const id = await until("it is in the list", () => studio.id("recordings", "marked.h5"));
    const { events } = (await studio.api(`/api/recording?id=${id}`)).json;
    const mark = events.find((it) => it.kind === "mark");
    expectEqual(mark?.text, "the tissue tears", "what is in the file");
    expectEqual((await studio.api("/api/live/mark", { text: "two\nlines" })).status, 400, "two lines");
    await studio.api("/api/live/stop", {});
    await until("it has stopped", async () => !(await studio.api("/api/live/status")).json.running);
    expectEqual((await studio.api("/api/live/mark", { text: "late" })).status, 409, "without a loop");
  },

  async "a recording whose studio is killed is said to have ended without being closed, and is closed from the page"({
    browser,
    studio,
    screenshots,
  }) {
    await studio.serve();
    await startLoop(studio);
    const page = await openScope(browser, studio);
    await studio.api("/api/live/record", { name: "cut_off" });
    await until("rows are recorded", async () => (await studio.api("/api/live/status")).json.recording?.rows > 2000);
    await page.locator(".list_row").filter({ hasText: "cut_off" }).getByText("being recorded").waitFor();
    await studio.stop("SIGKILL");
    await page.getByText(/No answer for \d+ s: whether the loop runs is not known/).waitFor();
    await page.getByText(/cut_off\.h5: [\d,]+ rows, .* were written when the studio last answered/).waitFor();
    expectEqual(await page.getByText(/^Running at/).count(), 0, "what says that it runs");
    await page.screenshot({ path: join(screenshots, "scope_no_answer.png") });
    await page.context().close();

    await studio.serve();
    const next = await openScope(browser, studio);
    const panel = next.locator(".scope_panel .recorded");
    await panel.getByText("cut_off.h5.partial ended without being closed").waitFor();
    await next.locator(".list_row").filter({ hasText: "cut_off" }).getByText("not closed").waitFor();
    await next.screenshot({ path: join(screenshots, "scope_left_open.png") });
    expectEqual(await audit(next, { focus: false }), [], "what is not accessible");
    await next.locator(".list_row").filter({ hasText: "cut_off" }).click();
    await next
      .locator(".recording_facts")
      .getByText(/ended without being closed/)
      .waitFor();
    await next.goto(studio.page("scope"));
    await panel.getByRole("link", { name: "close it" }).click();
    await next.locator(".verb_page").getByRole("button", { name: "Run" }).click();
    await until("it is whole", () => existsSync(join(studio.folder, "cut_off.h5")));
    await until("and no longer open", () => !existsSync(join(studio.folder, "cut_off.h5.partial")));
    await next.goto(studio.page("scope"));
    await panel.getByText("Not recording", { exact: true }).waitFor();
    expectNoComplaints(next);
  },

  async "deadlines are told, and a loop that has ended is not shown as one that runs"({
    browser,
    studio,
    screenshots,
  }) {
    await studio.serve();
    await startLoop(studio);
    const page = await openScope(browser, studio);
    await page.getByText(/Deadlines: \d+ missed, \d+ late of \d+ /).waitFor();
    await studio.api("/api/live/stop", {});
    await page.getByText("Stopped: this is the end of the last loop.").waitFor();
    expect(await page.locator(".scope_page.is_stopped").isVisible(), "it is grey");
    await page.screenshot({ path: join(screenshots, "scope_stopped.png") });
    await page.reload();
    await page.getByText("Stopped: this is the end of the last loop.").waitFor();
    await startLoop(studio);
    await until("it runs again", async () => !(await page.locator(".scope_page.is_stopped").count()));
    expectNoComplaints(page);
  },

  async "every view of the scope is fit to be seen, in light and dark"({ browser, studio, screenshots }) {
    await studio.serve();
    await startLoop(studio);
    const states = {
      instrument: "?trigger=auto&channel=position+theta&level=0.3",
      xy: "?view=xy",
      spectrum: "?view=spectrum",
    };
    const complaints = [];
    for (const colorScheme of ["light", "dark"]) {
      for (const [name, state] of Object.entries(states)) {
        const page = await openScope(browser, studio, state, { colorScheme, reducedMotion: "reduce" });
        await page.waitForTimeout(5500); // until the window is full
        await page.screenshot({ path: join(screenshots, `scope_${name}-${colorScheme}.png`) });
        for (const it of await audit(page, { focus: false })) complaints.push(`${name} ${colorScheme}: ${it}`);
        expectNoComplaints(page);
        await page.context().close();
      }
    }
    expectEqual(complaints, [], "what is not accessible");
  },
};
