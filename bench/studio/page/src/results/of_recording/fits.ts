import type { FitFile, FittedLaw } from "../../api/results";
import type { Workspace } from "../../api/workspace";
import { EarlierFits } from "../../cycles/earlier_fits";
import { stateKeys } from "../../recording/keys";
import { element, labelled, select } from "../../ui/dom";
import { Latest } from "../../ui/latest";
import type { Context, OpenRecording } from "../../ui/view";
import { FitPage } from "../fit_page";
import { FitOptions } from "../fit_options";
import { JobList } from "../jobs";
import { LawCheckboxes } from "../law_checkboxes";
import { resultName } from "../names";
import { newest, resultsOf } from "./files";

/** The fits of one recording: one of them is shown, and another can be ordered. */
export class FitsOfRecording {
  readonly root = element("div", { class: "scrolling results" });
  private readonly head = element("div", { class: "tab_head" });
  private readonly order = element("details", { class: "order_fold" });
  private readonly shown = element("div", { class: "result" });
  private readonly jobs: JobList;
  private readonly latest: Latest;
  private readonly earlier: EarlierFits;
  private page: FitPage | null = null;

  constructor(
    private readonly context: Context,
    private readonly recording: OpenRecording,
  ) {
    this.latest = new Latest(context.signal);
    this.jobs = new JobList(context, ["fit"]);
    this.earlier = new EarlierFits(context, recording);
    this.root.append(
      element("div", { class: "tab_tools" }, this.head, this.order),
      this.jobs.root,
      this.earlier.root,
      this.shown,
    );
    context.state.onChange(() => void this.show());
    void this.show();
    void this.offer();
  }

  end(): void {
    this.jobs.end();
    this.page?.end();
  }

  /** The fit of the address, or the newest. */
  private async show(): Promise<void> {
    const { api, state } = this.context;
    try {
      const found = await this.latest.ask(async (signal) => {
        const workspace = await api.get<Workspace>("/api/workspace", {}, signal);
        const files = resultsOf(workspace, this.recording.name, ["fit"]);
        const asked = state.get(stateKeys.fit);
        const file =
          asked === null ? newest(files) : workspace.files.find((it) => it.id === asked && it.kind === "fit");
        const fit = file ? await api.get<FitFile>("/api/result", { id: file.id }, signal) : null;
        return { workspace, files, asked, file, fit };
      });
      if (!found) return;
      const { workspace, files, asked, file, fit } = found;
      this.page?.end();
      this.page = file && fit ? new FitPage(this.context, workspace, file, fit) : null;
      this.order.open = !this.page;
      this.earlier.show(file?.id ?? "none");
      this.head.replaceChildren(
        files.length > 0
          ? labelled(
              "Fit",
              select(
                files.map((it) => ({ value: it.id, text: resultName(it) })),
                file?.id ?? "",
                (id) => this.choose(id),
              ),
            )
          : "",
      );
      const none =
        asked === null
          ? "Nothing has been fitted to this recording yet: choose laws above and press Fit."
          : "That fit is not in the folder any more: choose another above, or fit anew.";
      this.shown.replaceChildren(this.page?.root ?? element("p", { class: "quiet" }, none));
    } catch (error) {
      this.context.complain(error);
    }
  }

  private choose(id: string): void {
    this.context.state.set({ [stateKeys.fit]: id }, "push");
    void this.show();
  }

  private async offer(): Promise<void> {
    const { api, complain, signal } = this.context;
    try {
      this.form(await api.get<FittedLaw[]>("/api/laws/fitted", {}, signal));
    } catch (error) {
      complain(error);
    }
  }

  private form(laws: FittedLaw[]): void {
    const { about } = this.recording;
    const boxes = new LawCheckboxes(laws);
    let axis = about.axes[about.cycles?.axis ?? 0];
    boxes.show(axis);
    const options = new FitOptions(axis);
    const which = select(
      about.axes.map((it) => ({ value: it.name, text: it.name })),
      axis?.name ?? "",
      (name) => boxes.show((axis = about.axes.find((it) => it.name === name))),
    );
    const start = (event: Event): void => {
      event.preventDefault();
      const models = boxes.chosen();
      if (models.length === 0) return this.context.complain(new Error("Choose a law to fit"));
      this.context.say("");
      const order = { recording: this.recording.id, axis: axis?.name ?? "", models, ...options.given };
      void this.jobs.order("/api/fit", order, (file) => this.choose(file));
    };
    this.order.replaceChildren(
      element("summary", {}, "Fit laws"),
      element(
        "form",
        { class: "order", submit: start },
        boxes.root,
        options.root,
        element(
          "div",
          { class: "row" },
          about.axes.length > 1 ? labelled("Axis", which) : null,
          element("button", { type: "submit", class: "firm" }, "Fit"),
        ),
      ),
    );
  }
}
