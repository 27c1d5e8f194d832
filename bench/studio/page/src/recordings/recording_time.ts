import type { Api } from "../api/api";
import type { CycleSpan, Recording, RecordingInspection, Trace, TraceView } from "../api/recordings";
import { element } from "../ui/dom";
import { looks } from "../ui/palette";
import { StretchLoader } from "../ui/time/stretch_loader";
import type { Span, TimeMarks } from "../ui/time/time_marks";
import type { TimeLine } from "../ui/time/time_line";
import { TimeStack, type PlotOrder } from "../ui/time/time_stack";
import { clippedMarks, cycleMarks, cyclesOf } from "./cycle_flags";
import { traceOver } from "./laid_over";
import { emptyLine, inWords, plotsOf, takeView } from "./trace_groups";

/** A recording that is drawn: the page's own first, then those laid over it. */
export interface Drawn {
  recording: Recording;
  name: string;
  shift_s: number; // added to its times, so that it lies over the first
}

interface Source {
  drawn: Drawn;
  traces: number[]; // indices in the recording, as many as lines
  lines: TimeLine[];
  loader: StretchLoader;
}

/** Recordings over time: any stretch at the screen's resolution, with cycles, gaps and events of the first. */
export class RecordingTime {
  readonly root: HTMLElement;
  readonly stack: TimeStack;
  readonly legend = legend();
  private sources: Source[] = [];
  private first: Recording | null = null;
  private beginning = false; // what is shown at first is nobody's choice, and no state of the address
  private found: RecordingInspection | null = null;
  private readonly sampled = element("span", { class: "sampled", role: "status" });

  constructor(
    private readonly api: Api,
    private readonly complain: (error: unknown) => void,
    /** Stands in the bar above the plots, before what is read there. */
    tools: HTMLElement,
    /** The stretch that is shown has changed; whether it is the whole. */
    private readonly moved: (from_s: number, to_s: number, whole: boolean) => void = () => {},
    /** All rows of the first have been gone through, which they had not when it was told of. */
    private readonly prepared: () => void = () => {},
  ) {
    tools.append(this.sampled);
    this.stack = new TimeStack({
      name: "The recording over time",
      file: () => `${this.sources.map((it) => it.drawn.name.replace(/\.h5$/, "")).join(" ")} over time`,
      timeLabel: "time [s]",
      tools,
      changed: ({ from, to, first, last }) => {
        this.want();
        if (!this.beginning) this.moved(from, to, from <= first && to >= last);
      },
    });
    this.root = element("div", { class: "recording_time" }, this.stack.root);
  }

  end(): void {
    for (const it of this.sources) it.loader.end();
    this.stack.end();
  }

  /** Draws traces of these names; a recording that has none of them is left out. */
  show(drawn: readonly Drawn[], names: ReadonlySet<string>): void {
    const own = drawn[0]?.recording;
    if (!own) return;
    for (const it of this.sources) it.loader.end();
    const traces = own.traces.filter((it) => names.has(it.name));
    this.sources = drawn.map((it, k) => this.source(it, traces, drawn.length > 1 ? k : 0));
    this.stack.build(drawn.length > 1 ? this.plotsForEach(traces) : plotsOf(traces, this.sources[0]?.lines ?? []));
    this.bound(drawn, own);
    this.want();
  }

  /** Cycles with their flags, and clipped rows, of the page's own recording. */
  inspected(found: RecordingInspection): void {
    this.found = found;
    if (this.first) this.stack.marks = marksOf(this.first, found);
  }

  showAt(from_s: number, to_s: number): void {
    this.stack.range.show(from_s, to_s);
  }

  showAll(): void {
    this.stack.range.whole();
  }

  private source(drawn: Drawn, traces: readonly Trace[], look: number): Source {
    const { recording, shift_s } = drawn;
    const own = this.first ?? recording;
    const indices = traces.map((trace) => traceOver(own, trace, recording));
    const lines = traces.map((trace) => ({ ...emptyLine(trace, look), shift_s }));
    const asked = indices.filter((it) => it >= 0);
    const fetch = (from: number, to: number, columns: number, signal: AbortSignal) =>
      this.api.view(
        "/api/recording/view",
        { id: recording.id, traces: asked.join(","), from: from - shift_s, to: to - shift_s, columns },
        signal,
      );
    const loader = new StretchLoader(
      fetch,
      (view) => {
        indices.forEach((index, k) => {
          if (index >= 0) takeView(lines[k] as TimeLine, view, asked.indexOf(index), recording.period_s);
        });
        if (look === 0) this.tellOfRows(recording, view);
        this.stack.draw();
      },
      this.complain,
    );
    return { drawn, traces: asked, lines, loader };
  }

