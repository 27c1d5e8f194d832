import type { Loops, Recording } from "../api/recordings";
import { button, element, labelled, select } from "../ui/dom";
import { swatch } from "../ui/time/time_plot";
import { XyPlot, type PlotLine } from "../ui/xy_plot";
import { stateKeys } from "../recording/keys";
import { Latest } from "../ui/latest";
import type { Context } from "../ui/view";
import type { Drawn } from "./recording_time";

type Kind = "all" | "one" | "average";
const atOnce = 60; // cycles

/** Force against position: all cycles, one, or their average; of several recordings the averages. */
export class RecordingLoops {
  readonly root: HTMLElement;
  readonly tools: HTMLElement;
  private plot: XyPlot | null = null;
  private readonly frame = element("div", {
    class: "loops_frame",
    tabindex: 0,
    role: "group",
    keydown: (it: KeyboardEvent) => this.key(it),
  });
  private readonly text = element("p", { class: "quiet loops_text", role: "status" });
  private readonly key_ = element("ul", { class: "mark_legend", "aria-label": "Lines" });
  private readonly kind: HTMLSelectElement;
  private readonly axis: HTMLSelectElement;
  private readonly previous = button("Previous", () => this.step(-1), { title: "Left arrow" });
  private readonly next = button("Next", () => this.step(1), { title: "Right arrow" });
  private drawn: readonly Drawn[] = [];
  private cycle = 0;
  private cycles = 0;
  private readonly latest: Latest;

  constructor(private readonly context: Context) {
    this.latest = new Latest(context.signal);
    this.kind = select(
      [
        { value: "all", text: "all cycles" },
        { value: "one", text: "one cycle" },
        { value: "average", text: "average" },
      ],
      "all",
      () => this.choose(),
    );
    this.axis = select([], "", () => this.choose());
    this.tools = element(
      "div",
      { class: "tab_tools" },
      labelled("Show", this.kind),
      labelled("Axis", this.axis),
      this.previous,
      this.next,
      this.text,
    );
    this.root = element("div", { class: "recording_loops" }, this.tools, this.frame, this.key_);
  }

  end(): void {
    this.plot?.end();
  }

  show(drawn: readonly Drawn[]): void {
    const before = this.drawn[0]?.recording;
    this.drawn = drawn;
    const own = drawn[0]?.recording;
    if (!own) return;
    if (own !== before) {
      this.axis.replaceChildren(...own.axes.map((it, k) => element("option", { value: String(k) }, it.name)));
      this.take(own);
    }
    void this.load();
  }

  /** What the address says has changed. */
  follow(): void {
    const own = this.drawn[0]?.recording;
    if (!own) return;
    this.take(own);
    void this.load();
  }

  private take(own: Recording): void {
    const { state } = this.context;
    const kind = state.get(stateKeys.loops) ?? (state.number(stateKeys.cycle) === null ? "all" : "one");
    this.kind.value = kind === "one" || kind === "average" ? kind : "all";
    this.axis.value = String(state.number(stateKeys.axis) ?? own.cycles?.axis ?? 0);
    this.cycle = Math.max(0, (state.number(stateKeys.cycle) ?? 1) - 1);
  }

  /** By hand: a step of its own in the address. */
  private choose(): void {
    this.keep("push");
    void this.load();
  }

  private keep(step: "push" | "replace"): void {
    const own = this.drawn[0]?.recording.cycles?.axis ?? 0;
    const axis = Number(this.axis.value);
    const kind = this.kind.value;
    const values = {
      [stateKeys.axis]: axis === own ? null : axis,
      [stateKeys.loops]: kind === "all" ? null : kind,
      [stateKeys.cycle]: kind === "one" ? this.cycle + 1 : null,
    };
    this.context.state.set(values, step);
  }

