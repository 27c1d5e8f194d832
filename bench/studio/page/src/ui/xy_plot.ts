import { drawn } from "./dom";
import { linearTicks, logarithmicTicks, plain } from "./numbers";

export interface AxisOptions {
  label: string; // with its unit: "angle [deg]"
  logarithmic?: boolean;
}

export interface PlotLine {
  x: readonly (number | null)[];
  y: readonly (number | null)[];
  class: string; // "closing", "model", "faint"; looks are the style sheet's
}

export interface Limits {
  x: [number, number];
  y: [number, number];
}

const margin = { left: 72, right: 16, top: 12, bottom: 52 };

/**
 * A plot of one quantity over another, in SVG: axes with units, lines, and layers for what a page adds itself.
 * Everything is in pixels of the plot; x(), y() and their inverses go between these and the quantities.
 */
export class XyPlot {
  readonly svg: SVGSVGElement;
  /** For marks of a page's own, above the lines; cleared by nobody but the page. */
  readonly layer: SVGGElement;
  /** The same, below grid and lines: areas. */
  readonly ground: SVGGElement;
  limits: Limits = { x: [0, 1], y: [0, 1] };
  private width = 640;
  private height = 400;
  private lines: PlotLine[] = [];
  private readonly frame = drawn("g", { class: "frame" });
  private readonly curves = drawn("g", { class: "curves" });
  private readonly observer: ResizeObserver;

  constructor(
    private readonly xAxis: AxisOptions,
    private readonly yAxis: AxisOptions,
    name: string,
    private readonly redrawn: () => void = () => {},
  ) {
    this.layer = drawn("g", { class: "layer" });
    this.ground = drawn("g", { class: "ground" });
    this.svg = drawn(
      "svg",
      { class: "xy_plot", role: "group", "aria-label": name },
      this.ground,
      this.frame,
      this.curves,
      this.layer,
    );
    this.observer = new ResizeObserver((entries) => {
      const box = entries[entries.length - 1]?.contentRect;
      if (!box || box.width < 100 || box.height < 100) return;
      if (box.width === this.width && box.height === this.height) return;
      this.width = box.width;
      this.height = box.height;
      this.draw();
    });
    this.observer.observe(this.svg);
  }

  end(): void {
    this.observer.disconnect();
  }

  /** Limits that hold all lines, with a little room; of a logarithmic axis what is above zero. */
  static around(lines: readonly PlotLine[], logarithmic = { x: false, y: false }): Limits {
    const span = (pick: (line: PlotLine) => readonly (number | null)[], factors: boolean): [number, number] => {
      let lower = Infinity;
      let upper = -Infinity;
      for (const line of lines) {
        for (const value of pick(line)) {
          if (value === null || !Number.isFinite(value) || (factors && value <= 0)) continue;
          lower = Math.min(lower, value);
          upper = Math.max(upper, value);
        }
      }
      if (!(lower <= upper)) return factors ? [1, 10] : [0, 1];
      if (factors) return [lower / 1.15, upper * 1.15];
      const room = 0.04 * (upper - lower || Math.abs(upper) || 1);
      return [lower - room, upper + room];
    };
    return { x: span((it) => it.x, logarithmic.x), y: span((it) => it.y, logarithmic.y) };
  }

  show(lines: PlotLine[], limits: Limits): void {
    this.lines = lines;
    this.limits = limits;
    this.draw();
  }

  x(value: number): number {
    return margin.left + share(value, this.limits.x, this.xAxis) * (this.width - margin.left - margin.right);
  }
  y(value: number): number {
    return (
      this.height - margin.bottom - share(value, this.limits.y, this.yAxis) * (this.height - margin.top - margin.bottom)
    );
  }
  xAt(pixel: number): number {
    return valueAt((pixel - margin.left) / (this.width - margin.left - margin.right), this.limits.x, this.xAxis);
  }
  yAt(pixel: number): number {
    return valueAt(
      (this.height - margin.bottom - pixel) / (this.height - margin.top - margin.bottom),
      this.limits.y,
      this.yAxis,
    );
  }
  /** Where a pointer is, in pixels of the plot. */
  pointer(event: MouseEvent): { x: number; y: number } {
    const box = this.svg.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private draw(): void {
    this.svg.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
    const right = this.width - margin.right;
    const bottom = this.height - margin.bottom;
    const parts: SVGElement[] = [];
    for (const at of ticksOf(this.limits.x, this.xAxis, (right - margin.left) / 90)) {
      const x = this.x(at);
      parts.push(drawn("line", { class: "grid", x1: x, x2: x, y1: margin.top, y2: bottom }));
      parts.push(drawn("text", { class: "tick", x, y: bottom + 20, "text-anchor": "middle" }, plain(at)));
    }
    for (const at of ticksOf(this.limits.y, this.yAxis, (bottom - margin.top) / 56)) {
      const y = this.y(at);
      parts.push(drawn("line", { class: "grid", x1: margin.left, x2: right, y1: y, y2: y }));
      parts.push(drawn("text", { class: "tick", x: margin.left - 8, y: y + 5, "text-anchor": "end" }, plain(at)));
    }
    const middle = (margin.top + bottom) / 2;
    parts.push(
      drawn("rect", {
        class: "border",
        x: margin.left,
        y: margin.top,
        width: right - margin.left,
        height: bottom - margin.top,
      }),
      drawn(
        "text",
        { class: "axis", x: (margin.left + right) / 2, y: this.height - 8, "text-anchor": "middle" },
        this.xAxis.label,
      ),
      drawn(
        "text",
        { class: "axis", x: 18, y: middle, "text-anchor": "middle", transform: `rotate(-90 18 ${middle})` },
        this.yAxis.label,
      ),
    );
    this.frame.replaceChildren(...parts);
    this.curves.replaceChildren(
      ...this.lines.map((line) => drawn("path", { class: `curve ${line.class}`, d: this.path(line) })),
    );
    this.redrawn();
  }

  /** A line within the frame; what is not finite breaks it. */
  path(line: { x: readonly (number | null)[]; y: readonly (number | null)[] }): string {
    let path = "";
    let broken = true;
    let length = 0; // of the stretch so far; one point by itself is a dot
    for (let i = 0; i < line.x.length; ++i) {
      const x = line.x[i];
      const y = line.y[i];
      if (x == null || y == null || !Number.isFinite(x) || !Number.isFinite(y)) {
        if (length === 1) path += "h0";
        length = 0;
        broken = true;
        continue;
      }
      path += `${broken ? "M" : "L"}${this.x(x).toFixed(1)} ${this.y(y).toFixed(1)}`;
      broken = false;
      ++length;
    }
    return length === 1 ? `${path}h0` : path;
  }
}

function share(value: number, [lower, upper]: [number, number], axis: AxisOptions): number {
  if (axis.logarithmic) return Math.log(Math.max(value, 1e-300) / lower) / Math.log(upper / lower);
  return (value - lower) / (upper - lower);
}

function valueAt(at: number, [lower, upper]: [number, number], axis: AxisOptions): number {
  return axis.logarithmic ? lower * (upper / lower) ** at : lower + at * (upper - lower);
}

function ticksOf([lower, upper]: [number, number], axis: AxisOptions, count: number): number[] {
  return axis.logarithmic ? logarithmicTicks(lower, upper) : linearTicks(lower, upper, count);
}