  /** Which rows the picture is made of, as long as these are not all. */
  private tellOfRows(recording: Recording, view: TraceView): void {
    const count = (rows: number): string => Math.round(rows).toLocaleString("en-GB");
    const gone = `${Math.floor(100 * view.prepared)} % of the rows gone through`;
    this.sampled.textContent =
      view.prepared >= 1
        ? ""
        : view.rowsLookedAt > 0
          ? `Sampled: ${count(view.rowsLookedAt)} of ${count(view.rowsPerColumn)} rows a column; ${gone}`
          : gone;
    if (view.prepared >= 1 && recording.prepared < 1) this.prepared();
  }

  /** With several recordings each trace has a plot, and each recording its colour and dash. */
  private plotsForEach(traces: readonly Trace[]): PlotOrder[] {
    const names = shortNames(this.sources.map((it) => it.drawn.name));
    const own = this.sources[0]!.drawn.recording;
    return traces.map((trace, k) => ({
      title: inWords(trace.name),
      titled: true,
      lines: this.sources.flatMap((it, i) =>
        traceOver(own, trace, it.drawn.recording) < 0 ? [] : [Object.assign(it.lines[k]!, { name: names[i]! })],
      ),
    }));
  }

  private bound(drawn: readonly Drawn[], own: Recording): void {
    const from = Math.min(...drawn.map((it) => it.recording.from_s + it.shift_s));
    const to = Math.max(...drawn.map((it) => it.recording.from_s + it.shift_s + it.recording.seconds));
    const { range } = this.stack;
    range.bound(from, to, 10 * own.period_s);
    if (own !== this.first) {
      this.first = own;
      this.beginning = true;
      range.whole();
      this.beginning = false;
    } else range.show(range.from, range.to);
    this.stack.marks = marksOf(own, this.found);
  }

  private want(): void {
    for (const it of this.sources) if (it.traces.length > 0) it.loader.want(this.stack.range, this.stack.columns);
  }
}

const words: Record<CycleSpan["phase"], string> = {
  closing: "closing",
  opening: "opening",
  open_to_close: "",
  close_to_open: "",
};

function marksOf(recording: Recording, found: RecordingInspection | null): TimeMarks {
  const spans = (recording.cycles?.spans ?? []).map((it): Span => {
    const shade = it.phase === "closing" ? "blue" : it.phase === "opening" ? "orange" : "plain";
    return { from_s: it.from_s, to_s: it.to_s, shade, text: words[it.phase] && `${it.cycle} ${words[it.phase]}` };
  });
  return {
    spans,
    gaps: recording.gaps ?? [],
    events: recording.events,
    cycles: cycleMarks(cyclesOf(recording, found)),
    clipped: clippedMarks(found?.clipped ?? null),
  };
}

function legend(): HTMLElement {
  const item = (name: string, text: string): HTMLElement =>
    element("li", {}, element("span", { class: `key ${name}`, "aria-hidden": "true" }), text);
  return element(
    "ul",
    { class: "mark_legend", "aria-label": "What the marks mean" },
    item("closing", "closing"),
    item("opening", "opening"),
    item("gap", "no rows"),
    item("event", "event"),
    item("cycle", "cycle"),
    item("flagged", "flagged cycle"),
    item("clipped", "clipped rows"),
  );
}

/** How many recordings can be told apart. */
export const atMostDrawn = Math.min(5, looks.length);

/** Files' names without their endings, shortened in the middle; with as much of their folders as tells them apart. */
export function shortNames(names: readonly string[]): string[] {
  const parts = names.map((it) => it.replace(/\.h5(\.partial)?$/, "").split("/"));
  const lastOf = (count: number): string[] => parts.map((it) => it.slice(-count).join("/"));
  const most = Math.max(...parts.map((it) => it.length));
  let count = 1;
  while (count < most && new Set(lastOf(count)).size < names.length) ++count;
  const room = 16 + 6 * (count - 1);
  return lastOf(count).map((it) =>
    it.length <= room ? it : `${it.slice(0, room / 2 - 1)}…${it.slice(it.length - room / 2)}`,
  );
}
