import type { ChoiceCandidate, ChoiceFile } from "../api/results";
import type { Workspace, WorkspaceFile } from "../api/workspace";
import { button, element, numberCell, table } from "../ui/dom";
import { plain, withUnit } from "../ui/numbers";
import { tableMenu } from "../ui/plot/out/export_menu";
import type { Context } from "../ui/view";
import { feelButton } from "./law_panel";
import { lawBeside, stableWord } from "./names";
import { inPageWords } from "../ui/page_words";

/** What speaks against the law that is named; nothing where it serves. */
function doubt(of: ChoiceFile): string {
  if (of.choice.serves) return "";
  return of.choice.in_doubt ? "in doubt: the machine was too late to tell" : "does not serve";
}

function title(of: ChoiceFile): string {
  if (!of.choice.law) return "Nothing was chosen";
  if (of.choice.serves) return `Chosen: ${of.choice.law}`;
  return of.choice.in_doubt ? `In doubt: ${of.choice.law}` : `None serves; the nearest is ${of.choice.law}`;
}

function candidateTable(of: readonly ChoiceCandidate[], unit: string, ifTaken: string): HTMLElement {
  const rows = of.map((it) => [
    it.law,
    numberCell(String(it.parameters), it.parameters),
    numberCell(withUnit(it.held_out, unit), it.held_out),
    numberCell(plain(it.held_out_jnd, 2), it.held_out_jnd),
    numberCell(`${plain(it.tick_us, 2)} µs`, it.tick_us),
    stableWord(it.stable),
    it.passed_over || ifTaken,
  ]);
  const all = table(
    "The candidates, simplest first",
    [
      "law",
      "free",
      ["held out as rendered", `held-out error as rendered [${unit}]`],
      ["JND", "held-out error [JND]"],
      ["tick", "tick [µs]"],
      "stable",
      "why passed over",
    ],
    rows,
  );
  return element(
    "div",
    { class: "scrolled candidates", tabindex: 0, role: "region", "aria-label": "The candidates" },
    all,
    tableMenu(all, "candidates"),
  );
}

const whyOthersDiffer =
  "A fit names the simplest law by its held-out error alone. A choice tries more variants, and asks that the law is stable and in " +
  "time. A chart's fronts begin with the cheapest tick. So the three may name different laws.";

/** A choice in words: what was taken, why, and what was passed over. */
export class ChoicePanel {
  readonly root = element("section", { class: "card choice", "aria-label": "Choice of a law" });

  constructor(
    private readonly context: Context,
    private readonly workspace: Workspace,
    private readonly choose: (() => void) | null,
    private readonly openLaw: (id: string, title: string) => void,
  ) {
    this.root.append(
      element("div", { class: "head" }, element("h2", {}, "The simplest law that serves"), ...this.again("Choose")),
      element(
        "p",
        { class: "quiet" },
        "Nothing has been chosen yet for this recording. The search goes from the fewest parameters up and takes " +
          "the first law within what a hand can feel, that is stable where that can be judged.",
      ),
    );
  }

  private again(text: string): HTMLElement[] {
    return this.choose ? [button(text, this.choose)] : [];
  }

  async open(file: WorkspaceFile): Promise<void> {
    try {
      this.show(file, await this.context.api.get<ChoiceFile>("/api/result", { id: file.id }));
    } catch (error) {
      this.context.complain(error);
    }
  }

  private show(file: WorkspaceFile, of: ChoiceFile): void {
    const law = of.choice.law ? lawBeside(this.workspace, file, `${of.choice.law}.law.toml`) : undefined;
    const unit = of.force_unit ?? "N";
    const head = element("div", { class: "head" }, element("h2", {}, title(of)));
    if (law) {
      const name = of.choice.law ?? law.name;
      head.append(
        button("Open", () => this.openLaw(law.id, name), { "aria-label": `Open ${name}` }),
        feelButton(this.context, law.id, name),
      );
    }
    head.append(...this.again("Choose again"));
    this.root.replaceChildren(
      head,
      element("p", { class: of.choice.serves ? "" : "wrong" }, of.choice.why),
      of.choice.blame ? element("p", {}, `What is to blame: ${of.choice.blame}.`) : "",
      element(
        "p",
        { class: "quiet" },
        `Errors: ${of.held_out_by}. JND ${withUnit(of.jnd, unit)}. ${of.device ? `Stability on ${of.device}.` : ""} ${law?.name ?? ""}`,
      ),
      element(
        "ul",
        { class: "effects" },
        ...of.effects.map((it) =>
          element("li", {}, element("strong", {}, `${it.effect} ${it.verdict}`), `: ${it.why}`),
        ),
      ),
      candidateTable(of.candidates, unit, doubt(of) || "taken"),
      ...of.warnings.map((it) => element("p", { class: "quiet" }, inPageWords(it))),
      element("p", { class: "quiet" }, whyOthersDiffer),
    );
  }
}
