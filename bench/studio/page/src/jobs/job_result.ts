import type { Api } from "../api/api";
import type { MadeFile } from "../api/jobs";
import { bytes } from "../recordings/recording_list";
import { element } from "../ui/dom";

const shownRows = 200;
const shownText = 20000;
const pagesOf: Readonly<Record<string, string>> = {
  recording: "recording",
  fit: "fits",
  chart: "chart",
  choice: "chart",
  stability: "stability",
  study: "studies",
  device: "devices",
};

/** What a job has made: pictures, pages, tables and texts, each where it can be looked at. */
export function jobResult(api: Api, job: number, files: readonly MadeFile[], signal: AbortSignal): HTMLElement {
  const root = element("div", { class: "job_result" });
  const numbered = files.map((file, number) => ({ file, number }));
  const lead = (number: number, ...nodes: (HTMLAnchorElement | HTMLImageElement)[]): void =>
    leadTo(api, job, number, nodes, signal);
  for (const { file, number } of numbered.filter((it) => it.file.what === "picture")) {
    const image = element("img", { alt: file.name, loading: "lazy" });
    const save = element("a", { download: last(file.name) }, file.name);
    lead(number, image, save);
    root.append(element("figure", {}, image, element("figcaption", {}, save)));
  }
  for (const { file, number } of numbered.filter((it) => it.file.what === "table" || it.file.what === "text"))
    root.append(folded(api, job, number, file, signal));
  const list = numbered.map(({ file, number }) =>
    element("li", {}, ...lineOf(file, (...links) => lead(number, ...links))),
  );
  if (list.length > 0) root.append(element("h3", {}, "Files"), element("ul", { class: "made" }, ...list));
  return root;
}

/** Gives links and pictures their address, once the studio has made it. */
function leadTo(
  api: Api,
  job: number,
  file: number,
  nodes: readonly (HTMLAnchorElement | HTMLImageElement)[],
  signal: AbortSignal,
): void {
  api.opening("/api/jobs/file", { job, file }).then(
    (address) => {
      if (signal.aborted) return;
      for (const it of nodes) it.setAttribute(it instanceof HTMLAnchorElement ? "href" : "src", address);
    },
    () => {}, // the bar says that the studio does not answer
  );
}

function last(name: string): string {
  return name.replace(/.*\//, "");
}

function lineOf(file: MadeFile, lead: (...links: HTMLAnchorElement[]) => void): (Node | string)[] {
  const page = pagesOf[file.kind];
  const parts: (Node | string)[] = [];
  if (page && file.id) parts.push(element("a", { href: `#/${page}/${file.id}` }, file.name));
  else if (file.what === "page") {
    const open = element("a", { target: "_blank", rel: "noopener" }, file.name);
    lead(open);
    parts.push(open);
  } else parts.push(file.name);
  const save = element("a", { download: last(file.name) }, "Save");
  lead(save);
  parts.push(` (${bytes(file.bytes)}) `, save);
  return parts;
}

/** A table or a text that is read when it is unfolded. */
function folded(api: Api, job: number, number: number, file: MadeFile, signal: AbortSignal): HTMLElement {
  const box = element("div", { class: "table_frame", tabindex: 0, role: "region", "aria-label": file.name });
  const details = element("details", {}, element("summary", {}, file.name), box);
  let read = false;
  details.addEventListener("toggle", () => {
    if (!details.open || read) return;
    read = true;
    readText(api, job, number, signal).then(
      (text) => box.replaceChildren(file.what === "table" ? tableOf(text) : textOf(text)),
      (error: unknown) => {
        read = false;
        box.textContent = error instanceof Error ? error.message : String(error);
      },
    );
  });
  return details;
}

async function readText(api: Api, job: number, number: number, signal: AbortSignal): Promise<string> {
  const answer = await fetch(`/api/jobs/file?job=${job}&file=${number}`, {
    headers: { "X-Kerf-Token": api.token },
    signal,
  });
  if (!answer.ok) throw new Error(`The file cannot be read: ${answer.status}`);
  return answer.text();
}

function textOf(text: string): HTMLElement {
  return element("pre", {}, text.length > shownText ? `${text.slice(0, shownText)}\n… the file has the rest` : text);
}

/** Cells of one line of CSV; a quoted one may hold commas, and quotes twice. */
export function cellsOf(line: string): string[] {
  const cells: string[] = [];
  for (const match of line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g))
    cells.push(match[1] === undefined ? (match[2] ?? "") : match[1].replaceAll('""', '"'));
  return cells;
}

function tableOf(text: string): HTMLElement {
  const lines = text.split(/\r?\n/).filter((it) => it !== "" && !it.startsWith("#"));
  const [heads = [], ...rows] = lines.slice(0, shownRows + 1).map(cellsOf);
  const isNumber = heads.map(
    (_, k) => rows.length > 0 && rows.every((row) => row[k] !== "" && !Number.isNaN(Number(row[k]))),
  );
  const cell = (name: "td" | "th", text: string, k: number): HTMLElement =>
    element(name, { ...(isNumber[k] ? { class: "number" } : {}), ...(name === "th" ? { scope: "col" } : {}) }, text);
  const rest = lines.length - 1 - rows.length;
  return element(
    "table",
    {},
    rest > 0 ? element("caption", {}, `The first ${rows.length} of ${lines.length - 1} rows`) : null,
    element("thead", {}, element("tr", {}, ...heads.map((it, k) => cell("th", it, k)))),
    element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map((it, k) => cell("td", it, k))))),
  );
}
