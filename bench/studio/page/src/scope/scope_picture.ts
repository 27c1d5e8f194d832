import type { Api } from "../api/api";
import type { LiveFrame } from "../api/loop";
import type { KerfEvent, Trace } from "../api/recordings";
import { StretchLoader } from "../ui/time/stretch_loader";
import { TimeStack } from "../ui/time/time_stack";
import type { TimeLine } from "../ui/time/time_line";
import { LiveColumns, ticksInColumn } from "./live_columns";
import { emptyLine, plotsOf, takeView } from "../recordings/trace_groups";

const kept_s = 60; // that the server keeps

/** The running loop's picture: newest columns while it runs, any stretch of the last minute when paused. */
export class ScopePicture {
  readonly stack: TimeStack;
  paused = false;
  private traces: readonly Trace[] = [];
  private chosen: number[] = []; // traces that are shown
  private lines: TimeLine[] = [];
  private columns: LiveColumns | null = null;
  private window_s = 5;
  private rate_hz = 1000;
  private ticks = 0; // that the loop had done when its traces were asked for
  private lastZoom = 0;
  private readonly loader: StretchLoader;

  constructor(
    api: Api,
    /** The stream should come with as many ticks in a column. */
    private readonly restream: (ticks: number) => void,
    zoomed: (factor: number) => void,
    complain: (error: unknown) => void,
  ) {
    this.stack = new TimeStack({
      name: "The running loop over time",
      timeLabel: "time before now [s]",
      changed: (range) => this.paused && this.loader.want(range, this.stack.columns),
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
    if (!this.paused) this.follow();
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
    for (const line of this.lines) {
      line.time = line.time.slice();
      line.smallest = line.smallest.slice();
      line.largest = line.largest.slice();
    }
    range.following = false;
    range.bound(Math.max(0, range.to - kept_s), Math.max(range.to, this.window_s), 10 / this.rate_hz);
    shared.timeLabel = "time from the pause [s]";
    this.stack.draw();
    this.loader.want(range, this.stack.columns);
  }

  resume(): void {
    if (!this.paused) return;
    this.paused = false;
    this.stack.range.following = true;
    this.stack.shared.timeLabel = "time before now [s]";
    this.attach();
    this.follow();
  }

  private follow(): void {
    if (!this.columns) return;
    const { range, shared } = this.stack;
    range.follow(this.columns.end_s, this.window_s);
    shared.origin_s = range.to;
    for (const line of this.lines) line.step_s = this.columns.column_s;
    this.stack.draw();
  }

  private ticksWanted(): number {
    return ticksInColumn(this.window_s, this.rate_hz, this.stack.columns);
  }

  /** New columns for another window or width, with what the old ones hold; the stream tells the past again. */
  private renew(old: LiveColumns | null): void {
    const ticks = this.ticksWanted();
    const capacity = Math.ceil((this.window_s * this.rate_hz) / ticks) + 3;
    this.columns = new LiveColumns(this.traces.length, ticks, capacity);
    this.columns.period_s = 1 / this.rate_hz;
    if (old) this.columns.takeFrom(old);
    else this.columns.beginAt(this.ticks);
    if (!this.paused) this.attach();
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
