import type { SweepColumn, SweepFilter, SweepSample } from "../../api/sweeps";
import { drawn, element } from "../../ui/dom";
import { onColours, palette } from "../../ui/palette";
import { colourOf, rangeOfLines, stepsOf } from "../colours";
import { withUnitOf } from "../question";
import { brush } from "./brush";
import { Scale } from "./scale";

const margin = { top: 48, bottom: 34, left: 34, right: 76 };
const height = 340;

/** Parallel coordinates: a line a cell on a canvas, axes that can be brushed over it. */
export class ParallelPlot {
  readonly root: HTMLElement;
  private readonly canvas = element("canvas", { "aria-hidden": "true" });
  private readonly svg = drawn("svg", { role: "img" });
  private readonly words = element("p", { class: "quiet" });
  private scales: Scale[] = [];
  private sample: SweepSample | null = null;
  private behind: SweepSample | null = null;
  private where: Record<string, SweepFilter> = {};
  private readonly observer = new ResizeObserver(() => this.draw());
  private readonly endColours = onColours(() => this.draw());

  constructor(private readonly brushed: (column: string, filter: SweepFilter | null) => void) {
    this.root = element(
      "figure",
      { class: "parallel" },
      element("div", { class: "parallel_plot" }, this.canvas, this.svg),
      this.words,
    );
    this.observer.observe(this.root);
  }

  end(): void {
    this.observer.disconnect();
    this.endColours();
  }

  /** Cells of `sample` before those of `behind`, which no filter keeps out. The last column gives the colour. */
  show(
    sample: SweepSample,
    behind: SweepSample,
    columns: readonly SweepColumn[],
    where: Record<string, SweepFilter>,
  ): void {
    this.sample = sample;
    this.behind = behind;
    this.where = where;
    this.scales = columns.map((column, i) => new Scale(column, behind.values[i] ?? []));
    const names = columns.map((it) => withUnitOf(it.name, it.unit));
    const last = sample.columns[sample.columns.length - 1] ?? "";
    this.svg.setAttribute("aria-label", `Parallel coordinates of ${names.join(", ")}, in the colour of ${last}`);
    const counts = `${sample.state.length} of ${sample.of} cells, taken by chance, a line each, in the colour of ${last}.`;
    this.words.textContent =
      `${counts} At "?" below an axis: no number; dashed: the cell failed or is missing. ` +
      "Drag along an axis to filter; Filters below does the same by hand.";
    this.draw();
  }

  private draw(): void {
    const width = this.root.clientWidth;
    const { sample, canvas } = this;
    if (!sample || width < 200 || this.scales.length < 2) return;
    const ratio = devicePixelRatio || 1;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const pen = canvas.getContext("2d");
    if (!pen) return;
    pen.scale(ratio, ratio);
    if (this.behind !== sample && this.behind) this.drawLines(pen, this.behind, width, true);
    this.drawLines(pen, sample, width, false);
    this.svg.replaceChildren(...this.scales.map((scale, i) => this.axis(scale, this.x(i, width))));
  }

  private x(axis: number, width: number): number {
    return margin.left + (axis * (width - margin.left - margin.right)) / (this.scales.length - 1);
  }
  private y(place: number | null): number {
    return place === null ? height - 8 : margin.top + (1 - place) * (height - margin.top - margin.bottom);
  }

  private drawLines(pen: CanvasRenderingContext2D, sample: SweepSample, width: number, faint: boolean): void {
    const colours = sample.values[sample.values.length - 1] ?? [];
    const steps = stepsOf(this.behind?.values[sample.values.length - 1] ?? colours, false, rangeOfLines());
    pen.lineWidth = 1;
    for (let cell = 0; cell < sample.state.length; ++cell) {
      const failed = sample.state[cell] !== "";
      const colour = failed ? null : colourOf(steps, colours[cell] ?? null);
      pen.strokeStyle = faint ? palette().grid : (colour ?? palette().soft);
      pen.globalAlpha = faint ? 0.5 : sample.state.length > 500 ? 0.45 : 0.75;
      pen.setLineDash(colour === null ? [4, 3] : []);
      pen.beginPath();
      this.scales.forEach((scale, i) => {
        const at = this.y(scale.place(sample.values[i]?.[cell] ?? null));
        if (i === 0) pen.moveTo(this.x(i, width), at);
        else pen.lineTo(this.x(i, width), at);
      });
      pen.stroke();
    }
  }

  private axis(scale: Scale, x: number): SVGGElement {
    const place = this.scales.indexOf(scale);
    const bottom = this.y(0);
    const anchor = place === 0 ? "start" : place === this.scales.length - 1 ? "end" : "middle";
    const shift = anchor === "start" ? -margin.left : anchor === "end" ? margin.right : 0;
    const name = withUnitOf(scale.column.name, scale.column.unit);
    const ticks = scale.ticks().map((tick) => {
      const text = drawn("text", { class: "tick", x: x + 8, y: this.y(tick.at) + 4 }, tick.text);
      return text;
    });
    return drawn(
      "g",
      {},
      drawn("line", { class: "axis", x1: x, x2: x, y1: margin.top, y2: bottom }),
      // By turns higher and lower, so that long names do not meet.
      drawn("text", { class: "name", x: x + shift, y: place % 2 === 0 ? 34 : 16, "text-anchor": anchor }, name),
      ...ticks,
      drawn("text", { class: "tick", x: x + 8, y: this.y(null) + 4 }, "?"),
      drawn(
        "g",
        { class: "brush", transform: `translate(${x} ${margin.top})`, "data-axis": scale.column.name },
        ...this.brush(scale),
      ),
    );
  }

  /** Filters the cells by a stretch of the axis. */
  private brush(scale: Scale): readonly SVGRectElement[] {
    const along = height - margin.top - margin.bottom;
    const { name } = scale.column;
    const filter = this.where[name];
    const stretch = filter ? scale.stretch(filter) : null;
    return brush(along, stretch && [(1 - stretch[1]) * along, (1 - stretch[0]) * along], (to) =>
      this.brushed(name, to && scale.filter(1 - to[1] / along, 1 - to[0] / along)),
    );
  }
}
