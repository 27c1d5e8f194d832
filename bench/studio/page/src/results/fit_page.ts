import type { FitFile, LawFit, LawView, Residuals } from "../api/results";
import type { Workspace, WorkspaceFile, WorkspaceLaw } from "../api/workspace";
import { element, labelled, select } from "../ui/dom";
import { withUnit } from "../ui/numbers";
import type { Context } from "../ui/view";
import { FitTable, entanglements, parameterTable } from "./fit_table";
import { feelButton } from "./law_panel";
import { lawBeside, recordingsFor } from "./names";
import { ResidualPlots } from "./residual_plots";

const columns = 600;

function list(title: string, lines: readonly string[], kind = ""): HTMLElement | null {
  if (lines.length === 0) return null;
  return element(
    "details",
    { class: kind, open: kind === "warnings" },
    element("summary", {}, title),
    element("ul", {}, ...lines.map((it) => element("li", {}, it))),
  );
}

/** A fit as it was written: all laws compared, and one of them looked at. */
export class FitPage {
  readonly root: HTMLElement;
  private readonly table: FitTable;
  private readonly detail = element("section", { class: "detail", "aria-label": "The law that is looked at" });
  private plots: ResidualPlots | null = null;
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
    this.recording = recordingsFor(workspace, of?.name ?? "")[0]?.id ?? "";
    this.table = new FitTable(fit, (law) => this.look(law));
    const refused = fit.refused.map((it) => `${it.model}: ${it.why}`);
    const compared = element(
      "div",
      { class: "compared" },
      element(
        "p",
        { class: "quiet" },
        `${of?.name ?? ""}, axis ${of?.axis ?? ""}: ${fit.samples} samples. ` +
          `JND ${withUnit(fit.jnd, unit)}; a straight line leaves ${withUnit(fit.line_rmse, unit)}. ` +
          "Errors are over every row in contact; the segment editor's are over the averaged cycle, without what cycles differ by.",
      ),
      this.table.root,
      element(
        "p",
        { class: "choice" },
        element("strong", {}, fit.choice.model ? `Choice: ${fit.choice.model}. ` : "No choice. "),
        fit.choice.why,
      ),
      blamed ? element("p", {}, element("strong", {}, "What is to blame: "), `${blamed}.`) : null,
      list("Warnings", fit.warnings, "warnings"),
      list(`${refused.length} laws could not be fitted`, refused),
    );
    this.root = element("div", { class: "fit_page" }, compared, this.detail);
    const first = fit.fits.find((it) => it.model === fit.choice.model) ?? fit.fits[0];
    if (first) this.look(first);
  }

  end(): void {
    this.plots?.end();
  }

  private look(law: LawFit): void {
    this.table.mark(law.model);
    this.end();
    this.plots = null;
    const file = lawBeside(this.workspace, this.file, law.law_files[0] ?? "");
    this.shown = file;
    const head = element("div", { class: "head" }, element("h2", {}, law.model));
    if (file) head.append(feelButton(this.context, file.id, law.model), element("span", { class: "quiet" }, file.name));
    const equation = element("p", { class: "equation" }, "\u00a0");
    const recordings = recordingsFor(this.workspace, this.fit.recordings[0]?.name ?? "");
    const against = select(
      recordings.map((it) => ({ value: it.id, text: it.name })),
      this.recording,
      (id) => {
        this.recording = id;
        void this.showResiduals();
      },
    );
    this.detail.replaceChildren(head, equation, labelled("Residuals in the recording", against));
    const more = [
      parameterTable(law),
      list("Warnings", law.warnings, "warnings") ?? "",
      list("Parameters that cannot be told apart", entanglements(law), "warnings") ?? "",
    ];
    if (!file) {
      this.detail.append(element("p", {}, "Its law file is not in this folder any more."), ...more);
      return;
    }
    this.plots = new ResidualPlots(file.position_unit || "m", file.force_unit || "N");
    this.detail.append(this.plots.root, ...more);
    this.context.api.get<LawView>("/api/law", { id: file.id }).then((it) => {
      if (this.shown === file) equation.textContent = it.equation;
    }, this.context.complain);
    void this.showResiduals();
  }

  private async showResiduals(): Promise<void> {
    const { shown, plots, recording } = this;
    const axis = this.fit.recordings[0]?.axis ?? "";
    if (!shown || !plots || !recording) return;
    try {
      const of = await this.context.api.get<Residuals>("/api/residuals", {
        id: recording,
        axis,
        law: shown.id,
        columns,
      });
      if (this.plots === plots && this.recording === recording) plots.show(of);
    } catch (error) {
      this.context.complain(error);
    }
  }
}
