import "./plot.css";

import { drawn, element } from "../dom";
import type { Figure, FigureCurve } from "../figure_description";
import { plain } from "../numbers";
import { onColours } from "../palette";
import { draw } from "./draw";
import { enlargeButton } from "./enlarge";
import { frameOf, limitsOf, outline, type Frame, type Limits } from "./frame";
import { gestures, pictureKey, type Along, type Movable, type Place } from "./gestures";
import { legendItems } from "./legend";
import { along, beside, first, nearest, placeOf, type Found } from "./nearest";
import { exportMenu } from "./out/export_menu";
import { valueAt } from "./scale";
import { nodeOf } from "./shapes";
import { screenStyle, type Style } from "./style";

export interface PlotOptions {
  /** Where a page moves things itself: it has the keys and the pointer. */
  still?: boolean;
  /** The arrow keys are the page's. */
  ownArrows?: boolean;
  /** The page has drawn its own after every redrawing. */
  redrawn?: () => void;
  /** Smaller letters, and nothing moves. */
  small?: boolean;
  left?: number; // of the axis, at least
  /** What the page draws itself and files have as well. */
  with?: () => FigureCurve[];
  file?: string; // what files of it are called, where the name is long
}

let made = 0;

/**
 * A figure on the screen: axes with units, zoomed and panned by pointer and keys, with a cursor that reads out points, a
 * legend and a menu that hands it out. Pages add their own in `layer`, by pixels: x() and y() and their inverses.
 */
export class Plot implements Movable {
  readonly svg: SVGSVGElement;
  readonly legend = element("ul", { class: "legend", "aria-label": "Legend" });
  readonly reading = element("p", { class: "plot_reading", "aria-live": "polite" });
  readonly layer = drawn("g", { class: "layer" });
  private readonly under = drawn("g", { class: "under" });
  private readonly axes = drawn("g", { class: "frame" });
  private readonly curves = drawn("g", { class: "curves" });
  private readonly over = drawn("g", { class: "over" });
  private readonly cursor = drawn("g", { class: "plot_cursor" });
  private readonly window = drawn("path", {});
  private readonly selection = drawn("rect", { class: "plot_select", visibility: "hidden" });
  private readonly observer: ResizeObserver;
  private readonly endColours: () => void;
  private own: Figure | null = null;
  private wanted: Limits = { x: [0, 1], y: [0, 1] }; // of all of it
  private shown: Limits = { x: [0, 1], y: [0, 1] };
  private found: Found | null = null;
  private size = { width: 640, height: 400 };
  private place: Frame;
  private style: Style = screenStyle();
  /** The clip path of the frame, for what a page draws beyond it. */
  readonly clip = `url(#plot_clip_${++made})`;

  constructor(
    readonly name: string,
    private readonly options: PlotOptions = {},
  ) {
    const id = this.clip.slice(5, -1);
    this.under.setAttribute("clip-path", this.clip);
    this.curves.setAttribute("clip-path", this.clip);
    const moves = !options.still && !options.small;
    this.svg = drawn(
      "svg",
      { class: "xy_plot", role: options.small ? "img" : "group", "aria-label": name },
      drawn("defs", {}, drawn("clipPath", { id }, this.window)),
      this.under,
      this.axes,
      this.curves,
      this.layer,
      this.over,
      this.cursor,
      this.selection,
    );
    this.place = frameOf(emptyFigure, this.shown, this.size.width, this.size.height, this.style);
    if (moves) this.takeHands();
    this.observer = new ResizeObserver((entries) => {
      const box = entries[entries.length - 1]?.contentRect;
      if (!box || box.width < 100 || box.height < 60) return;
      if (box.width === this.size.width && box.height === this.size.height) return;
      this.size = { width: box.width, height: box.height };
      this.draw();
    });
    this.observer.observe(this.svg);
    this.endColours = onColours(() => this.draw());
  }

  end(): void {
    this.observer.disconnect();
    this.endColours();
  }

  /** The plot with its title, menu, read-out and legend, for a page. */
  figure(title = ""): HTMLElement {
    return element(
      "figure",
      { class: "card figure" },
      element("div", { class: "plot_bar" }, element("figcaption", {}, title), this.reading, this.menu()),
      element("div", { class: "plot" }, this.svg),
      this.legend,
    );
  }

  /** Enlarges the figure, and hands it out as it is shown now. */
  menu(): HTMLElement {
    const out = exportMenu(() => ({ name: this.options.file ?? this.name, figures: this.handedOut() }));
    return this.options.small ? out : element("div", { class: "plot_tools" }, enlargeButton(), out);
  }

