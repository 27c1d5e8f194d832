// What the program answers is what the page's types say: every route is asked, its answer is written down as a literal of its
// type, and the compiler judges. A key too many, one that is missing, another kind of value: all are found.

import { mkdtemp, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

import { expect, expectEqual, until } from "./harness.mjs";
import { furnish } from "./looks_pages.mjs";

const root = new URL("../../../../", import.meta.url).pathname;
const api = join(root, "bench/studio/page/src/api");

/** Answers that are what the program's verbs write, whose formats grow: the page's types name what it uses of them. */
const loose = "Loose";

/** [route, type, parameters or body]; without a type: no JSON of the page, and why. */
function routesOf(it) {
  const { recording, fit, chart, choice, stability, device, study, law, sweep } = it;
  const ofWalls = { table: "walls", by: ["mass", "delay"], of: "comes_to_rest", where: {} };
  const knots = { penetration: [0, 0.1, 0.3], closing: [0, 1, 2], opening: [0, 0.5, 2] };
  return [
    ["GET /api/workspace", "Workspace", {}],
    ["GET /api/workspace", "{ unchanged: true }", { unless: it.state }],
    ["GET /api/recording", "Recording", { id: recording }],
    ["GET /api/recording", "Recording", { id: it.punch }],
    ["GET /api/recording/inspection", `${loose}<RecordingInspection>`, { id: recording }],
    ["GET /api/recording/inspection", `${loose}<RecordingInspection>`, { id: it.punch }],
    ["GET /api/recording/loops", "Loops", { id: recording, axis: 0, first: 1, count: 2 }],
    ["GET /api/recording/thumbnail", "Thumbnail", { id: recording }],
    ["GET /api/recording/thumbnail", "Thumbnail", { id: it.punch }],
    ["GET /api/recording/view", null, "columns in binary"],
    ["GET /api/editor/curve", "EditorCurve", { id: recording, axis: 0 }],
    ["GET /api/editor/law", "LawKnots", { id: it.piecewise }],
    ["POST /api/editor/error", "LawError", { recording, axis: 0, knots }],
    ["POST /api/editor/best", "KnotsWithError", { recording, axis: 0, segments: 2, loop: true }],
    ["POST /api/editor/forces", "KnotsWithError", { recording, axis: 0, knots }],
    ["POST /api/editor/save", "SavedLaw", { recording, axis: 0, knots, name: "typed" }],
    ["GET /api/cycles", "CycleView", { id: recording }],
    ["POST /api/cycles/look", "CycleView", { recording, axis: 0, settings: { prominence: 0.3 }, loop: 1 }],
    ["GET /api/cycles/row", "{ row: number; time_s: number }", { id: recording, time: 0.5 }],
    ["GET /api/cycles/fit", "FitOfCycles", { id: recording, fit }],
    ["POST /api/cycles/save", null, "as GET /api/cycles"],
    ["GET /api/import", "IntakeOverview", {}],
    ["POST /api/import/begin", "{ upload: string; have: number }", { name: "typed.csv", bytes: 10, modified: 1 }],
    ["POST /api/import/mapping", "{ id: string; name: string }", { name: "typed", map: "time=1[s],position=2[mm]" }],
    ["POST /api/import/forget", "Record<string, never>", { upload: "0123456789abcdef" }],
    ["POST /api/import/piece", null, "bytes are posted"],
    ["POST /api/import/preview", null, "of a file that has come; import_pages.mjs asks"],
    ["POST /api/import/start", null, "an order as that of a fit"],
    ["GET /api/import/mapping", null, "of a file that was saved; import_pages.mjs asks"],
    ["GET /api/import/result", null, "of a file that was imported; import_pages.mjs asks"],
    ["GET /api/jobs", "Job[]", {}],
    ["POST /api/key", "{ key: string }", { path: "/api/jobs/file", query: { job: "1", file: "0" } }],
    ["GET /api/laws/fitted", "FittedLaw[]", {}],
    ["GET /api/laws/hosts", "{ name: string; what: string }[]", {}],
    ["GET /api/law/exported", null, "a file"],
    ["GET /api/law", "LawView", { id: law }],
    ["GET /api/residuals", "Residuals", { id: recording, axis: "theta", law, columns: 50 }],
    ["GET /api/result", `${loose}<FitFile>`, { id: fit }],
    ["GET /api/result", `${loose}<ChartFile>`, { id: chart }],
    ["GET /api/result", `${loose}<ChoiceFile>`, { id: choice }],
    ["GET /api/result", `${loose}<StabilityFile>`, { id: stability }],
    ["GET /api/result", `${loose}<DeviceFile>`, { id: device }],
    ["GET /api/studies", "StudyEntry[]", {}],
    ["GET /api/study", `${loose}<Study>`, { id: study }],
    ["GET /api/study/drawn", `${loose}<Figure>`, { id: study, name: "skin_s5" }],
    ["GET /api/study/report", null, "a document"],
    ["GET /api/study/table", null, "a table"],
    ["GET /api/sweep", "Sweep", { id: sweep }],
    ["POST /api/sweep/answer", "SweepAnswer", { id: sweep, ...ofWalls }],
    ["POST /api/sweep/sample", "SweepSample", { id: sweep, ...ofWalls, columns: ["mass"], most: 9 }],
    ["GET /api/protocol", "ProtocolText", { id: it.protocol }],
    ["POST /api/protocol/check", "ProtocolCheck", { text: it.protocolText }],
    ["POST /api/protocol/check", "ProtocolCheck", { text: "name = 1" }],
    ["POST /api/protocol", "{ id: string; name: string }", { name: "typed", text: it.protocolText }],
    ["GET /api/session", "SessionState", {}],
    ["POST /api/session/quality", "SessionLook", { session: it.session }],
    ["GET /api/live/status", "LoopStatus", {}],
    ["POST /api/live/start", "LoopStatus", { device: "sim:scissors" }],
    ["GET /api/live/traces", "Trace[]", {}],
    ["GET /api/live/view", null, "columns in binary"],
    ["GET /api/live/stream", null, "events, whose frames are made as the status is"],
    ["POST /api/live/mark", "LoopStatus", { text: "typed" }],
    ["POST /api/live/record", "LoopStatus", { name: "typed" }],
    ["POST /api/live/record/stop", "LoopStatus", {}],
    ["POST /api/live/feel", "LoopStatus", { law }],
    ["POST /api/editor/feel", "Record<string, never>", { recording, axis: 0, knots }],
    ["POST /api/live/zero", "{ released: true }", {}],
    ["POST /api/live/resume", "LoopStatus", {}],
    ["POST /api/live/confirm", "LoopStatus", {}],
    ["POST /api/live/stop", "LoopStatus", {}],
    ["POST /api/live/dismiss", "LoopStatus", {}],
    ["POST /api/fit", "{ job: number }", { recording, axis: "theta", models: ["kelvin"], folds: 0 }],
    ["POST /api/chart", null, "an order as that of a fit"],
    ["POST /api/choose", null, "an order as that of a fit"],
    ["POST /api/stability", null, "an order as that of a fit"],
    ["POST /api/jobs/stop", "Record<string, never>", { job: 1 }],
    ["POST /api/jobs/forget", null, "answers as a stop does"],
    ["GET /api/jobs/log", "{ text: string }", { job: 1 }],
    ["GET /api/jobs/result", "{ files: MadeFile[] }", { job: 1 }],
    ["GET /api/jobs/file", null, "a file that a job has made"],
    ["GET /api/verbs", "VerbForm[]", {}],
    ["GET /api/verbs/files", "OfferedNames", {}],
    ["POST /api/verbs/run", "{ job: number }", { verb: "info", values: { recording: "cut.h5" } }],
    ["GET /api/trash", "Trashed[]", {}],
    ["POST /api/files/delete", "{ key: string }", { id: law, kind: "law" }],
    ["POST /api/files/rename", null, "nothing that the page reads"],
    ["POST /api/files/annotate", null, "nothing that the page reads"],
    ["POST /api/trash/restore", null, "nothing that the page reads"],
    ["POST /api/trash/empty", null, "nothing that the page reads"],
    ["POST /api/session/start", null, "answers as GET /api/session"],
    ["POST /api/session/note", null, "nothing that the page reads"],
    ["POST /api/session/stop", null, "nothing that the page reads"],
  ];
}

const ahead = `
type Loose<T> = T extends readonly (infer U)[] ? readonly Loose<U>[]
  : T extends object ? { [K in keyof T]: Loose<T[K]> } & Record<string, unknown> : T;
type KnotsWithError = { knots: Knots; error: LawError };
type SavedLaw = { id: string; name: string; error: LawError };
type LawKnots = Knots & { contact_position: number; closing_direction: number; position_unit: string; force_unit: string };
`;

/** Every type that the page's modules of the API export. */
async function imports() {
  const lines = [];
  for (const [folder, name] of [
    ...(await readdir(api)).map((it) => [api, it]),
    [join(api, "../ui"), "figure_description.ts"],
  ]) {
    const text = await readFile(join(folder, name), "utf8");
    const types = [...text.matchAll(/^export (?:interface|type) (\w+)/gm)].map((it) => it[1]);
    const from = join(folder, name.replace(/\.ts$/, ""));
    if (types.length > 0) lines.push(`import type { ${types.join(", ")} } from ${JSON.stringify(from)};`);
  }
  return lines.join("\n");
}

/** What the compiler says of a module, a line each. */
function judge(ts, file) {
  const { options } = ts.convertCompilerOptionsFromJson(
    {
      target: "ES2021",
      module: "ESNext",
      moduleResolution: "Bundler",
      lib: ["ES2021", "DOM"],
      types: [],
      strict: true,
      exactOptionalPropertyTypes: true,
      skipLibCheck: true,
      noEmit: true,
    },
    root,
  );
  const program = ts.createProgram([file], options);
  return ts.getPreEmitDiagnostics(program).map((it) => ts.flattenDiagnosticMessageText(it.messageText, " "));
}

async function routesInTheSources() {
  const found = new Set();
  const folder = join(root, "bench/studio");
  for (const name of await readdir(folder, { recursive: true })) {
    if (!name.endsWith(".cpp")) continue;
    const text = await readFile(join(folder, name), "utf8");
    for (const [, path] of text.matchAll(/"(\/api\/[a-z/_]+)"/g)) found.add(path);
  }
  return [...found].sort();
}

async function ask(studio, route, given) {
  const [method, path] = route.split(" ");
  const query = new URLSearchParams(given).toString();
  const answer = await (method === "GET" ? studio.api(`${path}${query ? `?${query}` : ""}`) : studio.api(path, given));
  expectEqual(answer.status, 200, `${route}: ${JSON.stringify(answer.json)?.slice(0, 200)}`);
  return answer.json;
}

/** The folder of the pictures, with a choice, a session that the key opens, and a loop. */
async function prepare(studio) {
  const ids = await furnish(studio);
  const { job } = (await studio.api("/api/choose", { recording: ids.recording, axis: "theta" })).json;
  const choice = await until(
    "a law is chosen",
    async () => (await studio.api("/api/jobs")).json.find((it) => it.job === job && it.state === "done")?.file,
    120000,
  );
  const sample = (name) => `[[sample]]\nname = "${name}"\nlaw = "cut.fit/${name}.law.toml"\n`;
  const protocolText = `name = "typed"\ndesign = "abx"\ntrials = 4\n${sample("kelvin")}${sample("piecewise")}`;
  await writeFile(join(studio.folder, "typed-before.protocol.toml"), protocolText);
  const { state } = (await studio.api("/api/workspace")).json;
  return {
    ...ids,
    choice,
    state,
    law: await studio.id("laws", "cut.fit/kelvin.law.toml"),
    piecewise: await studio.id("laws", "cut.fit/piecewise.law.toml"),
    session: await studio.id("sessions", "S01.h5"),
    protocol: await studio.id("files", "typed-before.protocol.toml"),
    protocolText,
  };
}

export const tests = {
  async "every route has its type, and answers as it says"({ studio }) {
    const ts = createRequire(join(resolve(process.argv[4]), "x.js"))("typescript");
    const routes = routesOf(await prepare(studio));
    expectEqual(
      [...new Set(routes.map(([route]) => route.split(" ")[1]))].sort(),
      await routesInTheSources(),
      "routes that this test knows, and those of the program",
    );
    const folder = await mkdtemp(join(tmpdir(), "kerf-types-"));
    try {
      const head = (await imports()) + ahead;
      const complaints = [];
      for (const [k, [route, type, given]] of routes.entries()) {
        if (type === null) continue;
        const literal = JSON.stringify(await ask(studio, route, given));
        const file = join(folder, `answer_${k}.ts`);
        await writeFile(file, `${head}\nexport const answer: ${type} = ${literal};\n`);
        complaints.push(...judge(ts, file).map((it) => `${route} as ${type}: ${it}`));
      }
      expectEqual(complaints, [], "what is not as its type says");
      // And the compiler sees what is not so.
      const wrong = join(folder, "wrong.ts");
      await writeFile(wrong, `${head}\nexport const answer: Thumbnail = { signal: 1, low: [], high: [], more: 0 };\n`);
      expect(judge(ts, wrong).length > 0, "a wrong answer is found");
    } finally {
      await rm(folder, { recursive: true, force: true });
    }
  },
};
