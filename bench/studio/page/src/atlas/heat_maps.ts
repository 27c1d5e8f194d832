import type { SweepAnswer, SweepAxis } from "../api/sweeps";
import { element } from "../ui/dom";
import { onColours, palette } from "../ui/palette";
import { colourOf, stepsOf, type Steps } from "./colours";
import { withUnitOf } from "./question";
import {
  boxOf,
  indexOf,
  layoutOf,
  partInWords,
  partsOf,
  placeAt,
  shortName,
  tileInWords,
  titleHeight,
  withItsUnit,
  type Layout,
  type TilePlace,
} from "./tiles";

/** Heat maps of one question on a canvas; the tile under the pointer, or the one that arrow keys move to, in words. */
export class HeatMaps {
  readonly root: HTMLElement;
  readonly legend = element("div", { class: "heat_legend" });
  private readonly canvas = element("canvas", { tabindex: 0, role: "application", "aria-roledescription": "heat map" });
  private readonly words = element("output", { "aria-live": "polite" });
  private answer: SweepAnswer | null = null;
  private steps: Steps = { bounds: [], colours: [] };
  private layout: Layout | null = null;
  private at: TilePlace | null = null;
  private measure = "";
  private readonly observer = new ResizeObserver(() => this.draw());
  private readonly endColours = onColours(() => this.draw());

