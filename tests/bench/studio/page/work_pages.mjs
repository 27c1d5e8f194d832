// Verbs of the program as jobs: forms, results, and what ends a job or a studio in the middle.

import { existsSync, readFileSync, readdirSync } from "node:fs";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";

import { audit } from "./accessibility.mjs";
import { expect, expectEqual, expectNoComplaints, openPage, until } from "./harness.mjs";

const jobs = async (studio) => (await studio.api("/api/jobs")).json;

async function openWork(browser, studio, place, options = {}) {
  const page = await openPage(browser, options);
  await page.goto(studio.page(`work/${place}`));
  return page;
}

const form = (page) => page.locator(".verb_page form");

/** Presses Run, and waits for the job's end. */
async function run(page, studio) {
  const before = (await jobs(studio)).length;
  await page.getByRole("button", { name: "Run", exact: true }).click();
  await until("it is a job", async () => (await jobs(studio)).length > before, 60000);
  return until(
    "the job has ended",
    async () => {
      const [job] = await jobs(studio);
      return job.state !== "waiting" && job.state !== "running" ? job : null;
    },
    120000,
  );
}

/** The process that the studio has started for a job. */
function processOf(studio) {
  const below = (id) => {
    try {
      return readFileSync(`/proc/${id}/task/${id}/children`, "utf8");
    } catch {
      return "";
    }
  };
  const tasks = readdirSync(`/proc/${studio.process.pid}/task`);
  for (const task of tasks) {
    const children = readFileSync(`/proc/${studio.process.pid}/task/${task}/children`, "utf8").trim();
    if (children) return Number(children.split(" ")[0]);
  }
  return below(studio.process.pid) ? Number(below(studio.process.pid).split(" ")[0]) : null;
}

/** A verb that takes its time, asked for past the page. */
async function takeTime(studio) {
  const values = { "--device": "sim:scissors", "--cells": 400, "--seconds": 5, "--output": "slow" };
  const asked = await studio.api("/api/verbs/run", { verb: "stability", values });
  expectEqual(asked.status, 200, JSON.stringify(asked.json));
  await until("it runs", async () => (await jobs(studio))[0].state === "running");
  return until("its process is there", () => processOf(studio));
}