  private handedOut(): Figure[] {
    const { own, shown, options } = this;
    if (!own) return [];
    const curves = [...own.curves, ...(options.with?.() ?? [])];
    return [{ ...own, curves, x_range: [...shown.x], y_range: [...shown.y] }];
  }

  get described(): Figure | null {
    return this.own;
  }
  get frame(): Frame {
    return this.place;
  }
  get limits(): Limits {
    return this.shown;
  }

  /** What was zoomed stays, where the axes are of the same quantities. */
  show(figure: Figure, limits: Limits = limitsOf(figure)): void {
    const zoomed = this.isZoomed && this.own?.x_label === figure.x_label && this.own.y_label === figure.y_label;
    this.own = figure;
    this.wanted = limits;
    if (!zoomed) this.shown = limits;
    this.found = null;
    this.draw();
  }

  get isZoomed(): boolean {
    return this.own !== null && this.shown !== this.wanted;
  }

  x(value: number): number {
    return this.place.x.at(value);
  }
  y(value: number): number {
    return this.place.y.at(value);
  }
  xAt(pixel: number): number {
    return this.place.x.value(pixel);
  }
  yAt(pixel: number): number {
    return this.place.y.value(pixel);
  }
  /** Where a pointer is, in pixels of the plot. */
  pointer(event: MouseEvent): { x: number; y: number } {
    const box = this.svg.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }
  get drawing(): Style {
    return this.style;
  }

  draw(): void {
    const { own: figure, options } = this;
    const { width, height } = this.size;
    this.style = { ...screenStyle(), ...(options.small ? { text: 11, spacing: { x: 60, y: 32 } } : {}) };
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.style.setProperty("font-family", this.style.font);
    this.place = frameOf(figure ?? emptyFigure, this.shown, width, height, this.style, { left: options.left ?? 0 });
    this.window.setAttribute("d", outline(this.place));
    if (!figure) return;
    const { ground, axes, curves, over } = draw(figure, this.place, this.style);
    this.under.replaceChildren(...ground.map(nodeOf));
    this.axes.replaceChildren(...axes.map(nodeOf));
    this.curves.replaceChildren(...curves.map(nodeOf));
    this.over.replaceChildren(...over.map(nodeOf));
    this.legend.replaceChildren(...legendItems(figure, this.style));
    this.options.redrawn?.();
    this.drawCursor();
  }

  // Pointers and keys.

  readonly fixed = false;

  private takeHands(): void {
    this.svg.classList.add("moves");
    this.svg.setAttribute("tabindex", "0");
    if (!this.options.ownArrows) this.svg.setAttribute("role", "application");
    this.svg.setAttribute("aria-roledescription", "plot");
    const arrows = this.options.ownArrows ? "" : ", arrows read out points";
    const keys = `Plus and minus zoom, Shift and arrows move along, 0 shows all${arrows}.`;
    this.svg.setAttribute("aria-label", `${this.name}. ${keys}`);
    gestures(this.svg, this);
    this.svg.addEventListener("keydown", (event) => {
      if (event.target === this.svg || this.options.ownArrows) pictureKey(event, this, !this.options.ownArrows);
    });
  }

  box(): { left: number; top: number; width: number; height: number } {
    const { left, top } = this.svg.getBoundingClientRect();
    const { place } = this;
    return {
      left: left + place.left,
      top: top + place.top,
      width: place.right - place.left,
      height: place.bottom - place.top,
    };
  }

  takesWheel(): boolean {
    return this.svg.matches(":focus-within");
  }

  isTaken(event: PointerEvent): boolean {
    return event.target instanceof Element && event.target.closest("[role=button]") !== null;
  }

  private limit(of: "x" | "y", from: number, to: number): void {
    const logarithmic = this.place[of].logarithmic;
    const ends = [valueAt(this.shown[of], from, logarithmic), valueAt(this.shown[of], to, logarithmic)] as const;
    const all = this.wanted[of];
    const wide = logarithmic ? Math.log(ends[1] / ends[0]) : (ends[1] - ends[0]) / (all[1] - all[0]);
    if (!(wide > 1e-6 && wide < 1e3) || !ends.every(Number.isFinite)) return;
    this.shown = { ...this.shown, [of]: ends };
  }

  pan(right: number, up: number): void {
    this.limit("x", right, 1 + right);
    this.limit("y", up, 1 + up);
    this.draw();
  }