  constructor() {
    this.root = element("figure", { class: "heat_maps" }, this.canvas, this.words, this.legend);
    this.observer.observe(this.root);
    this.canvas.addEventListener("pointermove", (event) => this.point(event));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  end(): void {
    this.observer.disconnect();
    this.endColours();
  }

  show(answer: SweepAnswer, measure: string): void {
    this.answer = answer;
    this.measure = measure;
    const small = answer.value.every((it) => it === null || (it >= 0 && it <= 1));
    this.steps = stepsOf(answer.value, answer.unit === "1" && small);
    this.at = null;
    this.words.textContent = "";
    const axes = answer.axes.map((it) => withUnitOf(it.column, it.unit));
    this.canvas.setAttribute("aria-label", `${measure} over ${axes.join(", ")}; arrow keys go from tile to tile`);
    this.draw();
  }

  private point(event: PointerEvent): void {
    if (!this.answer || !this.layout) return;
    const box = this.canvas.getBoundingClientRect();
    this.choose(placeAt(this.answer, this.layout, event.clientX - box.left, event.clientY - box.top));
  }

  private key(event: KeyboardEvent): void {
    const { answer, layout } = this;
    const moves: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, 1],
      ArrowDown: [0, -1],
    };
    if (!answer || !layout) return;
    const [columns, rows] = [partsOf(answer.axes[0]), partsOf(answer.axes[1])];
    const now = this.at ?? { panel: 0, column: 0, row: 0 };
    if (event.key === "PageDown" || event.key === "PageUp") {
      const panel = now.panel + (event.key === "PageDown" ? 1 : -1);
      this.choose({ ...now, panel: Math.min(Math.max(panel, 0), layout.panels - 1) });
    } else {
      const move = moves[event.key];
      if (!move || event.ctrlKey || event.altKey || event.metaKey) return;
      const within = (value: number, count: number): number => Math.min(Math.max(value, 0), count - 1);
      const next = { ...now, column: within(now.column + move[0], columns), row: within(now.row + move[1], rows) };
      this.choose(this.at ? next : now);
    }
    event.preventDefault();
  }

  private choose(place: TilePlace | null): void {
    this.at = place;
    this.words.textContent = place && this.answer ? tileInWords(this.answer, place) : "";
    this.draw();
  }

  private draw(): void {
    const { answer, canvas } = this;
    const width = this.root.clientWidth;
    if (!answer || width < 100) return;
    const layout = (this.layout = layoutOf(answer, width));
    const scale = devicePixelRatio || 1;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(layout.height * scale);
    canvas.style.width = `${width}px`;
    canvas.style.height = `${layout.height}px`;
    const pen = canvas.getContext("2d");
    if (!pen) return;
    pen.scale(scale, scale);
    const font = getComputedStyle(this.root);
    pen.font = `${font.fontSize} ${font.fontFamily}`;
    for (let panel = 0; panel < layout.panels; ++panel) this.drawPanel(pen, answer, layout, panel);
    if (this.at) {
      const [x, y, w, h] = boxOf(answer, layout, this.at);
      pen.lineWidth = 4;
      pen.strokeStyle = palette().card;
      pen.strokeRect(x, y, w, h);
      pen.lineWidth = 2;
      pen.strokeStyle = palette().ink;
      pen.strokeRect(x, y, w, h);
    }
    this.drawLegend(answer);
  }

  private drawPanel(pen: CanvasRenderingContext2D, answer: SweepAnswer, layout: Layout, panel: number): void {
    const [columns, rows] = [partsOf(answer.axes[0]), partsOf(answer.axes[1])];
    for (let row = 0; row < rows; ++row)
      for (let column = 0; column < columns; ++column) this.drawTile(pen, answer, layout, { panel, column, row });
    const [left, lowest, tileWidth, tileHeight] = boxOf(answer, layout, { panel, column: 0, row: 0 });
    const bottom = lowest + tileHeight;
    const top = bottom - layout.panelHeight;
    const colours = palette();
    pen.lineWidth = 1;
    pen.strokeStyle = colours.line;
    pen.strokeRect(left, top, layout.panelWidth, layout.panelHeight);
    pen.fillStyle = colours.ink;
    pen.textAlign = "left";
    pen.textBaseline = "bottom";
    pen.fillText(titleOf(answer, panel), left, top - 3, layout.panelWidth);
    const isLowest = panel + layout.across >= layout.panels;
    if (isLowest) this.drawXAxis(pen, answer.axes[0], left, bottom, tileWidth, layout);
    if (panel % layout.across === 0 && answer.axes[1])
      this.drawYAxis(pen, answer.axes[1], left, bottom, tileHeight, layout);
  }

  private drawTile(pen: CanvasRenderingContext2D, answer: SweepAnswer, layout: Layout, place: TilePlace): void {
    const at = indexOf(answer, place);
    const [failed, missing] = [answer.failed[at] ?? 0, answer.missing[at] ?? 0];
    if ((answer.computed[at] ?? 0) + failed + missing === 0) return; // bare ground: no cell is there
    const [x, y, w, h] = boxOf(answer, layout, place);
    const colour = colourOf(this.steps, answer.value[at] ?? null);
    pen.fillStyle = colour ?? palette().grid;
    pen.fillRect(x, y, w + 0.5, h + 0.5);
    if (failed > 0) mark(pen, x + w / 2, y + h / 2, Math.min(w, h) / 4, "cross");
    if (missing > 0) mark(pen, x + w / 2, y + h / 2, Math.min(w, h) / 4, "ring");
  }

  private drawXAxis(
    pen: CanvasRenderingContext2D,
    axis: SweepAxis | undefined,
    left: number,
    bottom: number,
    tile: number,
    layout: Layout,
  ): void {
    if (!axis) return;
    const count = ticksOf(axis);
    const widest = Math.max(...Array.from({ length: count }, (_, i) => pen.measureText(tickOf(axis, i)).width));
    const stride = Math.max(1, Math.ceil((widest + 12) / tile));
    pen.textAlign = "center";
    pen.textBaseline = "top";
    for (let i = 0; i < count; i += stride) {
      const x = left + (i + (axis.names.length > 0 ? 0.5 : 0)) * tile;
      pen.fillRect(x - 0.5, bottom, 1, 4);
      // None that would reach into the panel beside.
      const half = pen.measureText(tickOf(axis, i)).width / 2;
      if (i === 0 || x + half < left + layout.panelWidth + 2) pen.fillText(tickOf(axis, i), x, bottom + 6);
    }
    pen.fillText(withUnitOf(axis.column, axis.unit), left + layout.panelWidth / 2, bottom + 26, layout.panelWidth);
  }

  private drawYAxis(
    pen: CanvasRenderingContext2D,
    axis: SweepAxis,
    left: number,
    bottom: number,
    tile: number,
    layout: Layout,
  ): void {
    const count = ticksOf(axis);
    const stride = Math.max(1, Math.ceil(18 / tile));
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (let i = 0; i < count; i += stride) {
      const y = bottom - (i + (axis.names.length > 0 ? 0.5 : 0)) * tile;
      pen.fillRect(left - 4, y - 0.5, 4, 1);
      pen.fillText(tickOf(axis, i), left - 6, y, layout.left - 26);
    }
    if (bottom - layout.panelHeight > layout.top + titleHeight + 1) return; // one name for all rows of panels
    const rows = Math.ceil(layout.panels / layout.across);
    const all = rows * layout.panelHeight + (rows - 1) * titleHeight;
    pen.save();
    pen.translate(10, bottom - layout.panelHeight + all / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    pen.fillText(withUnitOf(axis.column, axis.unit), 0, 0, all + titleHeight);
    pen.restore();
  }

  private drawLegend(answer: SweepAnswer): void {
    const swatch = (colour: string, text: string): HTMLElement => {
      const box = element("span", { class: "swatch", "aria-hidden": "true" });
      box.style.background = colour;
      return element("li", {}, box, text);
    };
    const number = (i: number): string => String(Number((this.steps.bounds[i] ?? 0).toPrecision(4)));
    const steps = this.steps.colours.map((colour, i) => swatch(colour, `${number(i)} to ${number(i + 1)}`));
    const marks: HTMLElement[] = [];
    const { all } = answer;
    if (all.failed > 0) marks.push(element("li", {}, `× cells failed: ${all.failed}`));
    if (all.missing > 0) marks.push(element("li", {}, `○ cells are missing: ${all.missing}`));
    if (all.computed > all.known) marks.push(element("li", {}, `without a number: ${all.computed - all.known}`));
    this.legend.replaceChildren(element("p", {}, this.measure), element("ul", { class: "steps" }, ...steps, ...marks));
  }
}

