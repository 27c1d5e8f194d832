// A whole blind session: the experimenter begins it, the subject answers every trial on a page of their own.

import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

const protocol = `name = "one law or another"
design = "abx"
instructions = "Close and open the scissors."
trials = 4
practice = 0
device = "sim:scissors"

[apparatus]
headphones = "closed, over both ears"
checks = ["the curtain hides the hand", "the door is shut"]

[[sample]]
name = "soft"
law = "soft.law.toml"

[[sample]]
name = "hard"
law = "hard.law.toml"
`;

/** The Kelvin law of the examples, with another parallel spring. */
async function law(stiffness) {
  const example = await readFile(new URL("../../../../examples/kelvin.law.toml", import.meta.url), "utf8");
  return example.replace(/(parallel_stiffness = { value = )\d+/, `$1${stiffness}`);
}

async function prepare(studio, device = "sim:scissors") {
  await writeFile(join(studio.folder, "abx.protocol.toml"), protocol.replace("sim:scissors", device));
  await writeFile(join(studio.folder, "soft.law.toml"), await law(6));
  await writeFile(join(studio.folder, "hard.law.toml"), await law(12));
  studio.kerfOrThrow("session", "key", "keeper.key");
  studio.makeSession("abx.protocol.toml");
  await studio.serve("--key-file", join(studio.folder, "keeper.key"));
}

/** What the experimenter's page is given has no name of a sample, no slot, no level and no answer. */
function tellsNothing({ status, json }) {
  expectEqual(status, 200, "the answer");
  const text = JSON.stringify(json);
  for (const told of ['"soft"', "hard", "slot", "level", "correct", "answers", "plays"])
    expect(!text.includes(told), `${told} in ${text}`);
}

/** Goes on, feels every slot and answers, as long as the page lets. */
async function takePart(page) {
  const press = async (selector) => {
    const button = page.locator(selector).first();
    if (!(await button.isVisible()) || !(await button.isEnabled())) return;
    // It may go while it is being pressed: the next round sees what there is then.
    await button.click({ timeout: 500 }).catch(() => {});
  };
  while ((await page.textContent("#heading")) !== "Finished") {
    await press("#go_on button.firm");
    for (const slot of [1, 2, 3]) {
      await press(`#feel_row button:nth-child(${slot})`);
      await page.waitForTimeout(550);
    }
    await press("#answer_row button");
  }
}

/** What stands in the fields of a form of Work, and is ticked. */
const given = (page) =>
  page
    .locator(".verb_page")
    .evaluate((it) =>
      [...it.querySelectorAll("input:not([type=checkbox]), input:checked, select")].map((field) => field.value),
    );

export const tests = {
  async "an experiment is rehearsed and made by forms that are filled in"({ browser, studio }) {
    await prepare(studio);
    const page = await openPage(browser);
    for (const [way, title] of [
      ["Rehearse", "Rehearse a session with simulated observers"],
      ["Make a session", "Make a session"],
    ]) {
      await page.goto(studio.page("sessions"));
      await page.getByRole("link", { name: `${way} abx.protocol.toml` }).click();
      await page.getByRole("heading", { name: title }).waitFor();
      await page.locator(".verb_page").waitFor();
      expect((await given(page)).includes("abx.protocol.toml"), `${way}: ${JSON.stringify(await given(page))}`);
    }
    // Made from the page, it is there to be begun.
    await page.locator(".verb_page").getByLabel("output").fill("S07");
    await page.locator(".verb_page").getByLabel("subject", { exact: true }).fill("S07");
    await page.getByRole("button", { name: "Run" }).click();
    await page.locator(".job_page", { hasText: "done" }).waitFor();
    await page.goto(studio.page("sessions"));
    await page.getByRole("button", { name: "Begin S07.h5" }).waitFor();
    expectNoComplaints(page);
  },

  async "a protocol is written by a form, tried as it is written, changed by hand, and a session made of it"({
    browser,
    studio,
    screenshots,
  }) {
    await writeFile(join(studio.folder, "soft.law.toml"), await law(6));
    await writeFile(join(studio.folder, "hard.law.toml"), await law(12));
    await writeFile(join(studio.folder, "there.protocol.toml"), protocol);
    studio.kerfOrThrow("session", "key", "keeper.key");
    await studio.serve("--key-file", join(studio.folder, "keeper.key"));
    const page = await openPage(browser);
    await page.goto(studio.page("sessions"));
    await page.getByRole("link", { name: "Write a protocol" }).click();
    const verdict = page.locator(".protocol .verdict");
    await page.getByLabel("hard.law.toml").check();
    await until("what is missing is said", async () => /sample/.test(await verdict.textContent()));
    await page.getByLabel("soft.law.toml").check();
    await page.getByLabel("Trials", { exact: true }).fill("8");
    await page.getByLabel("Rehearsals move from [deg]").fill("32");
    await page.getByLabel("to [deg]", { exact: true }).fill("8");
    await until("it can be run", async () => /^It can be run: 12 trials/.test(await verdict.textContent()));
    const save = page.getByRole("button", { name: "Save" });
    expect(await save.isDisabled(), "without a name it is not saved");
    const name = page.getByLabel("Name of the file");
    for (const [typed, why] of [
      ["soft or hard", /letters, digits/],
      ["there", /there\.protocol\.toml is there already/],
    ]) {
      await name.fill(typed);
      await page.locator("#protocol_name_why").filter({ hasText: why }).waitFor();
      expectEqual(await name.getAttribute("aria-invalid"), "true", typed);
      await page.locator(".protocol .verdict:not([aria-busy])").waitFor();
      expect(await save.isDisabled(), `${typed} is no name for it`);
    }
    await name.fill("soft-or-hard");
    await until("it can be saved", () => save.isEnabled());
    for (const colorScheme of ["light", "dark"]) {
      await page.emulateMedia({ colorScheme });
      expectEqual(await audit(page), [], `what of a new protocol is not accessible, ${colorScheme}`);
      await page.getByRole("heading", { name: "A new protocol" }).scrollIntoViewIfNeeded();
      await page.screenshot({ path: join(screenshots, `protocol-${colorScheme}.png`), fullPage: true });
    }
    await page.reload();
    await page.getByText("This is as it was left, and is not saved").waitFor();
    await until("it can be saved after a reload", () => save.isEnabled());
    await save.click();
    await page.getByText("soft-or-hard.protocol.toml is saved").waitFor();

    // By hand, where the form has no field for it.
    await page.getByRole("link", { name: "Change soft-or-hard.protocol.toml" }).click();
    const text = page.getByLabel("The protocol as text");
    await until("its text is there", async () => (await text.inputValue()).includes('design = "abx"'));
    await text.fill(`${await text.inputValue()}\n[catch]\nevery = "seven"\n`);
    await until("the line that is wrong is named", async () => /protocol\.toml:\d+:/.test(await verdict.textContent()));
    expect(await save.isDisabled(), "what is wrong is not saved");
    await text.fill((await text.inputValue()).replace(/\n\[catch\][^]*$/, "").replace("trials = 8", "trials = 4"));
    await until("it can be run again", async () => /^It can be run: 8 trials/.test(await verdict.textContent()));
    await save.click();
    await page.getByRole("link", { name: "Make a session soft-or-hard.protocol.toml" }).click();
    await page.locator(".verb_page").getByLabel("output").fill("S01");
    await page.locator(".verb_page").getByLabel("subject", { exact: true }).fill("S01");
    await page.getByRole("button", { name: "Run" }).click();
    await page.locator(".job_page", { hasText: "done" }).waitFor();
    expectEqual(
      JSON.parse(studio.kerfOrThrow("info", "S01.h5", "--json").stdout).subject,
      "S01",
      "whose session it is",
    );
    expectNoComplaints(page);
  },

  async "each design of the form is one that the program takes"({ browser, studio }) {
    for (const [name, stiffness] of Object.entries({ soft: 6, hard: 12, harder: 20 }))
      await writeFile(join(studio.folder, `${name}.law.toml`), await law(stiffness));
    await studio.serve();
    const page = await openPage(browser);
    await page.goto(studio.page("protocol"));
    const verdict = page.locator(".protocol .verdict");
    const design = page.getByLabel("What a trial asks");
    const names = await design.locator("option").evaluateAll((all) => all.map((it) => it.value));
    expectEqual(names.length, 11, "designs");
    await page.getByLabel("Rehearsals move from [mm]").fill("32");
    await page.getByLabel("to [mm]", { exact: true }).fill("8");
    for (const name of names) {
      await design.selectOption(name);
      for (const box of await page.locator(".protocol_laws input").all()) await box.uncheck();
      const one = ["constant", "staircase", "quest", "magnitude"].includes(name);
      for (const law of one ? ["soft"] : ["soft", "hard"])
        await page.getByLabel(`${law}.law.toml`, { exact: true }).check();
      const said = async () => {
        await page.locator(".protocol .verdict:not([aria-busy])").waitFor();
        return verdict.textContent();
      };
      const question = page.getByLabel(/^Question/);
      await question.fill("");
      if (await question.evaluate((it) => it.required)) {
        expect(/needs a 'question'/.test(await said()), `${name} has none of its own: ${await said()}`);
        await question.fill("  ");
        expect(/needs a 'question'/.test(await said()), `blanks are none: ${await said()}`);
        await question.fill("Which one was stronger?");
      }
      await until(`${name} can be run`, async () => {
        return (
          (await said()).startsWith("It can be run") && (await page.inputValue(".protocol_text")).includes(`"${name}"`)
        );
      }).catch(async (error) => {
        throw new Error(`${error.message}: ${await verdict.textContent()}`);
      });
    }
    expectNoComplaints(page);
  },

  async "without a key nothing is offered that needs one, and without a protocol what to do first"({
    browser,
    studio,
  }) {
    await studio.serve();
    const page = await openPage(browser);
    await page.goto(studio.page("sessions"));
    await page.getByText("An experiment begins with a protocol").waitFor();
    await writeFile(join(studio.folder, "abx.protocol.toml"), protocol);
    await page.reload();
    await page.getByRole("link", { name: "Rehearse abx.protocol.toml" }).waitFor();
    expectEqual(await page.getByRole("link", { name: /Make a session/ }).count(), 0, "ways to make one without a key");
    await page.getByText("start the studio with --key-file").waitFor();
    expectNoComplaints(page);
  },

  async "a whole ABX session is run from the experimenter's page"({ browser, studio, screenshots }) {
    await prepare(studio);
    const experimenter = await openPage(browser);
    await experimenter.goto(studio.page("sessions"));
    await experimenter.getByRole("button", { name: "Begin S01.h5" }).click();
    await experimenter.getByLabel("Try the laws on the device first").uncheck();
    await experimenter.getByLabel("headphones: closed, over both ears").check();
    const curtain = experimenter.getByLabel("check 1: the curtain hides the hand");
    await curtain.click();
    await curtain.click(); // it is not so
    const untouched = experimenter.getByLabel("check 2: the door is shut");
    expect(await untouched.evaluate((it) => it.indeterminate), "what nobody touched is neither yes nor no");
    await experimenter.screenshot({ path: join(screenshots, "experimenter-set-up.png"), fullPage: true });
    expectEqual(await audit(experimenter), [], "what of the set-up is not accessible");
    await experimenter.getByRole("button", { name: "Begin the session" }).click();
    const link = experimenter.getByRole("link", { name: "Open the subject's page" });
    await link.waitFor();
    await experimenter
      .locator(".sessions .files")
      .getByText(/^running/)
      .waitFor();
    await experimenter.locator(".list_kinds").getByRole("button", { name: "Sessions" }).click();
    await experimenter
      .locator(".list_row")
      .getByText(/subject S01 · running/)
      .waitFor();

    const subject = await openPage(browser);
    await subject.goto(await link.getAttribute("href"));
    await subject.screenshot({ path: join(screenshots, "subject.png") });
    await Promise.all([
      takePart(subject),
      experimenter
        .getByText("1 of 4 trials")
        .waitFor()
        .then(async () => {
          const answered = experimenter.locator(".quality div", { hasText: "Trials answered" }).locator("dd");
          await until("its trials are told", async () => Number(await answered.textContent()) >= 1);
          await experimenter.getByLabel("Note, for everybody to read").fill("the telephone rang");
          await experimenter.getByRole("button", { name: "Keep the note" }).click();
          await experimenter.locator(".notes li", { hasText: "the telephone rang" }).waitFor();
          tellsNothing(await studio.api("/api/session"));
          await experimenter.screenshot({ path: join(screenshots, "experimenter.png"), fullPage: true });
        }),
    ]);
    await experimenter.getByText("Ended: finished: 4 trials").waitFor();
    expectNoComplaints(experimenter);
    expectNoComplaints(subject);
    const analysis = JSON.parse(
      studio.kerfOrThrow("session", "analyze", "S01.h5", "--key-file", "keeper.key", "--json").stdout,
    );
    expect(JSON.stringify(analysis).includes("S01"), "the analysis knows the subject");
    const facts = JSON.parse(studio.kerfOrThrow("info", "S01.h5", "--json").stdout);
    expectEqual([facts.finished, facts.trials], [true, 4], "what the file says");
    const texts = (kind) => facts.entries.filter((it) => it.kind === kind).map((it) => it.text);
    expectEqual(texts("note"), ["the telephone rang"], "the note is in the file");
    expectEqual(
      texts("apparatus").map((it) => JSON.parse(it)),
      [{ headphones: true, "check 1": false, "check 2": null }],
      "what was confirmed, what was denied, and what nobody said",
    );
    await experimenter.getByRole("button", { name: "Read all sessions" }).click();
    const row = experimenter.locator(".folder_quality tbody");
    await row.getByText("finished").waitFor();
    expect((await row.textContent()).includes("the telephone rang"), "the note stands in the row");
    tellsNothing(await studio.api("/api/session/quality", { session: await studio.id("sessions", "S01.h5") }));
    for (const colorScheme of ["light", "dark"]) {
      await experimenter.emulateMedia({ colorScheme });
      await experimenter.evaluate(() => scrollTo(0, 0));
      await experimenter.screenshot({
        path: join(screenshots, `experimenter-quality-${colorScheme}.png`),
        fullPage: true,
      });
      expectEqual(await audit(experimenter), [], `what of the trials' table is not accessible in the ${colorScheme}`);
    }
    await experimenter.getByRole("link", { name: "S01.h5", exact: true }).click();
    const chosen = experimenter.getByRole("region", { name: "The session that was chosen" });
    await chosen.getByText("4 trials").waitFor();
    await experimenter.getByRole("button", { name: "Read its trials" }).click();
    await experimenter.locator(".form .folder_quality tbody").getByText("finished").waitFor();
    await experimenter.screenshot({ path: join(screenshots, "experimenter-chosen.png"), fullPage: true });
    expectEqual(await audit(experimenter), [], "what of a finished session is not accessible");
    await experimenter.getByRole("link", { name: "Analyse", exact: true }).click();
    await experimenter.locator(".verb_page").waitFor();
    expect(
      (await given(experimenter)).includes("S01.h5"),
      `to be analysed: ${JSON.stringify(await given(experimenter))}`,
    );
  },

  async "who has the subject's address gets at nothing else, and sees nothing of the loop"({ browser, studio }) {
    await prepare(studio);
    const id = await studio.id("sessions", "S01.h5");
    await studio.api("/api/live/zero", {});
    expectEqual(
      (await studio.api("/api/session/start", { session: id, check: false })).status,
      409,
      "while zero force is held",
    );
    await studio.api("/api/live/resume", {});
    await studio.api("/api/session/start", { session: id, check: false });
    const state = await until("the session runs", async () => {
      const { json } = await studio.api("/api/session");
      return json.running && json.subject_url ? json : null;
    });
    const subject = new URL(state.subject_url);
    const token = subject.searchParams.get("token");
    expect(token !== studio.token, "the subject has a token of their own");
    for (const path of ["/", "/api/workspace", "/api/live/status", "/api/session", "/studio.js"]) {
      const answer = await fetch(`${studio.origin}${path}?token=${token}`);
      expectEqual(answer.status, 403, path);
    }
    expectEqual((await fetch(`${studio.origin}/subject/?token=${studio.token}`)).status, 403, "the other way round");
    for (const path of ["/api/live/view?traces=0&from=0&to=1&columns=10", "/api/live/traces"])
      expectEqual((await studio.api(path)).status, 409, path);
    expectEqual(
      (await studio.api("/api/live/start", { device: "sim:scissors" })).status,
      409,
      "the loop cannot be had",
    );
    const page = await openPage(browser);
    await page.goto(studio.page("sessions"));
    await page.getByRole("button", { name: "Stop the session" }).click();
    await page.getByText("it can be continued").waitFor();
  },

  async "a subject is told that the session was stopped, and that it ended before it began"({ browser, studio }) {
    await prepare(studio);
    const session = await studio.id("sessions", "S01.h5");
    const ends = async (device, stops) => {
      const { json } = await studio.api("/api/session/start", { session, check: !stops, device });
      const subject = await openPage(browser);
      await subject.goto(json.subject_url);
      if (stops) {
        await until("it is welcome", async () => (await subject.textContent("#heading")) === "Welcome");
        await studio.api("/api/session/stop", {});
      }
      await until("it has ended", async () => (await subject.textContent("#heading")) === "Finished");
      expectEqual(await subject.textContent("#text"), "The session stops here for now. Thank you.", "what is said");
      expectEqual(await subject.textContent("#connection"), "", "what is said of the connection");
    };
    await ends("sim:scissors", true);
    await ends("sim:scissors?fault=unplug@0.1", false); // while its laws are tried on the device
  },

  async "a device that a session loses is told on every page, until another begins"({ browser, studio }) {
    await prepare(studio, "sim:scissors?fault=unplug@0.3");
    const session = await studio.id("sessions", "S01.h5");
    const page = await openPage(browser);
    await page.goto(studio.page("fits"));
    const bar = (state) => page.locator(`#force_bar[data-state="${state}"]`).waitFor();
    const begin = (device) => studio.api("/api/session/start", { session, check: false, device });
    expectEqual((await begin("")).status, 200, "the session begins");
    await bar("lost");
    expect((await page.textContent("#force_bar p")).includes("the device was lost"), "why");
    expectEqual((await begin("sim:scissors")).status, 200, "it is gone on with");
    await bar("session");
  },
};
