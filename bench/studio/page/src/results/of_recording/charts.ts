import type { ChartFile, FittedLaw } from "../../api/results";
import type { Workspace, WorkspaceFile } from "../../api/workspace";
import { stateKeys } from "../../recording/keys";
import { button, element, labelled, select } from "../../ui/dom";
import { Latest } from "../../ui/latest";
import type { Context, OpenRecording } from "../../ui/view";
import { ChartPage } from "../chart_page";
import { ChoicePanel } from "../choice_panel";
import { JobList } from "../jobs";
import { LawCheckboxes } from "../law_checkboxes";
import { LawPanel } from "../law_panel";
import { resultName } from "../names";
import { newest, resultsOf } from "./files";

interface Part {
  root: HTMLElement;
  end: () => void;
}

/** The charts and choices of one recording: one of them is shown, and another can be ordered. */
export class ChartsOfRecording {
  readonly root = element("div", { class: "scrolling results" });
  private readonly head = element("div", { class: "tab_head" });
  private readonly order = element("details", { class: "order_fold" });
  private readonly shown = element("div", { class: "result" });
  private readonly jobs: JobList;
  private readonly latest: Latest;
  private part: Part | null = null;
  private isChart = false; // what is shown

  constructor(
    private readonly context: Context,
    private readonly recording: OpenRecording,
  ) {
    this.latest = new Latest(context.signal);
    this.jobs = new JobList(context, ["chart", "choice"]);
    this.root.append(element("div", { class: "tab_tools" }, this.head, this.order), this.jobs.root, this.shown);
    context.state.onChange(() => void this.show());
    void this.show();
    void this.offer();
  }

  end(): void {
    this.jobs.end();
    this.part?.end();
  }

  /** What the address asks for, or the newest chart, or else the newest choice. */
  private async show(): Promise<void> {
    const { api, state } = this.context;
    try {
      const found = await this.latest.ask(async (signal) => {
        const workspace = await api.get<Workspace>("/api/workspace", {}, signal);
        const files = resultsOf(workspace, this.recording.name, ["chart", "choice"]);
        const asked = state.get(stateKeys.chart);
        const last = newest(files.filter((it) => it.kind === "chart")) ?? newest(files);
        const file = asked === null ? last : workspace.files.find((it) => it.id === asked);
        const chart = file?.kind === "chart" ? await api.get<ChartFile>("/api/result", { id: file.id }, signal) : null;
        return { workspace, files, asked, file, chart };
      });
      if (!found) return;
      const { workspace, files, asked, file, chart } = found;
      this.part?.end();
      this.isChart = chart !== null;
      this.part = chart && file ? this.chartOf(workspace, file, chart) : file ? this.choiceOf(workspace, file) : null;
      this.order.open = !this.part;
      this.head.replaceChildren(
        files.length > 0
          ? labelled(
              "Result",
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
          ? "This recording has no chart yet: choose laws above and press Chart. It takes a minute."
          : "That chart is not in the folder any more: choose another above, or chart anew.";
      this.shown.replaceChildren(this.part?.root ?? element("p", { class: "quiet" }, none));
    } catch (error) {
      this.context.complain(error);
    }
  }

  private chartOf(workspace: Workspace, file: WorkspaceFile, chart: ChartFile): Part {
    return new ChartPage(this.context, workspace, file, chart, (path, body) => this.work(path, body));
  }

  private choiceOf(workspace: Workspace, file: WorkspaceFile): Part {
    const law = new LawPanel(this.context);
    const panel = new ChoicePanel(this.context, workspace, null, (id, name) => void law.open(id, name));
    void panel.open(file);
    return { root: element("div", { class: "two" }, panel.root, law.root), end: () => law.end() };
  }

  private choose(id: string): void {
    this.context.state.set({ [stateKeys.chart]: id }, "push");
    void this.show();
  }

  private work(path: string, body: Readonly<Record<string, unknown>>): void {
    this.context.say("");
    // A choice stands beside the chart, where there is one.
    void this.jobs.order(path, body, (file) =>
      this.isChart && path === "/api/choose" ? void this.show() : this.choose(file),
    );
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
    const { about, id } = this.recording;
    const boxes = new LawCheckboxes(laws);
    let axis = about.axes[about.cycles?.axis ?? 0];
    boxes.show(axis);
    const which = select(
      about.axes.map((it) => ({ value: it.name, text: it.name })),
      axis?.name ?? "",
      (name) => boxes.show((axis = about.axes.find((it) => it.name === name))),
    );
    const start = (event: Event): void => {
      event.preventDefault();
      const models = boxes.chosen();
      if (models.length === 0) return this.context.complain(new Error("Choose a law to chart"));
      this.work("/api/chart", { recording: id, axis: axis?.name ?? "", models });
    };
    this.order.replaceChildren(
      element("summary", {}, "Chart laws, or choose one"),
      element(
        "form",
        { class: "order", submit: start },
        boxes.root,
        element(
          "p",
          { class: "quiet" },
          "Every law is fitted in every size, and its tick is timed: a chart takes a minute. " +
            "A choice tries every law that fits the axis, whatever is ticked.",
        ),
        element(
          "div",
          { class: "row" },
          about.axes.length > 1 ? labelled("Axis", which) : null,
          element("button", { type: "submit", class: "firm" }, "Chart"),
          button("Choose the simplest that serves", () =>
            this.work("/api/choose", { recording: id, axis: axis?.name ?? "" }),
          ),
        ),
      ),
    );
  }
}
