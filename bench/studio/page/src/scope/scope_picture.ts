import type { Api } from "../api/api";
import type { LiveFrame } from "../api/loop";
import type { KerfEvent, Trace } from "../api/recordings";
import { StretchLoader } from "../ui/time/stretch_loader";
import { TimeStack } from "../ui/time/time_stack";
import type { TimeLine } from "../ui/time/time_line";
import { LiveColumns, ticksInColumn } from "./live_columns";
import { beforeTrigger, crossingRow, TriggerFinder, type TriggerSettings } from "./trigger";
import { emptyLine, plotsOf, takeView } from "../recordings/trace_groups";

const kept_s = 60; // that the server keeps
const labels = {
  running: "time before now [s]",
  ended: "time before the end [s]",
  paused: "time from the pause [s]",
  triggered: "time from the trigger [s]",
};

/**
 * The running loop's picture: newest columns while it runs, the last window that triggered, or any stretch of the last
 * minute when paused.
 */
export class ScopePicture {
  readonly stack: TimeStack;
  paused = false;
  private traces: readonly Trace[] = [];
  private chosen: number[] = []; // traces that are shown
  lines: TimeLine[] = [];
  private columns: LiveColumns | null = null;
  private window_s = 5;
  private rate_hz = 1000;
  private ticks = 0; // that the loop had done when its traces were asked for
  private lastZoom = 0;
  private trigger: TriggerSettings = { mode: "off", trace: -1, level: 0, edge: "rising" };
  private readonly finder = new TriggerFinder();
  private frozen: number | null = null; // the time of the trigger whose window is shown
  private frozenAt = 0; // when it was found [ms of the page]
  private ended = false;
  private readonly loader: StretchLoader;

  constructor(
    private readonly api: Api,
    /** The stream should come with as many ticks in a column. */
    private readonly restream: (ticks: number) => void,
    zoomed: (factor: number) => void,
    complain: (error: unknown) => void,
    /** What is seen has changed. */
    private readonly drawn: () => void,
    /** A window was found, or none for a while (null). */
    private readonly triggered: (at: number | null) => void,
  ) {
    this.stack = new TimeStack({
      name: "The running loop over time",
      timeLabel: labels.running,
      changed: (range) => {
        if (this.paused) this.loader.want(range, this.stack.columns);
        this.drawn();
      },
      zoomedWhileFollowing: (factor) => {
        if (performance.now() - this.lastZoom < 250) return;
        this.lastZoom = performance.now();
        zoomed(factor);
      },
    });
    this.stack.range.following = true;
    this.stack.range.follow(0, this.window_s);
    this.loader = new StretchLoader(
      (from, to, columns, signal) =>
        api.view("/api/live/view", { traces: this.chosen.join(","), from, to, columns }, signal),
      (view) => {
        if (!this.paused || view.time.length === 0) return;
        this.lines.forEach((line, k) => takeView(line, view, k, 1 / this.rate_hz));
        this.stack.draw();
        this.drawn();
      },
      complain,
    );
  }

  end(): void {
    this.loader.end();
    this.stack.end();
  }

  /** Which traces the loop has, which of them are shown, and where the loop is. */
  setTraces(traces: readonly Trace[], chosen: number[], rate_hz: number, ticks: number, logarithmic: boolean): void {
    const same = traces.length === this.traces.length && rate_hz === this.rate_hz;
    this.traces = traces;
    this.rate_hz = rate_hz;
    this.ticks = ticks;
    this.chosen = chosen;
    const shown = chosen.map((it) => traces[it]!);
    this.lines = shown.map((it) => emptyLine(it, 0));
    this.stack.build(plotsOf(shown, this.lines, logarithmic));
    if (same && this.columns) this.attach();
    else this.renew(null);
    if (this.paused) this.loader.want(this.stack.range, this.stack.columns);
  }

  setWindow(window_s: number): void {
    this.window_s = window_s;
    const { range } = this.stack;
    if (this.paused) range.show(range.to - window_s, range.to);
    else range.follow(range.to, window_s);
    this.renew(this.columns);
    this.stack.draw();
  }

  /** The plots have another width, perhaps. */
  fit(): void {
    if (this.columns && this.columns.ticks !== this.ticksWanted()) this.renew(this.columns);
  }

  push(frame: LiveFrame): void {
    const { columns } = this;
    if (!columns || frame.ticks !== columns.ticks) return; // of a stream that is closed
    if (frame.smallest.length !== this.traces.length) return; // of a loop whose traces are not known yet
    if (!columns.push(frame)) return this.restart();
    if (this.paused) return;
    const at = this.trigger.mode === "off" ? null : this.finder.look(columns, this.trigger, this.window_s);
    if (at !== null) {
      this.freeze(at);
      if (columns.ticks > 1) void this.refine(at, columns.column_s);
    } else if (this.isWaiting) this.follow();
  }

  /** When its window begins; from now on. */
  setTrigger(trigger: TriggerSettings): void {
    this.trigger = trigger;
    this.thaw();
    if (!this.paused) this.follow();
  }

