import type { FitFile, LawFit, LawView, Residuals } from "../api/results";
import type { Workspace, WorkspaceFile, WorkspaceLaw } from "../api/workspace";
import { stateKeys } from "../recording/keys";
import { element, labelled, select } from "../ui/dom";
import { Latest } from "../ui/latest";
import { counted, plain } from "../ui/numbers";
import { Plot } from "../ui/plot/plot";
import type { Context } from "../ui/view";
import { FitTable, entanglements, parameterTable } from "./fit_table";
import { feelButton } from "./law_panel";
import { lawBeside, recordingsFor } from "./names";
import { lawMenu } from "./law_menu";
import { atMostCompared, lawColours, type ComparedLaw } from "./compared/compared_law";
import { Comparison } from "./compared/comparison";
import { heldOutFigure } from "./compared/held_out";
import { inPageWords } from "../ui/page_words";

const columns = 600;

function list(title: string, lines: readonly string[], kind = ""): HTMLElement | null {
  if (lines.length === 0) return null;
  return element(
    "details",
    { class: kind, open: kind === "warnings" },
    element("summary", {}, title),
    element("ul", {}, ...lines.map((it) => element("li", {}, inPageWords(it)))),
  );
}

/** A fit as it was written: all laws compared, and one of them looked at. */
export class FitPage {
  readonly root: HTMLElement;
  private readonly table: FitTable;
  private readonly detail = element("section", { class: "detail", "aria-label": "The law that is looked at" });
  private readonly against = element("div");
  private readonly drawn = element("section", { class: "beside_laws", "aria-label": "Laws beside each other" });
  private readonly left = element("section", { class: "beside_laws", "aria-label": "What laws leave of the data" });
  private readonly errors: Plot;
  private readonly latest: Latest;
  private comparison: Comparison | null = null;
  private recording: string;
  private shown: WorkspaceLaw | undefined;

  constructor(
    private readonly context: Context,
    private readonly workspace: Workspace,
    private readonly file: WorkspaceFile,
    private readonly fit: FitFile,
  ) {
    const of = fit.recordings[0];
    const unit = fit.force_unit ?? "N";
    const blamed = fit.fits.find((it) => it.model === fit.choice.model)?.blame;
    this.recording = recordingsFor(workspace, of?.name ?? "", of?.uuid)[0]?.id ?? "";
    this.latest = new Latest(context.signal);
    this.table = new FitTable(
      fit,
      (law) => this.pick(law),
      () => this.choose(),
    );
    this.errors = new Plot(`Errors of laws: ${of?.name ?? ""}`);
    const refused = fit.refused.map((it) => `${it.model}: ${it.why}`);
    const choice = element(
      "p",
      { class: "choice" },
      element("strong", {}, fit.choice.model ? `Choice: ${fit.choice.model}. ` : "No choice. "),
      fit.choice.why,
    );
    const about =
      `${of?.name ?? ""}, axis ${of?.axis ?? ""}: ${fit.samples} samples. ` +
      `JND ${plain(fit.jnd)} ${unit}; a straight line leaves ${plain(fit.line_rmse)} ${unit}. ` +
      "Errors are over every row in contact, of whose force the JND is; those of the tab Law, and its JND, are of the " +
      "averaged cycle, without what cycles differ by.";
    const said = element(
      "div",
      { class: "fit_words" },
      blamed ? element("p", {}, element("strong", {}, "What is to blame: "), `${blamed}.`) : null,
      list("Warnings", fit.warnings, "warnings"),
      list(`${counted(refused.length, "law")} could not be fitted`, refused),
      element("p", { class: "quiet" }, about),
      this.detail,
    );
    const errors = this.errors.figure("Errors, fitted and held out");
    this.root = element(
      "div",
      { class: "fit_page" },
      element(
        "div",
        { class: "fit_first" },
        element("div", { class: "drawn_laws" }, this.drawn),
        element("div", { class: "fit_line" }, choice, this.against),
        this.table.root,
      ),
      element("div", { class: "fit_rest" }, said, element("div", { class: "left_by_laws" }, this.left, errors)),
    );
    const named = (model: string | null): LawFit | undefined => fit.fits.find((it) => it.model === model);
    const first = named(context.state.get(stateKeys.law)) ?? named(fit.choice.model) ?? fit.fits[0];
    const asked = context.state.get(stateKeys.laws)?.split(",") ?? [];
    const wanted = fit.fits.filter((it) => asked.includes(it.model)).map((it) => it.model);
    this.table.tick(wanted.length > 0 ? wanted : first ? [first.model] : []);
    this.errors.show(heldOutFigure(fit, this.table.order));
    this.begin(of?.name ?? "");
    if (first) this.look(first);
  }

