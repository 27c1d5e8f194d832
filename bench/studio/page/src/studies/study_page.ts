import type { Conclusion, Study } from "../api/studies";
import { element } from "../ui/dom";
import type { Context } from "../ui/view";
import { drawerTable } from "./drawer_table";
import { resultTables } from "./result_tables";
import { stateInWords } from "./study_state";
import { StudyPictures } from "./study_pictures";

/** One study: what it comes to, its drawer at a glance, its tables. */
export class StudyPage {
  readonly root: HTMLElement;
  private readonly pictures: StudyPictures;

  constructor(context: Context, study: Study) {
    this.pictures = new StudyPictures(context, study);
    const drawn = study.drawer.some((it) => it.failure === null && it.flagged !== null);
    this.root = element(
      "div",
      { class: "stack" },
      element("nav", { class: "row", "aria-label": "With this study" }, ...links(context, study)),
      stateInWords(study),
      settings(study),
      study.conclusions.length > 0 ? conclusions(study.conclusions) : null,
      element(
        "section",
        {},
        element("h2", {}, "The drawer at a glance"),
        drawn ? this.pictures.root : null,
        drawerTable(study),
        ignored(study),
      ),
      ...resultTables(study),
      tables(context, study),
    );
  }

  end(): void {
    this.pictures.end();
  }
}

/** A link to a file of the study. */
function link(
  { api, signal }: Context,
  study: Study,
  [what, more]: readonly [what: string, more: Record<string, string>],
  attributes: Record<string, string>,
  text: string,
): HTMLElement {
  const made = element("a", attributes, text);
  api.opening(`/api/study/${what}`, { id: study.id, ...more }).then(
    (address) => signal.aborted || (made.href = address),
    () => {}, // the bar says that the studio does not answer
  );
  return made;
}

function links(context: Context, study: Study): (HTMLElement | null)[] {
  return [
    element("a", { class: "go", href: "#/studies" }, "All studies"),
    study.report
      ? link(
          context,
          study,
          ["report", {}],
          { class: "go", target: "_blank", rel: "noopener" },
          "Report (in a new tab)",
        )
      : null,
  ];
}

function settings(study: Study): HTMLElement {
  const fact = (name: string, text: string): HTMLElement =>
    element("div", {}, element("dt", {}, name), element("dd", {}, text));
  return element(
    "dl",
    { class: "facts" },
    fact("Laws", study.laws.join(", ")),
    fact("Cycles", study.all_cycles ? "all" : "those without a flag"),
    fact("Closing", study.closing || "the way that costs more work"),
    fact("Columns", study.map || "each file's own"),
  );
}

const answers: Record<Conclusion["says"], [string, string]> = {
  yes: ["✓", "yes"],
  partly: ["~", "in part"],
  no: ["✗", "no"],
  unknown: ["?", "cannot be told"],
};

function conclusions(all: readonly Conclusion[]): HTMLElement {
  return element(
    "section",
    { class: "conclusions" },
    element("h2", {}, "What it comes to"),
    element(
      "ul",
      {},
      ...all.map((it) => {
        const [shape, word] = answers[it.says];
        return element(
          "li",
          { class: it.says },
          element("span", { class: "answer", "aria-hidden": "true", title: word }, shape),
          element("p", {}, element("span", { class: "unseen" }, `${word}: `), it.sentence),
        );
      }),
    ),
  );
}

function ignored(study: Study): HTMLElement | null {
  if (study.ignored.length === 0) return null;
  return element(
    "details",
    {},
    element("summary", {}, `${study.ignored.length} files take no part`),
    element("ul", {}, ...study.ignored.map((it) => element("li", {}, `${it.file}: ${it.why}`))),
  );
}

function tables(context: Context, study: Study): HTMLElement | null {
  if (study.tables.length === 0) return null;
  const table = (name: string): HTMLElement =>
    element("li", {}, link(context, study, ["table", { name }], { download: name }, name));
  return element(
    "section",
    {},
    element("h2", {}, "Tables"),
    element("p", { class: "quiet" }, "One row an observation; data_dictionary.csv says what each column is."),
    element("ul", { class: "links" }, ...study.tables.map(table)),
  );
}