function titleOf(answer: SweepAnswer, panel: number): string {
  const columns = partsOf(answer.axes[2]);
  const [across, down] = [answer.axes[2], answer.axes[3]];
  const texts: string[] = [];
  if (across) texts.push(withItsUnit(`${across.column} ${partInWords(across, panel % columns)}`, across));
  if (down) texts.push(withItsUnit(`${down.column} ${partInWords(down, Math.floor(panel / columns))}`, down));
  return texts.join(", ");
}

function ticksOf(axis: SweepAxis): number {
  return axis.names.length > 0 ? axis.names.length : axis.edges.length;
}

function tickOf(axis: SweepAxis, i: number): string {
  if (axis.names.length === 0) return String(Number((axis.edges[i] ?? 0).toPrecision(3)));
  const value = axis.values[i];
  return value === null || value === undefined ? shortName(axis.names[i] ?? "") : String(Number(value.toPrecision(3)));
}

/** Black on white, so that it is seen on every colour. */
function mark(pen: CanvasRenderingContext2D, x: number, y: number, wanted: number, shape: "cross" | "ring"): void {
  const size = Math.min(Math.max(wanted, 1.5), 5);
  for (const [width, colour] of [
    [4, "#ffffff"],
    [1.6, "#000000"],
  ] as const) {
    pen.lineWidth = width;
    pen.strokeStyle = colour;
    pen.beginPath();
    if (shape === "ring") pen.arc(x, y, size, 0, 2 * Math.PI);
    else
      for (const side of [-1, 1]) {
        pen.moveTo(x - size, y - side * size);
        pen.lineTo(x + size, y + side * size);
      }
    pen.stroke();
  }
}
