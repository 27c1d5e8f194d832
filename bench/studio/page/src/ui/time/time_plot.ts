import { drawn, element } from "../dom";
import { figureOf, type Figure, type FigureTick } from "../figure_description";
import { markPath } from "../marks";
import { linearTicks, plain, unitFor } from "../numbers";
import { looks, palette } from "../palette";
import { axesOf, frameOf, roomAtRight } from "../plot/frame";
import { nodeOf } from "../plot/shapes";
import { screenStyle } from "../plot/style";
import { calmLimits } from "./time_limits";
import { columnAt, columnsWithin, widen, type Mapping, type TimeLine } from "./time_line";
import { drawCycleMarks } from "./cycle_marks";
import { figureMarks } from "./figure_marks";
import { drawEvents, drawGround, noMarks, type TimeMarks } from "./time_marks";
import { TimeRaster } from "./time_raster";
import type { TimeRange } from "./time_range";

const axisWidth = 76;

/** What the plots of a stack have in common. */
export interface Shared {
  range: TimeRange;
  marks: TimeMarks;
  origin_s: number; // the time that is written as 0
  timeLabel: string;
  redraw: () => void; // soon
}

/**
 * One plot of quantities of one unit over time: axes as every plot has them, lines by TimeRaster, a legend that is the
 * cursor's read-out too. Its size is its box's; nothing in it moves anything outside.
 */
export class TimePlot {
  readonly root: HTMLElement;
  readonly over: HTMLElement;
  private readonly svg = drawn("svg", { class: "time_axes", "aria-hidden": "true" });
  private size = { width: 400, height: 100 };
  private readonly box: HTMLElement;
  private readonly line = element("div", { class: "time_cursor", hidden: true });
  private readonly values: HTMLElement[] = [];
  private limits: [number, number] | null = null;
  private seen = false; // any value yet
  private marked = false; // there are marks on the ground
  private unit: { factor: number; text: string };
  private readonly found = { lower: 0, upper: 0 };
  private readonly map: Mapping;
  private readonly ground = element("canvas", { class: "time_layer" });
  private readonly raster = new TimeRaster();
  private axes = ""; // what they show: they are drawn again only when that changes

  constructor(
    readonly title: string,
    readonly lines: readonly TimeLine[],
    private readonly shared: Shared,
    private readonly bottom: boolean,
    public logarithmic: boolean,
    private readonly titled: boolean,
  ) {
    this.unit = { factor: 1, text: lines[0]?.unit ?? "" };
    this.map = { from: 0, to: 1, width: 1, lower: 0, upper: 1, height: 1, logarithmic, pixels: 1 };
    this.box = element("div", { class: "time_box" });
    this.root = element("div", { class: bottom ? "time_plot bottom" : "time_plot" }, this.legend(), this.box);
    this.over = element("div", { class: "time_over" }, this.ground, this.raster.canvas, this.line);
    this.box.append(this.svg, this.over);
    this.raster.canvas.className = "time_layer";
  }

