import type { Job } from "../../api/jobs";
import type { FittedLaw } from "../../api/results";
import type { Workspace, WorkspaceFile } from "../../api/workspace";
import { element, labelled, select } from "../../ui/dom";
import { Latest } from "../../ui/latest";
import type { Context, OpenRecording } from "../../ui/view";
import { JobList } from "../jobs";
import { resultName } from "../names";
import { openResult, type OpenedResult } from "../opened_result";
import { newest, resultsOf } from "./files";

/** What one tab of results shows of a recording, and how another is ordered. */
export interface ResultsTab {
  kinds: readonly (WorkspaceFile["kind"] & Job["kind"])[]; // the newest of the first kind is shown where there is any
  key: string; // of the address
  label: string; // of the list of results
  none: string; // what is said where there is none yet
  gone: string; // and where the address has one that is not there any more
  /** The form, given the laws that can be fitted; its first child is the summary. */
  form: (laws: FittedLaw[]) => HTMLElement[];
  /** Another result is shown, or none. */
  shown?: (file: WorkspaceFile | undefined) => void;
}

/** Fits, or charts and choices, of one recording: one of them is shown, and another can be ordered. */
export class ResultsOfRecording {
  readonly root = element("div", { class: "scrolling results" });
  private readonly head = element("div", { class: "tab_head" });
  private readonly order = element("details", { class: "order_fold" });
  private readonly result = element("div", { class: "result" });
  private readonly jobs: JobList;
  private readonly latest: Latest;
  private opened: OpenedResult | null = null;
  private file: WorkspaceFile | undefined; // that is shown

  /** `notes` stand above the result. */
  constructor(
    private readonly context: Context,
    private readonly recording: OpenRecording,
    private readonly tab: ResultsTab,
    ...notes: HTMLElement[]
  ) {
    this.latest = new Latest(context.signal);
    this.jobs = new JobList(context, tab.kinds);
    const tools = element("div", { class: "tab_tools" }, this.head, this.order);
    this.root.append(tools, this.jobs.root, ...notes, this.result);
    context.state.onChange(() => void this.show());
    void this.show();
    void this.offer();
  }

  end(): void {
    this.jobs.end();
    this.opened?.end();
  }

  /** Orders work; its result is shown, or stands beside what is shown where `beside` says so. */
  work(path: string, body: unknown, beside: (shown: WorkspaceFile | undefined) => boolean = () => false): void {
    this.context.say("");
    void this.jobs.order(path, body, (id) => (beside(this.file) ? void this.show() : this.choose(id)));
  }

  /** What the address asks for, or the newest. */
  private async show(): Promise<void> {
    const { context, tab } = this;
    try {
      const found = await this.latest.ask(async (signal) => {
        const workspace = await context.folder();
        const files = resultsOf(workspace, this.recording, tab.kinds);
        const asked = context.state.get(tab.key);
        const file = asked === null ? usual(files, tab.kinds[0]) : this.asked(workspace, asked);
        const open = file ? await openResult(context, workspace, file, this.follow, signal) : null;
        return { files, asked, file, open };
      });
      if (!found) return;
      const { files, asked, file, open } = found;
      this.opened?.end();
      this.opened = open?.() ?? null;
      this.file = file;
      this.order.open = !this.opened;
      tab.shown?.(file);
      this.list(files, file);
      const none = asked === null ? tab.none : tab.gone;
      this.result.replaceChildren(this.opened?.root ?? element("p", { class: "quiet" }, none));
    } catch (error) {
      context.complain(error);
    }
  }

  private asked(workspace: Workspace, id: string): WorkspaceFile | undefined {
    const kinds: readonly string[] = this.tab.kinds;
    return workspace.files.find((it) => it.id === id && kinds.includes(it.kind));
  }

  /** A choice that is ordered from a chart stands beside it. */
  private readonly follow = (path: string, body: unknown): void =>
    this.work(path, body, (shown) => shown?.kind === "chart" && path === "/api/choose");

  private list(files: readonly WorkspaceFile[], shown: WorkspaceFile | undefined): void {
    const options = files.map((it) => ({ value: it.id, text: resultName(it) }));
    const choice = labelled(
      this.tab.label,
      select(options, shown?.id ?? "", (id) => this.choose(id)),
    );
    this.head.replaceChildren(files.length > 0 ? choice : "");
  }

  private choose(id: string): void {
    this.context.state.set({ [this.tab.key]: id }, "push");
    void this.show();
  }

  private async offer(): Promise<void> {
    const { api, complain, signal } = this.context;
    try {
      this.order.replaceChildren(...this.tab.form(await api.get<FittedLaw[]>("/api/laws/fitted", {}, signal)));
    } catch (error) {
      complain(error);
    }
  }
}

function usual(files: readonly WorkspaceFile[], first: WorkspaceFile["kind"] | undefined): WorkspaceFile | undefined {
  return newest(files.filter((it) => it.kind === first)) ?? newest(files);
}
