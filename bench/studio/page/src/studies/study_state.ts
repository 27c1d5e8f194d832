import type { StudyEntry } from "../api/studies";
import { element } from "../ui/dom";
import { date } from "../ui/words/moments";

const words: Record<StudyEntry["state"], string> = { "not run": "not run", run: "run", changed: "changed since" };
const shapes: Record<StudyEntry["state"], string> = { "not run": "○", run: "●", changed: "◐" };

/** The state in a word, with a shape of its own. */
export function stateBadge(it: StudyEntry): HTMLElement {
  return element(
    "span",
    { class: `study_badge ${it.state.replace(" ", "_")}` },
    element("span", { "aria-hidden": "true" }, `${shapes[it.state]} `),
    words[it.state],
  );
}

/** What state it is in, why, and what to do about it. */
export function stateInWords(it: StudyEntry): HTMLElement {
  const run = element("code", {}, `kerf study run ${it.name}/study.toml`);
  const when = it.run_at ? `Run ${date(it.run_at)} by ${it.software}.` : "";
  if (it.state === "run") return element("p", { class: "state" }, stateBadge(it), ` ${when}`);
  if (it.state === "not run")
    return element("p", { class: "state" }, stateBadge(it), " Look through its study.toml, then: ", run);
  return element(
    "div",
    { class: "state" },
    element("p", {}, stateBadge(it), ` ${when} What is below is of that run; what changed is computed by `, run),
    element("ul", {}, ...it.changes.map((each) => element("li", {}, each))),
  );
}