  end(): void {
    this.comparison?.end();
    this.errors.end();
    this.latest.end();
  }

  /** A law that is looked at is drawn as well. */
  private pick(law: LawFit): void {
    this.look(law);
    this.context.state.set({ [stateKeys.law]: law.model }, "replace");
    const { ticked } = this.table;
    if (ticked.includes(law.model)) return;
    this.table.tick([...ticked.slice(0, atMostCompared - 1), law.model]);
    this.choose();
  }

  /** Laws that are ticked stand in the address. */
  private choose(): void {
    this.context.state.set({ [stateKeys.laws]: this.table.ticked.join(",") || null }, "replace");
    void this.compare();
  }

  private begin(name: string): void {
    const against = select(
      recordingsFor(this.workspace, name, this.fit.recordings[0]?.uuid).map((it) => ({ value: it.id, text: it.name })),
      this.recording,
      (id) => {
        this.recording = id;
        this.begin(name);
      },
    );
    this.comparison?.end();
    this.comparison = new Comparison(this.recording, name);
    this.against.replaceChildren(labelled("Over the recording", against));
    this.drawn.replaceChildren(this.comparison.first);
    this.left.replaceChildren(this.comparison.rest);
    void this.compare();
  }

  private look(law: LawFit): void {
    this.table.mark(law.model);
    const file = lawBeside(this.workspace, this.file, law.law_files[0] ?? "");
    this.shown = file;
    const head = element("div", { class: "head" }, element("h2", {}, law.model));
    if (file) {
      const menu = lawMenu(this.context, file, law.model);
      head.append(feelButton(this.context, file.id, law.model), element("span", { class: "quiet" }, file.name), menu);
    }
    const equation = element("p", { class: "equation" }, "\u00a0");
    this.detail.replaceChildren(
      head,
      equation,
      law.blame ? element("p", {}, element("strong", {}, "What is to blame: "), `${law.blame}.`) : "",
      parameterTable(law),
      list("Warnings", law.warnings, "warnings") ?? "",
      list("Parameters that cannot be told apart", entanglements(law), "warnings") ?? "",
    );
    if (!file) {
      this.detail.append(element("p", {}, "Its law file is not in this folder any more."));
      return;
    }
    this.context.api.get<LawView>("/api/law", { id: file.id }).then((it) => {
      if (this.shown === file) equation.textContent = it.equation;
    }, this.context.complain);
  }

  private async compare(): Promise<void> {
    const { recording, comparison } = this;
    const axis = this.fit.recordings[0]?.axis ?? "";
    const laws = this.table.ticked.flatMap((model, k) => {
      const file = lawBeside(
        this.workspace,
        this.file,
        this.fit.fits.find((it) => it.model === model)?.law_files[0] ?? "",
      );
      return file && recording ? [{ model, colour: lawColours[k]!, file }] : [];
    });
    try {
      const found = await this.latest.ask((signal) =>
        Promise.all(
          laws.slice(0, atMostCompared).map(async ({ model, colour, file }): Promise<ComparedLaw> => {
            const wanted = { id: recording, axis, law: file.id, columns };
            return {
              model,
              colour,
              residuals: await this.context.api.get<Residuals>("/api/residuals", wanted, signal),
            };
          }),
        ),
      );
      if (found && this.comparison === comparison) comparison?.show(found);
    } catch (error) {
      this.context.complain(error);
    }
  }
}
