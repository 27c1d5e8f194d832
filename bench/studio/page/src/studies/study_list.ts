import type { StudyEntry } from "../api/studies";
import { element } from "../ui/dom";
import { stateBadge } from "./study_state";

/** The studies of the workspace with their state and what is to be known of their files. */
export function studyList(studies: readonly StudyEntry[]): HTMLElement {
  if (studies.length === 0) return none();
  const heads = ["Study", "State", "Recordings", "Count", "Failed", "Doubted", "Tissues", "Speeds", "Specimens"];
  return element(
    "div",
    { class: "scrolled" },
    element(
      "table",
      { class: "studies" },
      element("caption", {}, "Studies in this folder"),
      element("thead", {}, element("tr", {}, ...heads.map((it) => element("th", { scope: "col" }, it)))),
      element("tbody", {}, ...studies.map(row)),
    ),
  );
}

function none(): HTMLElement {
  return element(
    "p",
    {},
    "There is no study in this folder. From a drawer of files to a conclusion: ",
    element("code", {}, "kerf study new DRAWER -o STUDY"),
  );
}

function row(it: StudyEntry): HTMLElement {
  const name = element("th", { scope: "row" }, element("a", { href: `#/studies/${it.id}` }, it.name));
  if (it.error)
    return element("tr", {}, name, element("td", { colspan: 8, class: "wrong" }, `Cannot be read: ${it.error}`));
  const count = (value: number | null, marked: boolean): HTMLElement =>
    element("td", { class: marked && value ? "number wrong" : "number" }, value === null ? "–" : String(value));
  return element(
    "tr",
    {},
    name,
    element("td", {}, stateBadge(it)),
    element("td", { class: "number" }, recordingsOf(it)),
    element(
      "td",
      { class: it.counted === 0 ? "number wrong" : "number" },
      it.counted === null ? "–" : String(it.counted),
    ),
    count(it.failed, true),
    count(it.doubted, true),
    element("td", {}, inShort(it.tissues)),
    element("td", {}, inShort(it.speeds)),
    element("td", {}, inShort(it.specimens, "not named")),
  );
}

/** "7 (2 blanks)". */
export function recordingsOf(it: StudyEntry): string {
  if (it.blanks === 0) return String(it.recordings);
  return `${it.recordings} (${it.blanks} ${it.blanks === 1 ? "blank" : "blanks"})`;
}

/** The first names, and how many there are. */
export function inShort(names: readonly string[], none = "–", atMost = 6): string {
  if (names.length === 0) return none;
  const more = names.length - atMost;
  return names.slice(0, atMost).join(", ") + (more > 0 ? ` and ${more} more` : "");
}
