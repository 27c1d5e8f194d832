import "./loops.css";

import type { Loops, Recording } from "../api/recordings";
import { button, element, labelled, select, setOptions } from "../ui/dom";
import { figureOf, type Figure } from "../ui/figure_description";
import { counted } from "../ui/numbers";
import { limitsOf } from "../ui/plot/frame";
import { Plot } from "../ui/plot/plot";
import { scaledFor } from "../ui/plot/scaled";
import { rangeAround } from "../ui/plot/scale";
import { axisOver } from "./laid_over";
import { loopCurves, orderInWords, type Kind } from "./loop_curves";
import { namedOnce } from "./trace_groups";
import { stateKeys } from "../recording/keys";
import { Latest } from "../ui/latest";
import type { Context } from "../ui/view";
import type { Drawn } from "./recording_time";

const atOnce = 60; // cycles

/** Force against position: all cycles, one, or their average; of several recordings the averages. */
export class RecordingLoops {
  readonly root: HTMLElement;
  readonly tools: HTMLElement;
  private plots: Plot[] = [];
  private readonly frame = element("div", { class: "loops_frame", keydown: (it: KeyboardEvent) => this.key(it) });
  private readonly text = element("p", { class: "quiet loops_text", role: "status" });
  private readonly kind: HTMLSelectElement;
  private readonly axis: HTMLSelectElement;
  private readonly beside = element("input", { type: "checkbox", change: () => this.choose() });
  private readonly previous = button("Previous", () => this.step(-1), { title: "Key: [" });
  private readonly next = button("Next", () => this.step(1), { title: "Key: ]" });
  private readonly besideLabel = element("label", { class: "tick" }, this.beside, "side by side");
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
      this.besideLabel,
      this.text,
    );
    this.root = element("div", { class: "recording_loops" }, this.tools, this.frame);
  }

  end(): void {
    for (const it of this.plots) it.end();
  }

  show(drawn: readonly Drawn[]): void {
    const before = this.drawn[0]?.recording;
    this.drawn = drawn;
    const own = drawn[0]?.recording;
    if (!own) return;
    if (own !== before) {
      setOptions(
        this.axis,
        own.axes.map((it, k) => ({ value: String(k), text: it.name })),
      );
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
    this.beside.checked = state.get(stateKeys.beside) !== null;
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
      [stateKeys.beside]: this.beside.checked ? 1 : null,
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
    const by = { "[": -1, "]": 1 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    this.step(by);
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
    const axis = own ? axisOver(own, Number(this.axis.value), recording) : -1;
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
    this.besideLabel.hidden = !several;
    const name = (k: number): string => this.drawn[k]?.name ?? "";
    const all = answers.flatMap((loops, k) => (loops ? [loopCurves(loops, kind, k, several ? name(k) : "")] : []));
    const x = scaledFor(
      namedOnce("position", own.axis),
      own.position_unit,
      all.flat().map((it) => it.x),
    );
    const y = scaledFor(
      namedOnce("force", own.axis),
      own.force_unit,
      all.flat().map((it) => it.y),
    );
    const apart = several && this.beside.checked;
    const figures = (apart ? all : [all.flat()]).map((curves) => {
      const drawn = curves.map((it) => ({ ...it, x: x.of(it.x), y: y.of(it.y) }));
      return figureOf(x.label, y.label, {
        curves: drawn,
        notes: notesOf(kind, answers),
        ordered: orderInWords(curves),
      });
    });
    const names = apart
      ? answers.flatMap((it, k) => (it ? [name(k)] : []))
      : [this.drawn.map((it) => it.name).join(", ")];
    this.plot(figures, names);
    const none = kind === "average" || own.cycles_in_all === 0;
    this.previous.disabled = none || first === 0;
    const shown = own.loops.length;
    this.next.disabled = none || first + shown >= own.cycles_in_all;
    this.text.textContent = inWords(own, kind, first);
  }

  /** Side by side they have the same axes, so that they can be compared. */
  private plot(figures: readonly Figure[], names: readonly string[]): void {
    const title = (k: number): string => `Force against position: ${names[k] ?? ""}`;
    if (this.plots.length !== figures.length || this.plots.some((it, k) => it.name !== title(k))) {
      for (const it of this.plots) it.end();
      this.plots = figures.map((_, k) => new Plot(title(k)));
      this.frame.replaceChildren(...this.plots.map((it, k) => it.figure(figures.length > 1 ? names[k] : "")));
    }
    const all = figures.map(limitsOf);
    const together = { x: rangeAround(all.map((it) => it.x)), y: rangeAround(all.map((it) => it.y)) };
    figures.forEach((it, k) => this.plots[k]?.show(it, figures.length > 1 ? together : all[k]));
  }
}

function notesOf(kind: Kind, answers: readonly (Loops | null)[]): string[] {
  if (kind === "average") return ["Averages of the cycles on a grid of positions."];
  const thinned = answers.flatMap((it) => (it ? [thinnedInWords(it)] : [])).find(Boolean);
  return thinned
    ? [`${thinned}: of every stretch the first and last row and those of extreme position and force.`]
    : ["All rows of the cycles."];
}

/** Empty where every row is drawn. */
function thinnedInWords({ loops }: Loops): string {
  const rows = loops.reduce((sum, it) => sum + it.rows, 0);
  const points = loops.reduce((sum, it) => sum + it.position.length, 0);
  return points < rows ? `${points.toLocaleString("en-GB")} of ${counted(rows, "row")} drawn` : "";
}

function inWords(loops: Loops, kind: Kind, first: number): string {
  const all = loops.cycles_in_all;
  if (loops.whole) return `${loops.reason || "No cycles found."} All rows are drawn, decimated by their extremes.`;
  const found = loops.segmented_here ? ", found for this view" : "";
  if (all === 0) return loops.reason || "No cycles found.";
  if (kind === "average") {
    const { averaged } = loops;
    const some =
      averaged > 0 && averaged < all ? `${averaged} of ${counted(all, "cycle")}: the others are left out` : "";
    return `Average of ${some || counted(all, "cycle")}${found}`;
  }
  const thinned = thinnedInWords(loops);
  const which =
    kind === "one"
      ? `Cycle ${loops.loops[0]?.cycle ?? first + 1} of ${all}`
      : `Cycles ${first + 1} to ${first + loops.loops.length} of ${all}`;
  return `${which}${found}${thinned ? `; ${thinned}` : ""}`;
}
