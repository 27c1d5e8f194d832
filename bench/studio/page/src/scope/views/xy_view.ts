import { element, labelled, select, setOptions } from "../../ui/dom";
import { figureOf, lineOf } from "../../ui/figure_description";
import { unitFor } from "../../ui/numbers";
import { palette } from "../../ui/palette";
import { exportMenu } from "../../ui/plot/out/export_menu";
import type { Sheet } from "../../ui/plot/out/sheet";
import { columnsWithin, type TimeLine } from "../../ui/time/time_line";
import { clipTo, drawAxes } from "./canvas_axes";

/** One trace over another, of the stretch that the scope shows; the newest end has a point. */
export class XyView {
  readonly root: HTMLElement;
  private readonly canvas = element("canvas", {
    class: "scope_canvas",
    role: "img",
    "aria-label": "One trace over another",
  });
  private readonly x = select([], "", () => this.choose());
  private readonly y = select([], "", () => this.choose());
  private lines: readonly TimeLine[] = [];
  private shown = { from: 0, to: 0 };

  constructor(
    private wanted: { x: string; y: string },
    private readonly changed: (x: string, y: string) => void,
  ) {
    this.root = element(
      "div",
      { class: "scope_view", hidden: true },
      element(
        "div",
        { class: "scope_bar" },
        labelled("Across", this.x),
        labelled("Up", this.y),
        exportMenu(() => this.sheet()),
      ),
      this.canvas,
    );
  }

  /** Which traces there are; position over force unless chosen otherwise. */
  offer(lines: readonly TimeLine[]): void {
    this.lines = lines;
    const names = lines.map((it) => it.name);
    const usual = (start: string): string => names.find((it) => it.startsWith(start)) ?? names[0] ?? "";
    const x = names.includes(this.wanted.x) ? this.wanted.x : usual("position");
    const force = names.some((it) => it.startsWith("force measured")) ? "force measured" : "force commanded";
    const y = names.includes(this.wanted.y) ? this.wanted.y : usual(force);
    const options = names.map((it) => ({ value: it, text: it }));
    setOptions(this.x, options, x);
    setOptions(this.y, options, y);
  }

  draw(from: number, to: number): void {
    this.shown = { from, to };
    const [x, y] = this.chosen();
    if (!x || !y) return;
    const [first, end] = columnsWithin(x, from, to);
    const [across, up] = [rangeOf(x, first, end), rangeOf(y, first, end)];
    if (!across || !up) return;
    const axes = drawAxes(
      this.canvas,
      { ...across, unit: x.unit, name: x.name },
      { ...up, unit: y.unit, name: y.name },
    );
    if (!axes) return;
    const { context } = axes;
    const colour = palette().lines[0]!;
    clipTo(axes);
    context.strokeStyle = context.fillStyle = colour;
    context.lineWidth = 1.5;
    context.beginPath();
    let [drawing, lastX, lastY] = [false, NaN, NaN];
    for (let k = first; k < end; ++k) {
      const [at, value] = [middle(x, k), middle(y, k)];
      if (Number.isNaN(at) || Number.isNaN(value)) {
        drawing = false;
        continue;
      }
      [lastX, lastY] = [axes.x(at), axes.y(value)];
      if (drawing) context.lineTo(lastX, lastY);
      else context.moveTo(lastX, lastY);
      drawing = true;
    }
    context.stroke();
    context.beginPath();
    context.arc(lastX, lastY, 5, 0, 2 * Math.PI);
    context.fill();
    context.restore();
  }

  private chosen(): [TimeLine | undefined, TimeLine | undefined] {
    const line = (name: string): TimeLine | undefined => this.lines.find((it) => it.name === name);
    return [line(this.x.value), line(this.y.value)];
  }

  /** What is drawn, in SI. */
  private sheet(): Sheet {
    const [x, y] = this.chosen();
    const name = `${this.y.value} over ${this.x.value}`;
    if (!x || !y) throw new Error("Nothing is drawn yet.");
    const [first, end] = columnsWithin(x, this.shown.from, this.shown.to);
    const columns = Array.from({ length: Math.max(0, end - first) }, (_, k) => first + k);
    // Angles in degrees, as they are drawn.
    const values = (line: TimeLine): (number | null)[] =>
      columns.map((k) => middle(line, k) / unitFor(0, line.unit).factor).map((it) => (Number.isNaN(it) ? null : it));
    const titleOf = (line: TimeLine): string => `${line.name} [${unitFor(0, line.unit).text || "1"}]`;
    const drawn = lineOf("", values(x), values(y), { width: 1 });
    return { name, figures: [figureOf(titleOf(x), titleOf(y), { curves: [drawn] })] };
  }

  private choose(): void {
    this.wanted = { x: this.x.value, y: this.y.value };
    this.changed(this.x.value, this.y.value);
  }
}

export function middle(line: TimeLine, k: number): number {
  return 0.5 * (line.smallest[k]! + line.largest[k]!);
}

/** With a margin; nothing where there is no value. */
function rangeOf(line: TimeLine, first: number, end: number): { from: number; to: number } | null {
  let [low, high] = [Infinity, -Infinity];
  for (let k = first; k < end; ++k) {
    const value = middle(line, k);
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (!(low <= high)) return null;
  const margin = 0.05 * (high - low) || 0.05 * Math.abs(high) || 1e-6;
  return { from: low - margin, to: high + margin };
}
