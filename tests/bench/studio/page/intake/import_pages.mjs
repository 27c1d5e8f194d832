// Files of other programs taken in by the page: dropped, looked at, mapped, imported, as `kerf import` does it.

import { spawnSync } from "node:child_process";
import { existsSync, truncateSync, writeFileSync } from "node:fs";
import { mkdir, rm } from "node:fs/promises";
import { join } from "node:path";

import { audit } from "../accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "../harness.mjs";

/** A press in four cycles, as a logger writes it; two lines are none, one stands twice. */
export function press(rows = 4000) {
  const lines = ["Bench 7, run 3", "Time,Angle,Load", "ms,deg,N"];
  for (let i = 0; i < rows; ++i) {
    const turn = (2 * Math.PI * i) / (rows / 4);
    const closing = Math.sin(turn) >= 0;
    const angle = 10 * (1 - Math.cos(turn));
    lines.push(`${i},${angle.toFixed(4)},${(0.2 * angle + (closing ? 1 : 0.1)).toFixed(4)}`);
    if (i === 9) lines.push("the tool was lifted");
    if (i === 19) lines.push(lines.at(-1));
  }
  return `${lines.join("\n")}\n`;
}

async function prepare({ browser, studio }, options = {}) {
  if (!studio.process) await studio.serve();
  const page = await openPage(browser, options);
  await page.goto(studio.page("import"));
  await page.waitForSelector("main.import input[type=file]", { state: "attached" });
  return page;
}

async function source(studio, name, text) {
  const folder = join(studio.folder, "..", `${studio.folder.split("/").at(-1)}-from`);
  await mkdir(folder, { recursive: true });
  const file = join(folder, name);
  writeFileSync(file, text);
  return file;
}

const choose = (page, ...files) => page.setInputFiles("main.import input[type=file]", files);
const fits = (page) => until("it fits", async () => (await page.textContent(".verdict")).startsWith("It fits"));

const columnOf = (number) => `.preview thead th:nth-child(${number + 1})`;
const channelOf = (number) => `${columnOf(number)} select.channel`;
const unitOf = (number) => `${columnOf(number)} select.unit`;
async function choosesUnit(page, number, channel, unit) {
  await page.selectOption(channelOf(number), channel);
  await until("its units are offered", async () => page.locator(`${unitOf(number)} option[value="${unit}"]`).count());
  await page.selectOption(unitOf(number), unit);
}

async function importAll(page) {
  await page.getByRole("button", { name: /^Import/ }).click();
  await until("it is imported", async () => (await page.locator(".file_list li.file_done").count()) > 0);
}