  /** The loop has ended: what is seen is its end and nothing that runs. */
  setEnded(ended: boolean): void {
    if (this.ended === ended) return;
    this.ended = ended;
    if (!this.paused && this.frozen === null) this.follow();
  }

  /** Before it nothing is known: the loop, or what is kept of it, had not begun. */
  get firstTick_s(): number {
    return this.columns?.firstTick_s ?? 0;
  }

  get period_s(): number {
    return 1 / this.rate_hz;
  }

  /** Whether time runs in the picture though it is to trigger: until the first, and in auto where there is none. */
  private get isWaiting(): boolean {
    if (this.frozen === null) return true;
    return this.trigger.mode === "auto" && performance.now() - this.frozenAt > 1000 * Math.max(1, 2 * this.window_s);
  }

  /** Shows the window about a trigger, until the next. */
  private freeze(at: number): void {
    const { shared } = this.stack;
    this.attach();
    this.keepLines();
    this.frozenAt = performance.now();
    shared.timeLabel = labels.triggered;
    this.showFrom(at);
    if (this.trigger.mode === "single") this.pause();
  }

  private showFrom(at: number): void {
    const { range, shared } = this.stack;
    this.frozen = at;
    shared.origin_s = at;
    const to = at + (1 - beforeTrigger) * this.window_s;
    if (this.paused) {
      this.bound(to);
      range.show(to - this.window_s, to);
    } else range.follow(to, this.window_s);
    this.stack.draw();
    this.drawn();
    this.triggered(at);
  }

  /** From the column in which it triggered to the row. */
  private async refine(at: number, column_s: number): Promise<void> {
    const settings = this.trigger;
    const { period_s } = this;
    const order = { traces: String(settings.trace), from: at - period_s, to: at + column_s, columns: 4000 };
    try {
      const view = await this.api.view("/api/live/view", order);
      const values = settings.edge === "rising" ? view.traces[0]?.largest : view.traces[0]?.smallest;
      const row = crossingRow(view.time, values ?? [], settings, at - 0.5 * period_s);
      if (this.frozen === at && row !== null) this.showFrom(row);
    } catch {
      // the column is what is known
    }
  }

  private thaw(): void {
    this.finder.reset();
    if (this.frozen !== null) this.triggered(null);
    this.frozen = null;
    if (!this.paused) this.attach();
  }

  private keepLines(): void {
    for (const line of this.lines) {
      line.time = line.time.slice();
      line.smallest = line.smallest.slice();
      line.largest = line.largest.slice();
    }
  }

  /** Another loop has begun: nothing of the last one is shown. */
  restart(): void {
    this.ticks = 0;
    this.resume();
    this.renew(null);
  }

  showEvents(events: readonly KerfEvent[]): void {
    this.stack.marks = { spans: [], gaps: [], events };
  }

  pause(): void {
    if (this.paused || !this.columns) return;
    this.paused = true;
    const { range, shared } = this.stack;
    this.keepLines();
    range.following = false;
    this.bound(range.to);
    if (this.frozen === null) shared.timeLabel = labels.paused;
    this.stack.draw();
    this.loader.want(range, this.stack.columns);
  }

  /** What a paused picture can be moved over. */
  private bound(to: number): void {
    this.stack.range.bound(Math.max(0, to - kept_s), Math.max(to, this.window_s), 10 / this.rate_hz);
  }

  resume(): void {
    if (!this.paused) return;
    this.paused = false;
    this.stack.range.following = true;
    this.thaw();
    this.follow();
  }

  private follow(): void {
    if (!this.columns) return;
    const { range, shared } = this.stack;
    if (this.frozen !== null) this.thaw();
    shared.timeLabel = this.ended ? labels.ended : labels.running;
    range.follow(this.columns.end_s, this.window_s);
    shared.origin_s = range.to;
    for (const line of this.lines) line.step_s = this.columns.column_s;
    this.stack.draw();
    this.drawn();
  }

  private ticksWanted(): number {
    return ticksInColumn(this.window_s, this.rate_hz, this.stack.columns);
  }

  /** New columns for another window or width, with what the old ones hold; the stream tells the past again. */
  private renew(old: LiveColumns | null): void {
    const ticks = this.ticksWanted();
    // Half as much again: the window about a trigger lies a little behind the newest column.
    const capacity = Math.ceil((1.5 * this.window_s * this.rate_hz) / ticks) + 3;
    this.columns = new LiveColumns(this.traces.length, ticks, capacity);
    this.columns.period_s = 1 / this.rate_hz;
    if (old) this.columns.takeFrom(old);
    else this.columns.beginAt(this.ticks);
    this.thaw();
    this.restream(ticks);
  }

  private attach(): void {
    const { columns } = this;
    if (!columns) return;
    this.lines.forEach((line, k) => {
      const trace = this.chosen[k]!;
      line.time = columns.time;
      line.smallest = columns.smallest[trace]!;
      line.largest = columns.largest[trace]!;
      line.step_s = columns.column_s;
      line.middle_s = 0.5 * (columns.ticks - 1) * columns.period_s;
    });
    this.stack.draw();
  }
}
