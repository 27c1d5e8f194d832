import uPlot from "uplot";

import { drawn, element } from "../dom";
import { linearTicks, plain, unitFor } from "../numbers";
import { dashes, palette } from "../palette";
import { calmLimits } from "./time_limits";
import { columnAt, widen, type Mapping, type TimeLine } from "./time_line";
import { drawCycleMarks } from "./cycle_marks";
import { drawEvents, drawGround, noMarks, type TimeMarks } from "./time_marks";
import { TimeRaster } from "./time_raster";
import type { TimeRange } from "./time_range";

const axisWidth = 76;
const timeAxisHeight = 46;
const font = "13px system-ui, 'Noto Sans', 'DejaVu Sans', sans-serif";
const labelFont = `600 ${font}`;

/** What the plots of a stack have in common. */
export interface Shared {
  range: TimeRange;
  marks: TimeMarks;
  origin_s: number; // the time that is written as 0
  timeLabel: string;
  redraw: () => void; // soon
}

/**
 * One plot of quantities of one unit over time: axes by uPlot, lines by TimeRaster, a legend that is the
 * cursor's read-out too. Its size is its box's; nothing in it moves anything outside.
 */
export class TimePlot {
  readonly root: HTMLElement;
  readonly over: HTMLElement;
  private readonly plot: uPlot;
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
    this.plot = new uPlot(
      this.options(),
      [
        [0, 1],
        [null, null],
      ],
      this.box,
    );
    this.over = this.plot.over;
    this.raster.canvas.className = "time_layer";
    this.over.append(this.ground, this.raster.canvas, this.line);
    this.plot.root.querySelector(".u-wrap")?.setAttribute("aria-hidden", "true");
  }

  end(): void {
    this.plot.destroy();
  }

  /** Takes the size of its box. */
  fit(): void {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width < 50 || height < 20 || (width === this.plot.width && height === this.plot.height)) return;
    this.plot.setSize({ width, height });
  }

  /** Pixels of the screen across the plot, without axes. */
  get columns(): number {
    return Math.max(100, Math.round(this.plot.bbox.width || 1000));
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
    this.unit = unitFor(this.logarithmic ? 1 : Math.max(-limits[0], limits[1]), this.lines[0]?.unit ?? "");
    const relative = [range.from, range.to].map((it) => ((it - this.shared.origin_s) / range.span).toFixed(6));
    const axes = [...relative, range.span, ...limits, this.logarithmic, this.shared.timeLabel].join(" ");
    if (axes !== this.axes) this.plot.redraw(true, true);
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

  private options(): uPlot.Options {
    const { range } = this.shared;
    const ink = (): string => palette().ink;
    const grid = { stroke: () => palette().grid, width: 1 };
    const ticks = { stroke: () => palette().line, width: 1, size: 5 };
    return {
      width: 400,
      height: 100,
      padding: [6, 20, this.bottom ? 0 : 6, 0],
      legend: { show: false },
      cursor: { show: false },
      select: { show: false, left: 0, top: 0, width: 0, height: 0 },
      series: [{}, { paths: () => null, points: { show: false }, auto: false }],
      scales: {
        x: { time: false, auto: false, range: () => [range.from, range.to] },
        y: { range: () => this.limits ?? [0, 1] },
      },
      axes: [
        {
          show: true,
          stroke: ink,
          font,
          labelFont,
          grid,
          ticks: { ...ticks, show: this.bottom },
          border: { show: true, stroke: () => palette().line, width: 1 },
          size: this.bottom ? 24 : 0,
          labelSize: this.bottom ? timeAxisHeight - 24 : 0,
          label: this.bottom ? () => this.shared.timeLabel : "",
          splits: (plot, _, from, to) => this.timeTicks(from, to, (plot.bbox.width || 800) / uPlot.pxRatio),
          values: (_, splits) => (this.bottom ? this.timeTexts(splits) : splits.map(() => "")),
        },
        {
          stroke: ink,
          font,
          labelFont,
          grid,
          ticks,
          border: { show: true, stroke: () => palette().line, width: 1 },
          size: axisWidth - 22,
          labelSize: 22,
          label: () => `[${(this.logarithmic ? unitFor(1, this.lines[0]?.unit ?? "") : this.unit).text || "1"}]`,
          splits: (plot, _, lower, upper) => this.valueTicks(lower, upper, plot.bbox.height / uPlot.pxRatio),
          values: (_, splits) => this.valueTexts(splits),
        },
      ],
      hooks: { setSize: [() => this.shared.redraw()] },
    };
  }

  /** Whole steps from the origin, so that they stand still while time runs. */
  private timeTicks(from: number, to: number, pixels: number): number[] {
    const { origin_s: origin } = this.shared;
    return linearTicks(from - origin, to - origin, pixels / 110).map((it) => it + origin);
  }

  private timeTexts(splits: number[]): string[] {
    const { origin_s: origin } = this.shared;
    const step = splits.length > 1 ? splits[1]! - splits[0]! : 1;
    const decimals = Math.min(9, Math.max(0, -Math.floor(Math.log10(step) + 1e-6)));
    return splits.map((it) =>
      (it - origin)
        .toFixed(decimals)
        .replace(/^-(0(\.0*)?)$/, "$1")
        .replace("-", "−"),
    );
  }

  private valueTicks(lower: number, upper: number, height: number): number[] {
    const count = Math.max(2, height / 26);
    if (!this.logarithmic)
      return linearTicks(lower / this.unit.factor, upper / this.unit.factor, count).map((it) => it * this.unit.factor);
    const ticks: number[] = [];
    const every = Math.max(1, Math.ceil((upper - lower) / count));
    for (let decade = Math.ceil(lower); decade <= upper; decade += every) ticks.push(decade);
    return ticks;
  }

  private valueTexts(splits: number[]): string[] {
    if (!this.logarithmic) return splits.map((it) => plain(it / this.unit.factor, 5));
    return splits.map((it) => {
      const { factor, text } = unitFor(10 ** it, this.lines[0]?.unit ?? "");
      return `${plain(10 ** it / factor, 2)} ${text}`;
    });
  }

  /** Marks, and the lines above them, in canvases as large as the plot without its axes. */
  private layers(): void {
    const { range, marks } = this.shared;
    const { map, plot } = this;
    [map.width, map.height, map.pixels] = [Math.round(plot.bbox.width), Math.round(plot.bbox.height), uPlot.pxRatio];
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
    for (const line of this.lines)
      this.raster.add(line, colours.lines[line.look] ?? colours.ink, dashes[line.look] ?? []);
    this.raster.paint();
  }
}

/** A short piece of a line as it is drawn. */
export function swatch(look: number): SVGSVGElement {
  return drawn(
    "svg",
    { class: "swatch", viewBox: "0 0 30 12", width: 30, height: 12, "aria-hidden": "true" },
    drawn("line", {
      class: `look_${look}`,
      x1: 1,
      x2: 29,
      y1: 6,
      y2: 6,
      "stroke-dasharray": (dashes[look] ?? []).join(" "),
    }),
  );
}
