import type { Recording } from "../api/recordings";
import { stateKeys } from "../recording/keys";
import { InspectionPanel } from "../recordings/inspection_panel";
import { RecordingTime } from "../recordings/recording_time";
import { firstTraces } from "../recordings/recording_traces";
import { element } from "../ui/dom";
import type { Context, OpenRecording } from "../ui/view";
import { CycleDesk } from "./cycle_desk";
import { spanOf } from "./cycle_draft";
import { CycleHandles } from "./cycle_handles";
import { CycleLoop } from "./cycle_loop";
import { CycleSettings } from "./cycle_settings";
import { CycleTable } from "./cycle_table";
import { draftMarks, type Held } from "./draft_marks";
import { EarlierFits } from "./earlier_fits";
import { SaveBar } from "./save_bar";

/** The cycles of a recording over time and in the loop, how they are found, and each of them with its boundaries. */
export class CyclesTab {
  private readonly desk: CycleDesk;
  private readonly time: RecordingTime;
  private readonly handles: CycleHandles;
  private readonly settings: CycleSettings;
  private readonly table: CycleTable;
  private readonly bar: SaveBar;
  private readonly loop: CycleLoop;
  private readonly empty = element("p", { class: "empty", hidden: true });
  private readonly fits: EarlierFits;
  private readonly observer: ResizeObserver;
  private held: Held | null = null;
  private hasLooked = false; // at what the recording has
  private splits = false; // the next press on the plots splits a cycle
  private look: () => Promise<void> = () => Promise.resolve();

  constructor(
    root: HTMLElement,
    private readonly context: Context,
    private readonly recording: OpenRecording,
  ) {
    const { about, id } = recording;
    const { api, state } = context;
    this.loop = new CycleLoop(recording.name);
    this.desk = new CycleDesk(context, id, () => this.show(), {
      writing: () => {
        const end = recording.writing();
        return (written) => end(written, () => void this.look());
      },
      reload: () => recording.reload(),
    });
    this.time = new RecordingTime(api, context.complain, element("div", {}), (from, to, whole) => {
      state.set({ [stateKeys.from]: whole ? null : from, [stateKeys.to]: whole ? null : to });
      this.handles.place();
    });
    this.handles = new CycleHandles(api, id, this.time.stack.range, this.time.root, {
      held: (at, time_s) => {
        this.held = { index: at.index, edge: at.edge, time_s };
        this.mark();
      },
      move: (at, row, time_s, tag) => {
        this.held = null;
        this.desk.move(at, row, time_s, tag);
      },
      complain: (error) => {
        this.held = null;
        context.complain(error);
        this.show();
      },
    });
    this.settings = new CycleSettings(about.axes, (settings, axis) => this.desk.find(settings, axis));
    this.table = new CycleTable({
      choose: (cycle) => this.choose(cycle),
      split: () => {
        this.splits = !this.splits;
        this.context.say(this.splits ? "Press in the plots where the cycle is to be split." : "");
        this.show();
      },
      merge: () => void this.desk.merge(),
      remark: (cycle, remark) => this.desk.remark(cycle, remark),
    });
    this.bar = new SaveBar(this.desk);
    this.fits = new EarlierFits(context, recording);
    const plots = element("div", { class: "cycle_plots" }, this.time.root, this.handles.root);
    this.lay(root, plots);
    this.observer = new ResizeObserver(() => this.handles.place());
    this.observer.observe(plots);
    plots.addEventListener("click", () => (this.splits ? this.splitAtCursor() : this.chooseAtCursor()));
    this.takeKeys();
    this.time.show([{ recording: about, name: recording.name, shift_s: 0 }], tracesOf(about));
    this.follow();
    state.onChange(() => this.follow());
    void this.desk.open();
  }

  end(): void {
    this.observer.disconnect();
    this.time.end();
    this.loop.end();
  }

  private lay(root: HTMLElement, plots: HTMLElement): void {
    const main = element("div", { class: "cycle_main" }, this.empty, plots, this.loop.root);
    const worth = new InspectionPanel((from_s, to_s) => {
      const [from, to] = [Math.max(0, from_s - 1), to_s + 1];
      this.context.state.set({ [stateKeys.from]: from, [stateKeys.to]: to }, "push");
      this.time.showAt(from, to);
      main.scrollIntoView();
    });
    const sideName = "Cycles of the recording";
    const side = element(
      "aside",
      { class: "cycle_side", "aria-label": sideName },
      this.settings.root,
      this.fits.root,
      this.table.root,
    );
    root.append(
      element(
        "div",
        { class: "scrolling cycles_scroll" },
        element("div", { class: "cycle_desk" }, this.bar.root, main, side),
        element("section", { "aria-label": "What it is worth" }, worth.root),
      ),
    );
    this.look = async () => {
      const { signal } = this.context;
      try {
        const found = await this.recording.inspection();
        if (!signal.aborted) worth.show(found);
      } catch (error) {
        if (!signal.aborted) worth.fail(error);
      }
    };
    void this.look();
  }