  private step(by: number): void {
    if (this.kind.value === "average") return;
    const width = this.kind.value === "one" ? 1 : atOnce;
    const last = Math.max(0, this.cycles - 1);
    this.cycle = Math.min(Math.max(0, this.cycle + by * width), last - (last % width));
    this.keep("replace");
    void this.load();
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
    event.preventDefault();
    this.step(event.key === "ArrowLeft" ? -1 : 1);
  }

  private async load(): Promise<void> {
    const kind = this.kind.value as Kind;
    if (kind === "all") this.cycle -= this.cycle % atOnce;
    const first = kind === "average" ? 0 : this.cycle;
    const count = kind === "one" ? 1 : atOnce;
    try {
      const answers = await this.latest.ask((signal) =>
        Promise.all(this.drawn.map((it) => this.fetch(it.recording, first, count, signal))),
      );
      if (answers) this.draw(answers, kind, first);
    } catch (error) {
      this.text.textContent = "";
      this.context.complain(error);
    }
  }

  private fetch(recording: Recording, first: number, count: number, signal: AbortSignal): Promise<Loops | null> {
    const own = this.drawn[0]?.recording;
    const name = own?.axes[Number(this.axis.value)]?.name;
    const axis = recording.axes.findIndex((it) => it.name === name);
    if (axis < 0) return Promise.resolve(null);
    const wanted = { id: recording.id, axis, first: first + 1, count }; // cycles are counted from 1
    const answer = this.context.api.get<Loops>("/api/recording/loops", wanted, signal);
    return recording === own ? answer : answer.catch(() => null); // one laid over that has no cycles is left out
  }

  private draw(answers: readonly (Loops | null)[], kind: Kind, first: number): void {
    const own = answers[0];
    if (!own) return;
    this.cycles = own.cycles_in_all;
    const several = answers.length > 1;
    const lines: PlotLine[] = [];
    answers.forEach((loops, k) => {
      if (!loops) return;
      if (kind !== "average" && (k === 0 || kind === "one")) {
        for (const it of loops.loops)
          lines.push({ x: it.position, y: it.force, class: kind === "one" ? `look_${k}` : "many" });
      }
      if (kind === "average" || (k > 0 && kind === "all")) {
        lines.push({ x: loops.average.position, y: loops.average.closing, class: `look_${k}` });
        lines.push({ x: loops.average.position, y: loops.average.opening, class: `look_${k} second` });
      }
    });
    this.replot(own);
    this.plot?.show(lines, XyPlot.around(lines));
    this.previous.disabled = kind === "average" || first === 0;
    const shown = own.loops.length;
    this.next.disabled = kind === "average" || first + shown >= own.cycles_in_all;
    this.text.textContent = inWords(own, kind, first);
    this.key_.replaceChildren(
      ...(several ? this.drawn.map((it, k) => element("li", {}, swatch(k), it.name)) : []),
      ...(kind === "average" ? [element("li", {}, "full line: closing; broken line: opening")] : []),
    );
  }

  private replot(loops: Loops): void {
    const x = `position ${loops.axis} [${loops.position_unit}]`;
    const y = `force ${loops.axis} [${loops.force_unit}]`;
    if (this.frame.dataset.axes === x + y) return;
    this.frame.dataset.axes = x + y;
    this.plot?.end();
    this.plot = new XyPlot({ label: x }, { label: y }, "Force against position");
    this.frame.setAttribute("aria-label", "Force against position. Left and right arrow: the cycle before and after.");
    this.frame.replaceChildren(this.plot.svg);
  }
}

function inWords(loops: Loops, kind: Kind, first: number): string {
  const all = loops.cycles_in_all;
  const found = loops.segmented_here ? ", found for this view" : "";
  if (all === 0) return loops.reason || "No cycles found.";
  if (kind === "average") return `Average of ${all} cycles${found}`;
  if (kind === "one") return `Cycle ${loops.loops[0]?.cycle ?? first + 1} of ${all}${found}`;
  return `Cycles ${first + 1} to ${first + loops.loops.length} of ${all}${found}`;
}
