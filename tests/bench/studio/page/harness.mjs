// Drives `kerf studio` by a browser: Debian's Chromium through playwright-core. Run by CTest as
//     node run.mjs SUITE KERF NODE_MODULES SCREENSHOTS
// and skipped (77) where there is no Chromium.

import { spawn, spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

export const chromium = "/usr/bin/chromium";

export function isThere() {
  return existsSync(chromium);
}

export function expect(condition, what) {
  if (!condition) throw new Error(`not so: ${what}`);
}

export function expectEqual(found, expected, what) {
  if (JSON.stringify(found) !== JSON.stringify(expected))
    throw new Error(`${what}: found ${JSON.stringify(found)}, expected ${JSON.stringify(expected)}`);
}

/** Waits until something is so, up to 20 s: never for a time alone. */
export async function until(what, condition, limit_ms = 20000) {
  const end = Date.now() + limit_ms;
  for (;;) {
    const found = await condition();
    if (found) return found;
    if (Date.now() > end) throw new Error(`waited in vain until ${what}`);
    await new Promise((go) => setTimeout(go, 50));
  }
}

/** The program, in a folder of its own. */
export class Studio {
  constructor(program, folder) {
    this.program = program;
    this.folder = folder;
  }

  static async make(program) {
    return new Studio(program, await mkdtemp(join(tmpdir(), "kerf-studio-")));
  }

  /** Runs another verb in the folder, to its end. */
  kerf(...words) {
    const run = spawnSync(this.program, words.flat(), { cwd: this.folder, encoding: "utf8" });
    return { status: run.status, stdout: run.stdout, stderr: run.stderr };
  }

  kerfOrThrow(...words) {
    const run = this.kerf(...words);
    if (run.status !== 0) throw new Error(`kerf ${words.flat().join(" ")}: ${run.status} ${run.stderr}`);
    return run;
  }

  /** A simulated recording of opening and closing with its cycles. */
  record(name = "cut.h5", seconds = 20) {
    this.kerfOrThrow("record", "--device", "sim:scissors", "--seconds", String(seconds), "--virtual", "-o", name);
    this.kerfOrThrow("segment", name);
  }

  /** A session S01.h5 of a protocol, not yet run. */
  makeSession(protocol) {
    const given = ["--subject", "S01", "--key-file", "keeper.key", "-o", "S01.h5", "--no-check"];
    this.kerfOrThrow("session", "new", protocol, ...given);
  }

  async serve(...words) {
    this.process = spawn(this.program, ["studio", this.folder, ...words], { stdio: ["ignore", "ignore", "pipe"] });
    this.said = "";
    this.process.stderr.on("data", (text) => (this.said += text));
    this.ended = new Promise((go) => this.process.on("exit", (status, signal) => go({ status, signal })));
    this.url = await until("the studio says its address", () => /http:\/\/\S+/.exec(this.said)?.[0]);
    const address = new URL(this.url);
    this.origin = address.origin;
    this.token = address.searchParams.get("token");
    return this;
  }

  page(place) {
    return `${this.url}#/${place}`;
  }

  /** A request of the API past the page. */
  async api(path, body) {
    const options = body === undefined ? {} : { method: "POST", body: JSON.stringify(body) };
    const answer = await fetch(this.origin + path, {
      ...options,
      headers: { "X-Kerf-Token": this.token, "Content-Type": "application/json" },
    });
    return { status: answer.status, json: await answer.json().catch(() => null) };
  }

  async id(kind, name) {
    const workspace = (await this.api("/api/workspace")).json;
    return workspace[kind].find((it) => it.name === name)?.id;
  }

  async stop(signal = "SIGTERM") {
    if (!this.process) return null;
    this.process.kill(signal);
    const end = await this.ended;
    this.process = null;
    return end;
  }

  async remove() {
    await this.stop("SIGKILL");
    await rm(this.folder, { recursive: true, force: true });
  }
}

/** A browser whose pages report what they complain about. */
export async function openBrowser(modules) {
  const { chromium: engine } = await import(pathToFileURL(join(modules, "playwright-core", "index.mjs")));
  return engine.launch({
    executablePath: chromium,
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      "--disable-dev-shm-usage",
      "--no-proxy-server",
      "--enable-precise-memory-info",
      "--js-flags=--expose-gc",
    ],
  });
}

export async function openPage(browser, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, ...options });
  const page = await context.newPage();
  page.complaints = [];
  page.on("pageerror", (error) => page.complaints.push(String(error)));
  page.on("console", (line) => {
    if (line.type() === "error") page.complaints.push(line.text());
  });
  return page;
}

export function expectNoComplaints(page, except = []) {
  const left = page.complaints.filter((it) => !except.some((pattern) => pattern.test(it)));
  expectEqual(left, [], "what the browser complains about");
}