export const tests = {
  async "a verb has the form that its help describes, without what a page may not ask for"({ studio }) {
    await studio.serve();
    const forms = (await studio.api("/api/verbs")).json;
    const named = (verb) => forms.find((it) => it.verb === verb);
    for (const verb of ["prepare", "report", "check", "regress", "replay", "identify", "devices", "session simulate"])
      expect(named(verb), `a form of ${verb}`);
    expect(!named("session new"), "no session without a key");
    for (const form of forms) {
      const help = studio.kerfOrThrow("help", form.verb.split(" ")).stdout;
      for (const value of form.values) {
        expect(help.includes(value.name), `${form.verb} ${value.name} is in its help`);
        expect(!["--force", "--plugin", "--map", "--yes", "--sensor", "--json"].includes(value.name), value.name);
        if (value.kind === "file")
          expect(value.words.length > 0 && !value.words.includes(".so"), `${form.verb} ${value.name}`);
      }
    }
    const filter = named("prepare").values.find((it) => it.name === "--sigmas");
    expectEqual([filter.kind, filter.standard !== ""], ["number", true], "a number with what it is by itself");
    expectEqual(named("check").fixed, ["--virtual"], "a check beside a loop");
    expectEqual(named("regress").values[0].name, "SUITE", "regress runs, and updates nothing");
  },

  async "a recording is prepared by a form, and the result opened"({ browser, studio, screenshots }) {
    studio.record("cut.h5", 10);
    await studio.serve();
    const page = await openWork(browser, studio, "prepare?recording=cut.h5");
    await page.getByRole("heading", { name: "Prepare a recording" }).waitFor();
    expectEqual(await form(page).getByLabel("recording").inputValue(), "cut.h5", "what the address names");
    expectEqual(await form(page).getByLabel("output").inputValue(), "cut-prepare", "a name that is free");
    await form(page).getByLabel("output").fill("clean");
    await page.getByText("more options").click();
    await page.getByRole("textbox", { name: "filter", exact: true }).fill("butterworth2:20");
    await page.screenshot({ path: join(screenshots, "work_form.png") });
    const job = await run(page, studio);
    expectEqual([job.state, job.error], ["done", ""], "the job");
    await page.getByRole("heading", { name: `Job ${job.job}` }).waitFor();
    await page.locator(".job_log").filter({ hasText: "clean.h5:" }).waitFor();
    const history = JSON.parse(studio.kerfOrThrow("info", "clean.h5", "--json").stdout);
    expect(JSON.stringify(history).includes("butterworth2"), "the filter is in its history");
    await page.screenshot({ path: join(screenshots, "work_job.png") });
    await page.locator(".made").getByRole("link", { name: "clean.h5" }).click();
    await until("its page is there", async () => (await page.title()).length > 0 && page.url().includes("recording"));
    expectNoComplaints(page);
  },

  async "a recording's own page writes its report, with what was found of it"({ browser, studio, screenshots }) {
    studio.record("cut.h5", 10);
    studio.kerfOrThrow("fit", "cut.h5", "--models", "kelvin", "-o", "cut.fit");
    await studio.serve();
    const page = await openPage(browser);
    await page.goto(studio.page(`recording/${await studio.id("recordings", "cut.h5")}/report`));
    await page.getByRole("heading", { name: "Write a report" }).waitFor();
    await form(page).waitFor();
    expectEqual(await form(page).getByLabel("recording").inputValue(), "cut.h5", "the recording");
    expect(await form(page).getByLabel("cut.fit/fit.json").isChecked(), "its fit is ticked");
    await page.screenshot({ path: join(screenshots, "report_tab.png") });
    const job = await run(page, studio);
    expectEqual([job.state, job.error], ["done", ""], "the job");
    expect(readFileSync(join(studio.folder, "cut-report.html"), "utf8").includes("kelvin"), "it has the law");
    expectNoComplaints(page);
  },

  async "what is wrong is said at its field, and before there is a job"({ browser, studio }) {
    studio.record("cut.h5", 10);
    await writeFile(join(studio.folder, "taken.h5"), "");
    await studio.serve();
    const page = await openWork(browser, studio, "prepare?recording=cut.h5");
    await form(page).getByLabel("output").fill("taken");
    await page.getByRole("button", { name: "Run", exact: true }).click();
    await page.getByRole("alert").filter({ hasText: "output: taken.h5 is there already" }).waitFor();
    expect(
      await form(page)
        .getByLabel("output")
        .evaluate((it) => it === document.activeElement),
      "the field has the focus",
    );
    await form(page).getByLabel("output").fill("clean");
    await page.getByText("more options").click();
    await page.getByRole("textbox", { name: "sigmas", exact: true }).fill("-3");
    await page.getByRole("button", { name: "Run", exact: true }).click();
    await page.getByRole("alert").filter({ hasText: "not greater than 0" }).waitFor();
    expectEqual(await jobs(studio), [], "the jobs");
    expectEqual(
      (await studio.api("/api/verbs/run", { verb: "prepare", values: { "--plugin": "x.so" } })).status,
      400,
      "code",
    );
    expectEqual((await studio.api("/api/verbs/run", { verb: "record", values: {} })).status, 400, "another verb");
  },

  async "a report, a comparison of forces and a list of devices open in the page"({ browser, studio, screenshots }) {
    studio.record("cut.h5", 10);
    studio.kerfOrThrow("fit", "cut.h5", "--models", "kelvin,exponential", "--no-folds", "-o", "fits");
    const law = await readFile(join(studio.folder, "fits/kelvin.law.toml"), "utf8");
    await writeFile(join(studio.folder, "other.law.toml"), law.replace(/(parallel_stiffness\s*=\s*)(\S+)/, "$11.0"));
    for (const [name, file] of [
      ["one", "fits/kelvin.law.toml"],
      ["two", "fits/exponential.law.toml"],
    ])
      studio.kerfOrThrow("check", file, "--virtual", "--seconds", "2", "--floor", "0", "--record", `${name}.h5`);
    await studio.serve();
    const page = await openWork(browser, studio, "report?recording=cut.h5");
    await form(page).getByLabel("output").fill("cut-report");
    expectEqual((await run(page, studio)).state, "done", "the report");
    const link = page.locator(".made").getByRole("link", { name: "cut-report.html" });
    const [report] = await Promise.all([page.context().waitForEvent("page"), link.click()]);
    await report.waitForLoadState();
    expect((await report.textContent("body")).includes("cut.h5"), "the report is about the recording");
    await page.goto(studio.page("work/compare"));
    await form(page).getByLabel("expected").selectOption("one.h5");
    await form(page).getByLabel("got").selectOption("two.h5");
    await form(page).getByLabel("output").fill("differences");
    const compared = await run(page, studio);
    expectEqual([compared.state, compared.outcome], ["done", "did not pass"], "two laws");
    await page.locator(".job_result img").first().waitFor();
    await until("a picture is drawn", () =>
      page
        .locator(".job_result img")
        .first()
        .evaluate((it) => it.naturalWidth > 0),
    );
    await page.screenshot({ path: join(screenshots, "work_compare.png") });
    await page.goto(studio.page("work/devices"));
    expectEqual((await run(page, studio)).state, "done", "the devices");
    await page.locator(".job_log").filter({ hasText: "sim:scissors" }).waitFor();
    expectNoComplaints(page);
  },

  async "a job is stopped, and one whose process is killed says so"({ browser, studio }) {
    await studio.serve();
    await takeTime(studio);
    const page = await openWork(browser, studio, (await jobs(studio))[0].job);
    await page.getByRole("button", { name: "Stop", exact: true }).click();
    await page.getByRole("status").filter({ hasText: "stopped" }).waitFor();
    process.kill(await takeTime(studio), "SIGKILL");
    await page.goto(studio.page(`work/${(await jobs(studio))[0].job}`));
    await page.getByRole("status").filter({ hasText: "ended from outside, by signal 9" }).waitFor();
    expect(!existsSync(join(studio.folder, "slow")), "nothing half-made has its name");
    await page.getByRole("button", { name: "Run again" }).click();
    await until("it is asked for again", async () => (await jobs(studio)).length === 3);
    await until("its page is there", () => page.url().endsWith("/3"));
  },

  async "jobs outlive page and studio"({ browser, studio, screenshots }) {
    studio.record("cut.h5", 10);
    await studio.serve();
    const page = await openWork(browser, studio, "info?recording=cut.h5");
    await page.getByRole("heading", { name: "What is in a recording" }).waitFor();
    await form(page).getByLabel("recording").selectOption("cut.h5");
    const first = await run(page, studio);
    expectEqual(first.state, "done", first.error);
    const slow = await takeTime(studio);
    await studio.stop("SIGKILL");
    await until(
      "the job ends with the studio",
      () => !existsSync(`/proc/${slow}`) || /\) Z/.test(readFileSync(`/proc/${slow}/stat`, "utf8")),
    );
    await studio.serve();
    const [interrupted, done] = await jobs(studio);
    expectEqual(
      [interrupted.state, done.state, done.job],
      ["interrupted", "done", first.job],
      "as the next studio has them",
    );
    const again = await openWork(browser, studio, interrupted.job);
    await again.getByRole("status").filter({ hasText: "interrupted" }).waitFor();
    await again.screenshot({ path: join(screenshots, "work_interrupted.png") });
    await again.locator(".job_list").getByRole("link", { name: done.title }).click();
    await again.locator(".job_log").filter({ hasText: "sim:scissors" }).waitFor();
    await again.goto(studio.page(`work/${interrupted.job}`));
    await again.getByRole("button", { name: "Run again" }).click();
    await until("it runs again", async () => (await jobs(studio))[0].state === "running");
    await again.getByRole("button", { name: "Stop", exact: true }).click();
    await until("it is stopped", async () => (await jobs(studio))[0].state === "stopped");
    await again.getByRole("button", { name: "Forget" }).click();
    await until("it is forgotten", async () => (await jobs(studio)).length === 2);
  },

  async "a file is renamed, noted on, deleted and had back"({ browser, studio, screenshots }) {
    studio.record("cut.h5", 10);
    await studio.serve();
    const page = await openWork(browser, studio, "files");
    await page.getByRole("button", { name: "Rename cut.h5" }).click();
    await page.getByLabel("New name").fill("first");
    await page.getByRole("button", { name: "Rename", exact: true }).click();
    await page.getByRole("button", { name: "Note on first.h5" }).click();
    await page.getByLabel("Note", { exact: true }).fill("the blade is new");
    await page.getByLabel("At [s]").fill("2.5");
    await page.getByRole("button", { name: "Keep" }).click();
    await page.getByText("The note stands in first.h5.").waitFor();
    expectEqual(studio.kerf("validate", "first.h5").status, 0, "kerf validate first.h5");
    expect(studio.kerfOrThrow("info", "first.h5", "--json").stdout.includes("the blade is new"), "the note is in it");
    await page.getByRole("button", { name: "Delete first.h5" }).click();
    await page.getByText("first.h5 is in the trash.").waitFor();
    expect(!existsSync(join(studio.folder, "first.h5")), "it is gone");
    await page.screenshot({ path: join(screenshots, "work_files.png") });
    await page.getByRole("button", { name: "Undo" }).click();
    await page.getByRole("button", { name: "Delete first.h5" }).waitFor();
    expect(existsSync(join(studio.folder, "first.h5")), "it is back");
    expectNoComplaints(page);
  },

  async "a session is made and rehearsed, and nothing of it is unblinded"({ browser, studio }) {
    studio.kerfOrThrow("session", "key", "keeper.key");
    const protocol = new URL("../../../../examples/sessions/abx.protocol.toml", import.meta.url);
    const text = await readFile(protocol, "utf8");
    await writeFile(join(studio.folder, "abx.protocol.toml"), text.replaceAll("../", ""));
    for (const [, name] of text.matchAll(/"\.\.\/([^"]+)"/g))
      await writeFile(join(studio.folder, name), await readFile(new URL(`../${name}`, protocol)));
    await studio.serve("--key-file", join(studio.folder, "keeper.key"));
    const page = await openWork(browser, studio, "session-new");
    const fill = async () => {
      await form(page).getByLabel("protocol").selectOption("abx.protocol.toml");
      await form(page).getByLabel("output").fill("S01");
    };
    await fill();
    expectEqual((await run(page, studio)).state, "failed", "a session of nobody");
    await page.getByText("failed: give the subject's code with “subject”, or how many subjects").first().waitFor();
    await page.goto(studio.page("work/session-new"));
    await fill();
    await page.getByText("more options").click();
    await page.getByRole("textbox", { name: "subject", exact: true }).fill("S01");
    await page.getByLabel("no check").check();
    const made = await run(page, studio);
    expectEqual([made.state, made.error], ["done", ""], "the session");
    expect(!made.title.includes("key"), "the key is not in the list");
    const analysed = await studio.api("/api/verbs/run", {
      verb: "session analyze",
      values: { FILES: ["S01.h5"], "--output": "early" },
    });
    const job = await until("it has ended", async () => {
      const it = (await jobs(studio)).find((each) => each.job === analysed.json.job);
      return it.state === "running" || it.state === "waiting" ? null : it;
    });
    expectEqual(job.state, "failed", "an analysis before the end");
    expect(!existsSync(join(studio.folder, "early")), "nothing is opened");
  },

  async "the page of jobs is fit to be seen, in light and dark"({ browser, studio, screenshots }) {
    studio.record("cut.h5", 10);
    await studio.serve();
    await studio.api("/api/verbs/run", { verb: "info", values: { recording: "cut.h5" } });
    await until("it is done", async () => (await jobs(studio))[0].state === "done");
    const complaints = [];
    for (const colorScheme of ["light", "dark"]) {
      for (const [name, place] of Object.entries({
        work: "",
        work_form: "prepare?recording=cut.h5",
        work_job: "1",
        work_files: "files",
      })) {
        const page = await openWork(browser, studio, place, { colorScheme, reducedMotion: "reduce" });
        await page.waitForTimeout(800);
        await page.screenshot({ path: join(screenshots, `${name}-${colorScheme}.png`) });
        for (const it of await audit(page, { focus: colorScheme === "light" }))
          complaints.push(`${name} ${colorScheme}: ${it}`);
        expectNoComplaints(page);
        await page.context().close();
      }
    }
    expectEqual(complaints, [], "what is not accessible");
  },
};
