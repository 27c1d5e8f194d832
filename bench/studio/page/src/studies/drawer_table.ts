import type { DrawerRecording, Study } from "../api/studies";
import { element } from "../ui/dom";
import { plain } from "../ui/numbers";

/** Every recording of a drawer, with what is to be known of its file. */
export function drawerTable(study: Study): HTMLElement {
  const heads = [
    "Recording",
    "Tissue",
    "Speed",
    "Specimen",
    "Good cycles",
    "Law",
    "Held out [JND]",
    "Counts",
    "Remarks",
  ];
  return element(
    "div",
    { class: "scrolled" },
    element(
      "table",
      { class: "drawer" },
      element("caption", {}, takePart(study)),
      element("thead", {}, element("tr", {}, ...heads.map((it) => element("th", { scope: "col" }, it)))),
      element("tbody", {}, ...study.drawer.map(row)),
    ),
  );
}

function takePart({ recordings, files, counted }: Study): string {
  const all = `${recordings} of ${files} files take part`;
  return counted === null ? all : `${all}, ${counted} of them ${counted === 1 ? "counts" : "count"}`;
}

function row(it: DrawerRecording): HTMLElement {
  const known = it.cycles !== null && it.failure === null;
  const cell = (text: string): HTMLElement => element("td", {}, text);
  return element(
    "tr",
    { class: it.failure !== null ? "failed" : it.doubts.length > 0 && it.accepted === null ? "doubted" : "" },
    element(
      "th",
      { scope: "row" },
      it.id === null ? it.name : element("a", { href: `#/recordings/${it.id}` }, it.name),
    ),
    cell(it.blank ? "blank" : it.tissue || "–"),
    cell(it.speed || "–"),
    cell(it.specimen ?? "not named"),
    cell(known ? `${it.good_cycles ?? "?"} of ${it.cycles}` : "–"),
    cell(it.law ?? "–"),
    element("td", { class: "number" }, plain(it.held_out_jnd)),
    cell(it.counts === null ? "–" : it.counts ? "yes" : it.blank ? "as a blank" : "no"),
    element("td", {}, ...remarks(it)),
  );
}

/** What leaves it out stands there at once; what is known beside that is behind its number. */
function remarks(it: DrawerRecording): HTMLElement[] {
  const found: HTMLElement[] = [];
  const wrong = (text: string): number => found.push(element("p", { class: "wrong" }, text));
  if (it.failure !== null) wrong(`Could not be used: ${it.failure}`);
  for (const doubt of it.doubts) wrong(`Doubted: ${doubt}`);
  if (it.accepted !== null) found.push(element("p", {}, `Counts all the same: ${it.accepted}`));
  if (it.not_fitted !== null && !it.blank) found.push(element("p", {}, `Not fitted: ${it.not_fitted}`));
  const flags = (it.flagged ?? []).map((flag) => `cycle ${flag.cycle}: ${flag.reason}`);
  found.push(...folded(flags, "flagged cycle"), ...folded(it.warnings, "warning"));
  return found;
}

function folded(lines: readonly string[], what: string): HTMLElement[] {
  if (lines.length === 0) return [];
  const count = `${lines.length} ${what}${lines.length === 1 ? "" : "s"}`;
  return [
    element(
      "details",
      {},
      element("summary", {}, count),
      element("ul", {}, ...lines.map((it) => element("li", {}, it))),
    ),
  ];
}
