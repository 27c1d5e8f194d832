import "./figure.css";

import type { Figure, FigureCurve, FigureLabel, FigureMarker } from "./figure_description";
import { drawn, element } from "./dom";
import { crossPath, markPath } from "./marks";
import { XyPlot } from "./xy_plot";

/** A mark that stands for something: the page draws it, by markAt() in the layer of the plot, and opens what it stands for. */
export interface Spot {
  of: number;
  x: number;
  y: number;
  curve: FigureCurve;
}

/** The text goes above the curves, its line below them. */
interface DrawnMarker {
  line: SVGElement;
  note: SVGElement;
}

const finite = (value: number | null | undefined): value is number => Number.isFinite(value);

/** A figure as the server describes it, drawn as gnuplot draws it, and its legend; for an element of class "figure". */
export class FigurePlot {
  readonly plot: XyPlot;
  readonly legend: HTMLElement;
  readonly spots: readonly Spot[];
  private readonly over = drawn("g", { class: "over" }); // above what the page draws

  constructor(
    readonly figure: Figure,
    name: string,
    redrawn: () => void, // the page adds its own
  ) {
    this.plot = new XyPlot(
      { label: figure.x_label, logarithmic: figure.log_x },
      { label: figure.y_label, logarithmic: figure.log_y },
      name,
      () => {
        this.draw();
        redrawn();
      },
    );
    this.plot.svg.append(this.over);
    this.spots = figure.curves
      .flatMap((curve) => curve.of.map((of, i) => ({ of, x: curve.x[i] ?? NaN, y: curve.y[i] ?? NaN, curve })))
      .filter((it) => finite(it.x) && finite(it.y));
    this.legend = element("ul", { class: "legend", "aria-label": "Legend" }, ...this.entries());
  }

  show(): void {
    const { curves, x_range, y_range, log_x, log_y } = this.figure;
    const lines = curves.filter((it) => it.mark === "line").map((it) => ({ x: it.x, y: it.y, class: lineClass(it) }));
    const all = curves.map((it) => ({ x: it.x, y: it.y, class: "" }));
    const needed = XyPlot.around(all, { x: log_x, y: log_y });
    this.plot.show(lines, { x: x_range ?? needed.x, y: y_range ?? needed.y });
  }

  end(): void {
    this.plot.end();
  }

  /** A spot's mark, larger than others by so many pixels. */
  markAt(spot: Spot, larger = 0): SVGPathElement {
    return mark(spot.curve, this.plot.x(spot.x), this.plot.y(spot.y), larger);
  }

  /** The number of a cell in the figure, from the left and from below. */
  cellAt(column: number, row: number): number {
    const { x_edges, y_edges, upwards } = this.figure.cells;
    return upwards ? column * (y_edges.length - 1) + row : row * (x_edges.length - 1) + column;
  }

  /** Where it lies in the plot, with those above it where they are several. */
  cellBox(column: number, row: number, rows = 1): { x: number; y: number; width: number; height: number } {
    const { x_edges, y_edges } = this.figure.cells;
    const x = this.plot.x(x_edges[column] ?? NaN);
    const y = this.plot.y(y_edges[row + rows] ?? NaN);
    return {
      x,
      y,
      width: this.plot.x(x_edges[column + 1] ?? NaN) - x,
      height: this.plot.y(y_edges[row] ?? NaN) - y,
    };
  }

  private draw(): void {
    const { figure, plot } = this;
    const markers = [...this.levels(), ...figure.vertical.flatMap((it) => this.upright(it))];
    plot.ground.replaceChildren(...this.cells(), ...markers.map((it) => it.line));
    this.over.replaceChildren(...markers.map((it) => it.note));
    for (const curve of figure.curves) {
      if (curve.mark === "line" || curve.of.length > 0) continue;
      curve.x.forEach((x, i) => {
        const y = curve.y[i];
        if (this.within(x, "x") && this.within(y, "y")) this.over.append(mark(curve, plot.x(x), plot.y(y)));
      });
    }
    for (const it of figure.labels) this.over.append(...this.label(it));
  }

  private label({ x, y, text, left, text_x, text_y }: FigureLabel): SVGElement[] {
    const [from_x, from_y] = [this.plot.x(x), this.plot.y(y)];
    if (!finite(text_x) || !finite(text_y))
      return [note(text, from_x + (left ? -9 : 9), from_y + (left ? 20 : -9), left)];
    const [to_x, to_y] = [this.plot.x(text_x), this.plot.y(text_y)];
    return [
      drawn("line", { class: "leader", x1: from_x, y1: from_y, x2: to_x, y2: to_y }),
      note(text, to_x + (left ? -3 : 3), to_y + 4, left),
    ];
  }