export const tests = {
  async SaysOfAFileWithoutATimeThatItIsNotReadyAndImportsTheOthers({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const good = await source(studio, "good.csv", press());
    const lines = Array.from({ length: 400 }, (_, i) => `${(10 * Math.sin(i / 20)).toFixed(3)},${(i * i) % 17}`);
    const timeless = await source(studio, "timeless.csv", `Angle [deg],Load [N]\n${lines.join("\n")}\n`);
    await choose(page, good, timeless); // the first is the one that is shown
    await fits(page);
    const line = page.locator(".file_list li").filter({ hasText: "timeless.csv" });
    await line.getByText("not ready", { exact: true }).waitFor();
    expect(/time/i.test(await line.locator(".file_said").textContent()), "why");
    await page.getByRole("button", { name: "Import", exact: true }).click();
    await until("the other comes in", async () => (await page.locator(".file_list li.file_done").count()) === 1);
    expectEqual(await line.locator(".file_state").textContent(), "not ready", "and this one stays");
    await page.locator(".file_list").getByRole("button", { name: "timeless.csv", exact: true }).click();
    expect(await page.getByRole("button", { name: "Import", exact: true }).isDisabled(), "there is nothing to import");
    await page.getByLabel(/Rate/).first().fill("1000");
    await line.getByText("ready", { exact: true }).waitFor();
    expectNoComplaints(page);
  },

  async ImportsAFileAsTheProgramDoes({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const file = await source(studio, "Schnitt 3 (Süd).csv", press());
    await choose(page, file);
    await fits(page);
    expectEqual(
      await page.inputValue("input.map"),
      "time=1[ms],position=2[deg],force=3[N]",
      "columns and units that the header says",
    );
    expectEqual(await page.inputValue(".file_naming input"), "Schnitt-3-Sud", "the name of the recording");
    const left = await page.locator("tr.line_no_data th, tr.line_misplaced th").allTextContents();
    expectEqual(left, ["✕ 14", "✕ 25"], "lines that are left out, marked where they are");
    await page.fill(".file_naming input", "press");
    await importAll(page);
    const verb = studio.kerfOrThrow("import", file, "--map", "time=1,position=2,force=3", "-o", "by_verb.h5", "--json");
    const about = JSON.parse(verb.stdout);
    const said = await page.locator(".imported .warnings li span:last-child").allTextContents();
    expectEqual(said, about.warnings, "warnings are the program's");
    const [here, there] = ["press.h5", "by_verb.h5"].map((it) =>
      JSON.parse(studio.kerfOrThrow("info", it, "--json").stdout),
    );
    for (const key of ["samples", "duration_s", "channels", "source"]) expectEqual(here[key], there[key], key);
    await page.waitForSelector(".imported .time_plot");
    await page.getByRole("link", { name: "Open it" }).click();
    await page.waitForSelector("main.recording .time_plot");
    expectEqual(await page.textContent("h1"), "press.h5", "the recording is opened");
    expectNoComplaints(page);
  },

  async MapsColumnsByHandAndKeepsTheMapping({ browser, studio }) {
    const page = await prepare({ browser, studio });
    await choose(page, await source(studio, "plain.txt", press().split("\n").slice(3).join("\n")));
    await until("it is looked at", async () => (await page.locator(".preview thead th").count()) === 5);
    await choosesUnit(page, 1, "time", "ms");
    await choosesUnit(page, 2, "position", "deg");
    await page.selectOption(channelOf(3), "force");
    await page.selectOption(unitOf(3), "another");
    await page.keyboard.type("kg"); // whoever chooses another one types at once
    await until("what does not fit is said", async () =>
      (await page.textContent(".verdict.wrong").catch(() => "")).includes("is not a unit of force"),
    );
    expectEqual(
      (await page.locator(`${unitOf(3)} option`).allTextContents()).slice(0, 5),
      ["– unit –", "N", "mN", "kN", "uN"],
      "units of a force",
    );
    await page.selectOption(unitOf(3), "N");
    await fits(page);
    expectEqual(await page.inputValue("input.map"), "time=1[ms],position=2[deg],force=3[N]", "the map");
    await page.fill("input[aria-label='Name to save the mapping under']", "bench7");
    await page.getByRole("button", { name: "Save mapping" }).click();
    await until("it is saved", () => existsSync(join(studio.folder, "bench7.import.toml")));
    const file = await source(studio, "again.txt", press());
    studio.kerfOrThrow("import", file, "--map", "bench7.import.toml", "-o", "again.h5");
    await page.reload();
    await until("it is offered", async () =>
      (await page.locator(".mapping option").allTextContents()).includes("bench7"),
    );
    expectNoComplaints(page);
  },

  async PicksTheAxesOfAToolInSpace({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const lines = ["t,x,y,z,qx,qy,qz,qw,fx,fy,fz,mx,my,mz"];
    for (let i = 0; i < 400; ++i) {
      const turn = i / 400;
      const place = [Math.sin(6 * turn), Math.cos(6 * turn), turn].map((it) => (10 * it).toFixed(4));
      const orientation = [0, 0, Math.sin(turn / 2), Math.cos(turn / 2)].map((it) => it.toFixed(9));
      lines.push([i / 1000, ...place, ...orientation, "0.5", "0", "1.5", "0.01", "0", "0"].join(","));
    }
    const file = await source(studio, "pose.csv", `${lines.join("\n")}\n`);
    await choose(page, file);
    await until("it is looked at", async () => (await page.locator(".preview thead th").count()) === 16);
    for (let k = 2; k <= 14; ++k) await page.selectOption(channelOf(k), "");
    await choosesUnit(page, 1, "time", "s");
    await choosesUnit(page, 2, "position.x", "mm");
    await choosesUnit(page, 5, "orientation", "quaternion xyzw");
    await page.selectOption(channelOf(9), "force.x");
    await until("the frame is asked for", async () => (await page.textContent(".verdict")).includes("sensor"));
    await choosesUnit(page, 9, "force.x", "N sensor");
    await choosesUnit(page, 12, "torque.x", "Nm sensor");
    await fits(page);
    const map =
      "time=1[s],position=2:4[mm],orientation=5:8[quaternion xyzw],force=9:11[N sensor],torque=12:14[Nm sensor]";
    expectEqual(await page.inputValue("input.map"), map, "the map, with y and z beside x");
    expectEqual(
      [await page.inputValue(channelOf(4)), await page.inputValue(unitOf(11)), await page.inputValue(channelOf(7))],
      ["position.z", "N sensor", "orientation.3"],
      "what stands above the columns",
    );
    await page.selectOption(unitOf(5), "euler xyz deg");
    await until("three columns are enough now", async () => (await page.inputValue(channelOf(8))) === "");
    await page.selectOption(unitOf(5), "quaternion xyzw");
    await page.fill(".file_naming input", "pose");
    await importAll(page);
    studio.kerfOrThrow("import", file, "--map", map, "-o", "by_verb.h5");
    const [here, there] = ["pose.h5", "by_verb.h5"].map((it) =>
      JSON.parse(studio.kerfOrThrow("info", it, "--json").stdout),
    );
    expectEqual(here.channels, there.channels, "channels as the program's");
    expectNoComplaints(page);
  },

  async TakesTheColumnThatCountsOnForTheTime({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const numbers = press()
      .split("\n")
      .filter((it) => /^\d/.test(it))
      .map((it, i) =>
        [...it.split(",").slice(1).reverse(), "7", String(1783000 + 3 * i + (i % 3 === 0 ? 1 : 0))].join("\t"),
      );
    await choose(page, await source(studio, "unnamed.txt", `${numbers.join("\n")}\n`));
    await until("that it is a guess is said", async () => (await page.textContent(".verdict")).includes("is a guess"));
    await page.getByRole("button", { name: "Yes, these are the columns" }).click();
    await fits(page);
    expectEqual(await page.inputValue("input.map"), "time=4[ms],position=1[mm],force=2[N]", "what is suggested");
    expectEqual(await page.inputValue(channelOf(4)), "time", "the fourth of four unnamed columns");
    await page.selectOption(channelOf(4), "");
    const verdict = () => page.textContent(".verdict");
    await until("where to click is said", async () =>
      (await verdict()).includes("choose 'time' above one, or fill in 'Rate, without a time column [Hz]'"),
    );
    await page.getByLabel("Rate, without a time column [Hz]").fill("400");
    await fits(page);
    await page.selectOption(channelOf(2), "position");
    await page.selectOption(unitOf(2), "");
    await until("so it is for a unit", async () => (await verdict()).includes("choose one below its name"));
    expect(!(await verdict()).includes("--"), `in words of the page: ${await verdict()}`);
    expectNoComplaints(page);
  },

  async SaysAtItsPlaceWhatIsWrong({ browser, studio }) {
    studio.record("taken.h5", 2);
    const page = await prepare({ browser, studio });
    await choose(
      page,
      await source(studio, "photo.png", "\x89PNG\r\n\x1a\n"),
      await source(studio, "words.txt", "only words\nand more\n"),
      await source(studio, "empty.csv", ""),
      await source(studio, "good.csv", press(400)),
    );
    const said = (name) => page.locator(".file_list li", { hasText: name }).locator(".file_said").textContent();
    await until("the empty one is refused", async () => (await said("empty.csv")).includes("the file is empty"));
    for (const [name, why] of [
      ["photo.png", /./],
      ["words.txt", /words.txt: no line of numbers/],
    ]) {
      await page.locator(".file_list .file_name", { hasText: name }).click();
      await until(`${name} is refused in one line`, async () => why.test(await said(name)));
    }
    await page.locator(".file_list .file_name", { hasText: "good.csv" }).click();
    await fits(page);
    const name = page.getByLabel("Name of the recording of good.csv");
    await name.fill("taken");
    await until("the clash is said where it is typed", async () =>
      (await said("good.csv")).includes("taken.h5 is there already"),
    );
    expect(await page.getByRole("button", { name: /^Import/ }).isDisabled(), "nothing can be imported yet");
    await name.fill("a/b");
    await until("so is a name that cannot be", async () => (await said("good.csv")).includes("letters, digits"));
    await name.fill("good");
    await importAll(page);
    expect(existsSync(join(studio.folder, "good.h5")), "the good one has come in");
    expectNoComplaints(page, [/400/]);
  },

  async ReadsEachFileByItsOwnColumns({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const rows = Array.from({ length: 200 }, (_, i) => [0.01 * i, 8 * Math.sin(0.05 * i) ** 2]);
    const text = (head, of) => `${[head, ...rows.map((row) => of(...row).join(","))].filter(Boolean).join("\n")}\n`;
    const files = [
      await source(
        studio,
        "first.csv",
        text("time [s],position [mm],force [N]", (t, x) => [t, x, 0.3 * x]),
      ),
      await source(
        studio,
        "second.csv",
        text("time [s],force [N],position [mm]", (t, x) => [t, 0.3 * x, x]),
      ),
      await source(
        studio,
        "third.csv",
        text("time [ms],position [m],force [mN]", (t, x) => [1e3 * t, x / 1e3, 300 * x]),
      ),
      await source(
        studio,
        "nameless.csv",
        text("", (t, x) => [t, x, 0.3 * x]),
      ),
    ];
    await choose(page, ...files);
    await until("all have come", async () => (await page.locator(".file_list li.file_ready").count()) === 4);
    await page.getByRole("button", { name: "Import 4 files" }).click();
    await until("the one without names is asked about", async () =>
      (await page.textContent(".verdict")).includes("is a guess"),
    );
    expect(!existsSync(join(studio.folder, "first.h5")), "nothing has come in before");
    await choosesUnit(page, 2, "position", "mm");
    await choosesUnit(page, 3, "force", "N");
    await choosesUnit(page, 1, "time", "s");
    await fits(page);
    await page.getByRole("button", { name: "Import 4 files" }).click();
    await until("all are imported", async () => (await page.locator(".file_list li.file_done").count()) === 4);
    for (const name of ["first", "second", "third", "nameless"]) {
      const { signals } = JSON.parse(studio.kerfOrThrow("inspect", `${name}.h5`, "--json").stdout);
      expect(Math.abs(signals.position.most.value - 0.008) < 1e-4, `${name}: to ${signals.position.most.value} m`);
      expect(
        Math.abs(signals.force_measured.most.value - 2.4) < 0.03,
        `${name}: to ${signals.force_measured.most.value} N`,
      );
    }
    expectNoComplaints(page);
  },

  async TakesDroppedFilesFromAnyPage({ browser, studio }) {
    await studio.serve();
    const page = await openPage(browser);
    await page.goto(studio.page("studies"));
    await page.waitForSelector("h1");
    await page.evaluate((text) => {
      const files = new DataTransfer();
      for (const name of ["a.csv", "b.csv"]) files.items.add(new File([text], name));
      const event = (type) => new DragEvent(type, { dataTransfer: files, bubbles: true, cancelable: true });
      document.body.dispatchEvent(event("dragover"));
      document.body.dispatchEvent(event("drop"));
    }, press(400));
    await until("both are there", async () => (await page.locator(".file_list li.file_ready").count()) === 2);
    await fits(page);
    await page.getByRole("button", { name: "Import 2 files" }).click();
    await until("both are imported", async () => (await page.locator(".file_list li.file_done").count()) === 2);
    expect(
      existsSync(join(studio.folder, "a.h5")) && existsSync(join(studio.folder, "b.h5")),
      "both recordings are there",
    );
    expectNoComplaints(page);
  },

  async GoesOnAfterAStallAndAfterARestart({ browser, studio }) {
    const page = await prepare({ browser, studio });
    let pieces = 0;
    let broken = 0;
    await page.route("**/api/import/piece*", (route) => {
      ++pieces;
      if (pieces === 2 || pieces === 3) {
        ++broken;
        return route.abort("connectionreset");
      }
      return pieces > 5 ? new Promise(() => {}) : route.continue(); // then the network stalls
    });
    const text = press(120000);
    const file = await source(studio, "long.csv", text);
    await choose(page, file);
    await until("it stalls", () => pieces > 5);
    expectEqual(broken, 2, "broken pieces, after which it went on");
    const { uploads } = (await studio.api("/api/import")).json;
    expect(
      uploads[0].have > 0 && uploads[0].have < text.length,
      `${uploads[0].have} of ${text.length} bytes have come`,
    );
    await page.context().close();
    await studio.stop("SIGKILL");
    await studio.serve();
    const again = await prepare({ browser, studio });
    await until("it is still there", async () =>
      ((await again.textContent(".file_list .file_said").catch(() => "")) ?? "").includes("goes on where it stopped"),
    );
    let first = null;
    again.on("request", (it) => {
      if (it.url().includes("/api/import/piece")) first ??= Number(new URL(it.url()).searchParams.get("at"));
    });
    await choose(again, file);
    await fits(again);
    expectEqual(first, uploads[0].have, "where the next piece begins");
    await importAll(again);
    const { samples } = JSON.parse(studio.kerfOrThrow("info", "long.h5", "--json").stdout);
    expectEqual(samples, 120000, "rows");
  },

  async RefusesWhatIsTooLargeBeforeAnyOfItIsSent({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const file = await source(studio, "huge.csv", "");
    truncateSync(file, 5 * 2 ** 30); // takes no room of the disk
    let pieces = 0;
    page.on("request", (it) => (pieces += it.url().includes("/api/import/piece") ? 1 : 0));
    await choose(page, file);
    await until("it is refused in one line", async () =>
      ((await page.textContent(".file_said").catch(() => "")) ?? "").includes("kerf import at a terminal"),
    );
    expectEqual(pieces, 0, "pieces that were sent");
    await rm(file);
    expectNoComplaints(page, [/413/]);
  },

  async StopsAnImport({ browser, studio }) {
    const page = await prepare({ browser, studio });
    const files = [];
    for (let i = 0; i < 30; ++i) files.push(await source(studio, `many${i}.csv`, press(400)));
    await choose(page, ...files);
    await until("all have come", async () => (await page.locator(".file_list li.file_ready").count()) === 30);
    await fits(page);
    await page.getByRole("button", { name: "Import 30 files" }).click();
    await page.locator(".import_job button").click();
    await until("it has ended", async () => (await page.locator(".file_list li.file_importing").count()) === 0);
    const done = await page.locator(".file_list li.file_done").count();
    expect(done < 30, `${done} came in`);
    const listed = spawnSync("ls", [studio.folder], { encoding: "utf8" }).stdout.split("\n");
    expectEqual(listed.filter((it) => it.endsWith(".h5")).length, done, "recordings");
    expectNoComplaints(page);
  },

  async IsAccessible({ browser, studio, screenshots }) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await prepare({ browser, studio }, { colorScheme });
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, without a file`);
      await choose(page, await source(studio, `${colorScheme}.csv`, press()));
      await fits(page);
      await page.screenshot({ path: join(screenshots, `import-${colorScheme}.png`) });
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, with a file`);
      await importAll(page);
      await page.waitForSelector(".imported .time_plot");
      await page.waitForTimeout(1500); // what inspect flags comes after the lines
      await page.screenshot({ path: join(screenshots, `imported-${colorScheme}.png`) });
      expectEqual(await audit(page), [], `complaints, ${colorScheme}, imported`);
      await page.context().close();
    }
  },
};