  zoom(factor: number, at: Place | null, axes: Along): void {
    const about = at ?? this.cursorPlace() ?? { x: 0.5, y: 0.5 };
    for (const of of ["x", "y"] as const)
      if (axes === "both" || axes === of)
        this.limit(of, about[of] * (1 - factor), about[of] + (1 - about[of]) * factor);
    this.draw();
  }

  showPart(from: Place, to: Place): void {
    for (const of of ["x", "y"] as const) this.limit(of, Math.min(from[of], to[of]), Math.max(from[of], to[of]));
    this.draw();
  }

  whole(): void {
    this.shown = this.wanted;
    this.draw();
  }

  selecting(from: Place | null, to: Place | null): void {
    this.selection.setAttribute("visibility", from && to ? "visible" : "hidden");
    if (!from || !to) return;
    const { left, right, top, bottom } = this.place;
    const within = (share: number): number => Math.min(1, Math.max(0, share));
    const [x, x2] = [from.x, to.x]
      .map(within)
      .sort((a, b) => a - b)
      .map((it) => left + it * (right - left)) as [number, number];
    const [y, y2] = [from.y, to.y]
      .map(within)
      .sort((a, b) => b - a)
      .map((it) => bottom - it * (bottom - top)) as [number, number];
    for (const [name, value] of Object.entries({ x, y, width: x2 - x, height: y2 - y }))
      this.selection.setAttribute(name, String(value));
  }

  // The cursor.

  point(at: Place | null): void {
    const { own: figure, place } = this;
    if (!figure) return;
    const x = place.left + (at?.x ?? 0) * (place.right - place.left);
    const y = place.bottom - (at?.y ?? 0) * (place.bottom - place.top);
    this.found = at ? nearest(figure, place, x, y, 28) : null;
    this.drawCursor(at && !this.found ? { x: place.x.value(x), y: place.y.value(y) } : null);
  }

  step(to: "left" | "right" | "up" | "down" | "begin" | "end"): void {
    const { own: figure, place } = this;
    if (!figure) return;
    const from = this.found ?? first(figure, place);
    if (!from) return;
    if (!this.found) this.found = from;
    else if (to === "left" || to === "right") this.found = along(place, from, to === "right" ? 1 : -1);
    else if (to === "up" || to === "down") this.found = beside(figure, place, from, to === "down" ? 1 : -1);
    else this.found = { curve: from.curve, at: to === "begin" ? 0 : from.curve.x.length - 1 };
    this.drawCursor();
  }

  private cursorPlace(): Place | null {
    const at = this.found && placeOf(this.place, this.found);
    if (!at) return null;
    const { left, right, top, bottom } = this.place;
    return { x: (at.x - left) / (right - left), y: (bottom - at.y) / (bottom - top) };
  }

  private drawCursor(free: { x: number; y: number } | null = null): void {
    const at = this.found && placeOf(this.place, this.found);
    const { left, right, top, bottom } = this.place;
    this.cursor.replaceChildren(
      ...(at
        ? [
            drawn("path", { class: "cross", d: `M${at.x} ${top}V${bottom}M${left} ${at.y}H${right}` }),
            drawn("circle", { cx: at.x, cy: at.y, r: 5 }),
          ]
        : []),
    );
    const text = this.found ? this.inWords(this.found) : free ? this.pair(free.x, free.y) : "";
    if (this.reading.textContent !== text) this.reading.textContent = text;
  }

  private inWords({ curve, at }: Found): string {
    const label = curve.label || curve.name || "";
    return `${label ? `${label}: ` : ""}${this.pair(curve.x[at]!, curve.y[at]!)}`;
  }

  private pair(x: number, y: number): string {
    const { x_label = "", y_label = "" } = this.own ?? {};
    return `${withItsUnit(x_label, x)}, ${withItsUnit(y_label, y)}`;
  }
}

const emptyFigure: Figure = {
  x_label: "",
  y_label: "",
  curves: [],
  cells: { x_edges: [], y_edges: [], upwards: false, kinds: [], kind: [] },
  vertical: [],
  horizontal: [],
  labels: [],
  x_range: null,
  y_range: null,
  log_x: false,
  log_y: false,
};

/** "force [N]" and 1.2: "force 1.2 N". */
export function withItsUnit(label: string, value: number): string {
  const [, name = label, unit = ""] = /^(.*?)\s*\[(.*)\]/.exec(label) ?? [];
  return `${name} ${plain(value, 4)}${unit && unit !== "1" ? ` ${unit}` : ""}`;
}