  private within(value: number | null | undefined, axis: "x" | "y"): value is number {
    const [lower, upper] = this.plot.limits[axis];
    return finite(value) && value >= lower && value <= upper;
  }

  /** Cells of a kind as one path, those that lie on each other as one box. */
  private cells(): SVGElement[] {
    const { kinds, kind, x_edges, y_edges } = this.figure.cells;
    const paths = kinds.map((): string[] => []);
    for (let column = 0; column + 1 < x_edges.length; ++column) {
      for (let row = 0, end = 0; row + 1 < y_edges.length; row = end) {
        const own = kind[this.cellAt(column, row)];
        while (end + 1 < y_edges.length && kind[this.cellAt(column, end)] === own) ++end;
        const { x, y, width, height } = this.cellBox(column, row, end - row);
        paths[own ?? 0]?.push(`M${x} ${y}h${width}v${height}h${-width}Z`);
      }
    }
    return [this.patterns(), ...paths.map((it, k) => drawn("path", { d: it.join(""), fill: `url(#cells_${k})` }))];
  }

  /** Lines and dots: seen without colours too. */
  private patterns(): SVGDefsElement {
    const patterns = this.figure.cells.kinds.map(({ colour, dotted }, k) =>
      drawn(
        "pattern",
        { id: `cells_${k}`, class: colour, width: 12, height: 12, patternUnits: "userSpaceOnUse" },
        drawn("rect", { class: "fill", width: 12, height: 12 }),
        drawn("path", { class: "hatch", d: "M-2 10L10 -2M2 14L14 2" }),
        dotted ? drawn("circle", { class: "dot", cx: 6, cy: 6, r: 2.2 }) : null,
      ),
    );
    return drawn("defs", {}, ...patterns);
  }

  /** Lines across, each with its text above it, or below where another is near. */
  private levels(): DrawnMarker[] {
    const { plot } = this;
    const [left, right] = plot.limits.x.map((it) => plot.x(it)) as [number, number];
    const top = plot.y(plot.limits.y[1]);
    const shown = this.figure.horizontal.filter((it) => this.within(it.at, "y"));
    const heights = shown.map((it) => plot.y(it.at ?? NaN));
    return shown.map(({ label }, i) => {
      const y = heights[i] ?? NaN;
      const crowded = [top, ...heights].some((it) => it < y && y - it < 22);
      return {
        line: drawn("line", { class: "marker level", x1: left, x2: right, y1: y, y2: y }),
        note: note(label, right - 6, y + (crowded ? 18 : -6), true),
      };
    });
  }

  private upright({ at, label, label_after }: FigureMarker): DrawnMarker[] {
    if (!this.within(at, "x")) return [];
    const { plot } = this;
    const x = plot.x(at);
    const [bottom, top] = plot.limits.y.map((it) => plot.y(it)) as [number, number];
    return [
      {
        line: drawn("line", { class: "marker upright", x1: x, x2: x, y1: bottom, y2: top }),
        note: note(label, x + (label_after ? 6 : -6), bottom + 0.7 * (top - bottom), !label_after),
      },
    ];
  }

  private entries(): HTMLElement[] {
    const { curves, cells } = this.figure;
    const samples = cells.kinds.map((it, k) =>
      entry(drawn("rect", { class: "swatch", x: 1, y: 1, width: 32, height: 20, fill: `url(#cells_${k})` }), it.label),
    );
    for (const it of curves) {
      if (!it.label) continue;
      const nowhere = it.y.some((y, i) => finite(y) && finite(it.x[i])) ? "" : " (nowhere here)";
      const line = it.mark === "line";
      const sample = line ? drawn("path", { class: `curve ${lineClass(it)}`, d: "M1 11H33" }) : mark(it, 17, 11, 1);
      samples.push(entry(sample, it.label + nowhere));
    }
    return samples;
  }
}

function lineClass({ colour, dashed }: FigureCurve): string {
  return dashed ? `${colour} dashed` : colour;
}

function mark(curve: FigureCurve, x: number, y: number, larger = 0): SVGPathElement {
  const radius = 1.4 * curve.width + larger;
  const d = curve.mark === "crosses" ? crossPath(x, y, radius) : markPath(curve.colour, x, y, radius);
  return drawn("path", { class: `mark ${curve.mark} ${curve.colour}`, d });
}

function note(text: string, x: number, y: number, before: boolean): SVGTextElement {
  return drawn("text", { class: "note", x, y, "text-anchor": before ? "end" : "start" }, text);
}

function entry(sample: SVGElement, text: string): HTMLLIElement {
  const picture = drawn("svg", { viewBox: "0 0 34 22", width: 34, height: 22, "aria-hidden": "true" }, sample);
  return element("li", {}, picture, element("span", {}, text));
}
