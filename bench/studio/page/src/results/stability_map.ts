import { drawn, element } from "../ui/dom";
import { XyPlot } from "../ui/xy_plot";
import { cellInWords, edgesOf } from "./map_model";
import type { MapCell, MapModel } from "./map_model";

type Kind = "stable" | "unstable" | "stable_otherwise" | "unstable_otherwise";

function kindOf(cell: MapCell | undefined): Kind {
  if (!cell) return "unstable";
  if (cell.stable === cell.theory) return cell.stable ? "stable" : "unstable";
  return cell.stable ? "stable_otherwise" : "unstable_otherwise";
}

/** Lines for what is not stable, dots where theory says otherwise: seen without colours too. */
function patterns(): SVGDefsElement {
  const of = (kind: Kind, ...marks: SVGElement[]): SVGPatternElement =>
    drawn(
      "pattern",
      { id: `map_${kind}`, class: kind, width: 12, height: 12, patternUnits: "userSpaceOnUse" },
      drawn("rect", { class: "fill", width: 12, height: 12 }),
      ...marks,
    );
  const lines = (): SVGElement => drawn("path", { class: "hatch", d: "M-2 10L10 -2M2 14L14 2" });
  const dot = (): SVGElement => drawn("circle", { class: "dot", cx: 6, cy: 6, r: 2.2 });
  return drawn(
    "defs",
    {},
    of("stable"),
    of("unstable", lines()),
    of("stable_otherwise", dot()),
    of("unstable_otherwise", lines(), dot()),
  );
}

/** Cells, boundaries and the device's own lines; the cell under the cursor, or that the arrow keys lead to, is read out. */
export class StabilityMap {
  readonly root: HTMLElement;
  private readonly plot: XyPlot;
  private readonly readout = element(
    "p",
    { class: "readout", role: "status" },
    "Point at a cell, or go from cell to cell with the arrow keys.",
  );
  private readonly cursor = drawn("rect", { class: "cursor" });
  private readonly x_edges: number[];
  private readonly y_edges: number[];
  private row = -1;
  private column = -1;

  constructor(
    private readonly map: MapModel,
    name: string,
  ) {
    this.x_edges = edgesOf(map.x.values, map.x.axis.logarithmic ?? false);
    this.y_edges = edgesOf(map.y.values, map.y.axis.logarithmic ?? false);
    this.plot = new XyPlot(map.x.axis, map.y.axis, name, () => this.draw());
    const svg = this.plot.svg;
    svg.setAttribute("tabindex", "0");
    svg.setAttribute("role", "application");
    svg.setAttribute("aria-roledescription", "map; arrow keys go from cell to cell");
    svg.addEventListener("pointermove", (event) => this.under(event));
    svg.addEventListener("keydown", (event) => this.key(event));
    this.root = element(
      "figure",
      { class: "card map" },
      element("div", { class: "plot tall" }, svg),
      this.readout,
      this.legend(),
    );
    const first = (of: number[]): number => of[0] ?? 0;
    const last = (of: number[]): number => of[of.length - 1] ?? 1;
    this.plot.show(map.boundaries, {
      x: [first(this.x_edges), last(this.x_edges)],
      y: [first(this.y_edges), last(this.y_edges)],
    });
  }

  end(): void {
    this.plot.end();
  }

  private legend(): HTMLElement {
    const sample = (...inside: SVGElement[]): SVGSVGElement =>
      drawn("svg", { class: "sample", viewBox: "0 0 34 22", width: 34, height: 22, "aria-hidden": "true" }, ...inside);
    const cell = (kind: Kind): SVGSVGElement =>
      sample(drawn("rect", { x: 1, y: 1, width: 32, height: 20, fill: `url(#map_${kind})`, class: "swatch" }));
    const line = (kind: string): SVGSVGElement => sample(drawn("line", { class: kind, x1: 1, x2: 33, y1: 11, y2: 11 }));
    const { stable, unstable } = this.map.words;
    const entries: [SVGSVGElement, string][] = [
      [cell("stable"), stable],
      [cell("unstable"), unstable],
      [cell("stable_otherwise"), `${stable}, theory says otherwise`],
      [cell("unstable_otherwise"), `${unstable}, theory says otherwise`],
      ...this.map.boundaries.map((it): [SVGSVGElement, string] => [line(`curve ${it.class}`), it.label]),
      ...this.map.device.map((it): [SVGSVGElement, string] => [
        line(it.x === undefined ? "own level" : "own upright"),
        it.label,
      ]),
    ];
    return element(
      "ul",
      { class: "legend xy_plot_colours", "aria-label": "Legend" },
      ...entries.map(([mark, text]) => element("li", {}, mark, element("span", {}, text))),
    );
  }