  /** Takes the size of its box. */
  fit(): void {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width < 50 || height < 20 || (width === this.size.width && height === this.size.height)) return;
    this.size = { width, height };
    this.axes = "";
    this.shared.redraw();
  }

  /** Pixels of the screen across the plot, without axes. */
  get columns(): number {
    return Math.max(
      100,
      Math.round((this.size.width - axisWidth - roomAtRight(screenStyle())) * (devicePixelRatio || 1)),
    );
  }

  draw(): void {
    const { range } = this.shared;
    this.found.lower = Infinity;
    this.found.upper = -Infinity;
    for (const line of this.lines) widen(this.found, line, range.from, range.to, this.logarithmic);
    const { lower, upper } = this.found;
    const before = this.seen ? this.limits : null;
    this.seen ||= lower <= upper;
    this.limits = this.logarithmic
      ? calmLimits(Math.log10(lower), Math.log10(Math.max(upper, lower)), before, true)
      : calmLimits(lower, upper, before, false);
    const limits = this.limits;
    this.unit = unitFor(this.reach.largest, this.reach.unit);
    const relative = [range.from, range.to].map((it) => ((it - this.shared.origin_s) / range.span).toFixed(6));
    const axes = [...relative, range.span, ...limits, this.logarithmic, this.shared.timeLabel].join(" ");
    if (axes !== this.axes) this.drawAxes(limits);
    this.axes = axes;
    this.layers();
    this.point();
  }

  /** Draws all again: the colours are others. */
  repaint(): void {
    this.axes = "";
    this.draw();
  }

  useLogarithms(on: boolean): void {
    this.logarithmic = on;
    this.limits = null;
  }

  /** Puts the cursor's line and the values at it in their places. */
  point(): void {
    const { range } = this.shared;
    const at = range.cursor;
    const seen = at !== null && at >= range.from && at <= range.to;
    this.line.hidden = !seen;
    if (seen) {
      const x = ((at - range.from) / range.span) * this.over.clientWidth;
      this.line.style.transform = `translateX(${Math.round(x)}px)`;
    }
    this.lines.forEach((line, k) => {
      const text = seen ? this.reading(line, at) : "";
      const cell = this.values[k];
      if (cell && cell.textContent !== text) cell.textContent = text;
    });
  }

  /** The unit of its lines, and how far their axis reaches in it. */
  get reach(): { unit: string; largest: number } {
    const [lower, upper] = this.limits ?? [0, 1];
    return { unit: this.lines[0]?.unit ?? "", largest: this.logarithmic ? 1 : Math.max(-lower, upper) };
  }

  /** What is shown, with all columns that are there: the smallest and the largest value of each, in a unit. */
  figure({ factor, text }: { factor: number; text: string }): Figure {
    const { range, origin_s, timeLabel } = this.shared;
    const stretch = (line: TimeLine): { first: number; end: number } => {
      const [first, end] = columnsWithin(line, range.from, range.to);
      return { first, end };
    };
    const several = this.lines.length > 1;
    const areas = this.lines.map((line) => {
      const { first, end } = stretch(line);
      const scaled = (values: ArrayLike<number>): (number | null)[] =>
        Array.from({ length: end - first }, (_, i) => written(values[first + i]!, factor));
      const x = Array.from(
        { length: end - first },
        (_, i) => line.time[first + i]! + line.shift_s + line.middle_s - origin_s,
      );
      return {
        label: several ? line.name : "",
        name: line.name,
        x,
        low: scaled(line.smallest),
        high: scaled(line.largest),
        colour: looks[line.look % looks.length]!,
        extremes: true,
        each: Number(line.step_s.toPrecision(9)),
        marked: several,
      };
    });
    const [lower, upper] = (this.limits ?? [0, 1]).map((it) => (this.logarithmic ? 10 ** it : it) / factor) as [
      number,
      number,
    ];
    const unit = text || "1";
    return figureOf(timeLabel, `${this.title} [${unit}]`, {
      areas,
      x_range: [range.from - origin_s, range.to - origin_s],
      y_range: [lower, upper],
      log_y: this.logarithmic,
      marks: figureMarks(this.shared.marks, range, origin_s, this.reach.unit),
      notes: [...new Set(this.lines.map((it) => columnsInWords(it)))].filter(Boolean),
    });
  }

  /** What a screen reader hears of the cursor. */
  spoken(): string {
    const at = this.shared.range.cursor;
    if (at === null) return "";
    return this.lines.map((it) => `${it.name} ${this.reading(it, at) || "nothing"}`).join(", ");
  }

  private reading(line: TimeLine, at: number): string {
    const column = columnAt(line, at);
    if (column < 0) return "";
    const { factor, text } = this.readingUnit();
    const [lower, upper] = this.limits ?? [0, 0];
    const nothing = this.logarithmic ? 0 : 1e-6 * (upper - lower); // rounding of the arithmetic, not of the device
    const written = (value: number): string => plain(Math.abs(value) < nothing ? 0 : value / factor, 4);
    const smallest = written(line.smallest[column]!);
    const largest = written(line.largest[column]!);
    return `${smallest === largest ? smallest : `${smallest} to ${largest}`} ${text}`;
  }

  private readingUnit(): { factor: number; text: string } {
    return this.logarithmic ? unitFor(10 ** (this.limits?.[1] ?? 0) * 0.99, this.lines[0]?.unit ?? "") : this.unit;
  }

  private legend(): HTMLElement {
    const items = this.lines.map((line) => {
      const value = element("span", { class: "time_value" });
      this.values.push(value);
      return element("li", {}, swatch(line.look), element("span", { class: "time_name" }, line.name), value);
    });
    const title = this.titled ? element("li", { class: "time_title" }, this.title) : null;
    return element("ul", { class: "time_legend", "aria-label": this.title }, title, ...items);
  }

  private drawAxes([lower, upper]: [number, number]): void {
    const { range } = this.shared;
    const { width, height } = this.size;
    const style = screenStyle();
    const figure = figureOf(this.shared.timeLabel, `[${this.axisUnit.text || "1"}]`, {
      x_ticks: this.timeTicks(range.from, range.to, width - axisWidth),
      y_ticks: this.valueTicks(lower, upper, height - (this.bottom ? 50 : 12)),
    });
    const limits = { x: [range.from, range.to], y: [lower, upper] } as const;
    const frame = frameOf(figure, limits, width, height, style, { left: axisWidth, timeAxis: this.bottom });
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.style.setProperty("font-family", style.font);
    this.svg.replaceChildren(...axesOf(figure, frame, style, this.bottom).map(nodeOf));
    const place = {
      left: frame.left,
      top: frame.top,
      width: frame.right - frame.left,
      height: Math.max(1, frame.bottom - frame.top),
    };
    for (const [name, value] of Object.entries(place)) this.over.style.setProperty(name, `${value}px`);
    this.map.pixels = devicePixelRatio || 1;
    [this.map.width, this.map.height] = [place.width, place.height].map((it) => Math.round(it * this.map.pixels)) as [
      number,
      number,
    ];
  }

  private get axisUnit(): { factor: number; text: string } {
    return this.logarithmic ? unitFor(1, this.lines[0]?.unit ?? "") : this.unit;
  }

  /** Whole steps from the origin, so that they stand still while time runs. */
  private timeTicks(from: number, to: number, pixels: number): FigureTick[] {
    const { origin_s: origin } = this.shared;
    const ticks = linearTicks(from - origin, to - origin, pixels / 110);
    const step = ticks.length > 1 ? ticks[1]! - ticks[0]! : 1;
    const decimals = Math.min(9, Math.max(0, -Math.floor(Math.log10(step) + 1e-6)));
    const written = (value: number): string =>
      value
        .toFixed(decimals)
        .replace(/^-(0(\.0*)?)$/, "$1")
        .replace("-", "−");
    return ticks.map((it) => ({ at: it + origin, name: written(it) }));
  }

  private valueTicks(lower: number, upper: number, height: number): FigureTick[] {
    const count = Math.max(2, height / 26);
    const { factor } = this.unit;
    if (!this.logarithmic)
      return linearTicks(lower / factor, upper / factor, count).map((it) => ({ at: it * factor, name: plain(it, 5) }));
    const ticks: FigureTick[] = [];
    const every = Math.max(1, Math.ceil((upper - lower) / count));
    for (let decade = Math.ceil(lower); decade <= upper; decade += every) {
      const { factor: of, text } = unitFor(10 ** decade, this.lines[0]?.unit ?? "");
      ticks.push({ at: decade, name: `${plain(10 ** decade / of, 2)} ${text}` });
    }
    return ticks;
  }

  /** Marks, and the lines above them, in canvases as large as the plot without its axes. */
  private layers(): void {
    const { range, marks } = this.shared;
    const { map } = this;
    [map.from, map.to] = [range.from, range.to];
    [map.lower, map.upper] = this.limits ?? [0, 1];
    map.logarithmic = this.logarithmic;
    if (map.width < 2 || map.height < 2) return;
    const { ground } = this;
    if (ground.width !== map.width || ground.height !== map.height)
      [ground.width, ground.height] = [map.width, map.height];
    const context = ground.getContext("2d");
    if (context && (this.marked || marks !== noMarks)) {
      context.clearRect(0, 0, map.width, map.height);
      drawGround(context, marks, map, true);
      drawCycleMarks(context, marks, map, this.lines[0]?.unit);
      drawEvents(context, marks, map);
      this.marked = marks !== noMarks;
    }
    const colours = palette();
    this.raster.begin(map);
    for (const line of this.lines) this.raster.add(line, colours.lines[line.look] ?? colours.ink);
    this.raster.paint();
    if (this.lines.length > 1)
      for (const line of this.lines) this.raster.mark(line, colours.lines[line.look] ?? colours.ink, colours.card);
  }
}

/** In a unit, with no more digits than a number of 32 bits has, as which values come. */
function written(value: number, factor: number): number | null {
  if (!Number.isFinite(value)) return null;
  const digits = [6, 7, 8, 9].find((it) => Math.fround(Number(value.toPrecision(it))) === Math.fround(value)) ?? 9;
  return Number((Number(value.toPrecision(digits)) / factor).toPrecision(12));
}

function columnsInWords({ step_s, middle_s, name }: TimeLine): string {
  if (middle_s === 0) return "Every row is there.";
  return `${name}: smallest and largest value of every ${plain(1e3 * step_s, 4)} ms, at its middle; no spike is lost.`;
}

/** A short piece of a line as it is drawn. */
export function swatch(look: number): SVGSVGElement {
  const kind = `look_${look}`;
  return drawn(
    "svg",
    { class: "swatch", viewBox: "0 0 30 12", width: 30, height: 12, "aria-hidden": "true" },
    drawn("line", { class: kind, x1: 1, x2: 29, y1: 6, y2: 6 }),
    drawn("path", { class: kind, d: markPath(looks[look % looks.length]!, 15, 6, 4.5) }),
  );
}