  private takeKeys(): void {
    this.context.offer(
      { title: "Undo", group: "Cycles", run: () => this.desk.undo() },
      { title: "Redo", group: "Cycles", run: () => this.desk.redo() },
      { title: "Split the cycle at the cursor", group: "Cycles", keys: "s", run: () => this.splitAtCursor() },
      { title: "Merge the cycle with the next", group: "Cycles", keys: "m", run: () => void this.desk.merge() },
    );
    // After a reload nothing has the focus.
    const key = (event: KeyboardEvent): void => {
      if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z") return;
      if (event.target instanceof HTMLInputElement && ["text", "search"].includes(event.target.type)) return; // it undoes its own
      event.preventDefault();
      if (event.shiftKey) this.desk.redo();
      else this.desk.undo();
    };
    addEventListener("keydown", key, { signal: this.context.signal });
  }

  /** What the address says. */
  private follow(): void {
    const { state } = this.context;
    const [from, to] = [state.number(stateKeys.from), state.number(stateKeys.to)];
    if (from !== null && to !== null && to > from) this.time.showAt(from, to);
    else this.time.showAll();
    this.desk.show(state.number(stateKeys.cycle) ?? 0);
  }

  private choose(cycle: number): void {
    const { draft } = this.desk;
    this.context.state.set({ [stateKeys.cycle]: cycle }, "push");
    this.desk.show(cycle);
    const span = draft && spanOf(draft, cycle);
    const { range } = this.time.stack;
    if (span) {
      const long = span.to_s - span.from_s;
      const isSeen = span.from_s >= range.from && span.to_s <= range.to && long > 0.2 * range.span;
      if (!isSeen) this.time.showAt(span.from_s - 0.35 * long, span.to_s + 0.35 * long);
    }
    this.show();
  }

  /** A press on a plot chooses the cycle that lies there. */
  private chooseAtCursor(): void {
    const at = this.time.stack.range.cursor;
    const phase = at === null ? undefined : this.desk.draft?.phases.find((it) => at >= it[4] && at < it[5]);
    if (!phase || phase[0] === this.desk.loop) return;
    this.context.state.set({ [stateKeys.cycle]: phase[0] }, "push");
    this.desk.show(phase[0]);
    this.show();
  }

  private splitAtCursor(): void {
    const at = this.time.stack.range.cursor;
    this.splits = false;
    if (at === null) this.context.say("Put the cursor where the cycle is to be split: the pointer, or the arrow keys.");
    else void this.desk.splitAt(at);
    this.show();
  }

  private show(): void {
    const { view, draft, loop } = this.desk;
    this.bar.show();
    if (!view || !draft) return;
    const locked = view.locked !== "";
    const { about } = this.recording;
    if (!this.hasLooked && (!view.stored || view.why_none !== "")) this.settings.unfold();
    this.hasLooked = true;
    this.settings.show(draft.settings ?? view.settings, view.axis, locked);
    this.table.show(view, draft, loop, locked);
    this.table.offer(!locked && draft.phases.length > 0, this.splits, !locked && this.desk.canMerge);
    this.time.root.classList.toggle("splits", this.splits);
    this.handles.show(draft, loop, view.rows, about.period_s, locked);
    this.empty.hidden = view.why_none === "";
    this.empty.textContent = view.why_none;
    const axis = about.axes[view.axis];
    if (axis) this.loop.show(view, axis);
    this.fits.show(view.version);
    this.mark();
  }

  private mark(): void {
    const { view, draft } = this.desk;
    if (view && draft) this.time.stack.marks = draftMarks(this.recording.about, view, draft, this.held);
  }
}

/** Position and force along the axis of the cycles are what they are seen by; a measured force before a commanded one. */
function tracesOf(about: Recording): ReadonlySet<string> {
  const axis = about.axes[about.cycles?.axis ?? 0]?.name ?? "";
  const own = about.traces.filter((it) => it.name.endsWith(` ${axis}`));
  const forces = own.filter((it) => it.group === "force");
  const force = forces.find((it) => it.name.includes("measured")) ?? forces[0];
  const wanted = [...own.filter((it) => it.group === "position"), ...(force ? [force] : [])].map((it) => it.name);
  return wanted.length > 0 ? new Set(wanted) : firstTraces(about);
}