  private draw(): void {
    const { plot } = this;
    const cells: SVGElement[] = [patterns()];
    this.map.cells.forEach((row, at) => cells.push(...this.runs(row, at)));
    plot.ground.replaceChildren(...cells);
    plot.layer.replaceChildren(...this.deviceLines(), this.cursor);
    this.showCursor();
  }

  private box(row: number, from: number, to: number): { x: number; y: number; width: number; height: number } {
    const { plot } = this;
    const left = plot.x(this.x_edges[from] ?? 0);
    const right = plot.x(this.x_edges[to] ?? 0);
    const top = plot.y(this.y_edges[row + 1] ?? 0);
    const bottom = plot.y(this.y_edges[row] ?? 0);
    return { x: left, y: top, width: right - left, height: bottom - top };
  }

  /** A row as boxes, runs of equal cells as one. */
  private runs(row: readonly MapCell[], at: number): SVGElement[] {
    const boxes: SVGElement[] = [];
    for (let begin = 0; begin < row.length; ) {
      const kind = kindOf(row[begin]);
      let end = begin + 1;
      while (end < row.length && kindOf(row[end]) === kind) ++end;
      boxes.push(drawn("rect", { ...this.box(at, begin, end), fill: `url(#map_${kind})` }));
      begin = end;
    }
    return boxes;
  }

  private deviceLines(): SVGElement[] {
    const { plot } = this;
    const [left, right] = plot.limits.x;
    const [bottom, top] = plot.limits.y;
    return this.map.device.flatMap((it): SVGElement[] => {
      if (it.y !== undefined && it.y > bottom && it.y < top)
        return [
          drawn("line", {
            class: "own level",
            x1: plot.x(left),
            x2: plot.x(right),
            y1: plot.y(it.y),
            y2: plot.y(it.y),
          }),
        ];
      if (it.x !== undefined && it.x > left && it.x < right)
        return [
          drawn("line", {
            class: "own upright",
            x1: plot.x(it.x),
            x2: plot.x(it.x),
            y1: plot.y(bottom),
            y2: plot.y(top),
          }),
        ];
      return [];
    });
  }

  private under(event: PointerEvent): void {
    const at = this.plot.pointer(event);
    const x = this.plot.xAt(at.x);
    const y = this.plot.yAt(at.y);
    const place = (value: number, edges: readonly number[]): number =>
      edges.findIndex((edge, i) => value >= edge && value <= (edges[i + 1] ?? -Infinity));
    const column = place(x, this.x_edges);
    const row = place(y, this.y_edges);
    if (column >= 0 && row >= 0) this.go(row, column);
  }

  private key(event: KeyboardEvent): void {
    const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] }[event.key];
    if (!step) return;
    event.preventDefault();
    const rows = this.map.y.values.length;
    const columns = this.map.x.values.length;
    if (this.row < 0) return this.go(Math.floor(rows / 2), Math.floor(columns / 2));
    this.go(
      Math.min(rows - 1, Math.max(0, this.row + (step[0] ?? 0))),
      Math.min(columns - 1, Math.max(0, this.column + (step[1] ?? 0))),
    );
  }

  private go(row: number, column: number): void {
    if (row === this.row && column === this.column) return;
    this.row = row;
    this.column = column;
    this.readout.textContent = cellInWords(this.map, row, column);
    this.showCursor();
  }

  private showCursor(): void {
    if (this.row < 0) return this.cursor.setAttribute("width", "0");
    for (const [name, value] of Object.entries(this.box(this.row, this.column, this.column + 1)))
      this.cursor.setAttribute(name, String(value));
  }
}
