import type { ChartFile, ChartPoint } from "../api/results";
import { drawn, element } from "../ui/dom";
import { plain, withUnit } from "../ui/numbers";
import { markShape } from "../ui/plot/draw";
import { Plot } from "../ui/plot/plot";
import { nodeOf } from "../ui/plot/shapes";
import { spotsOf, type Spot } from "../ui/plot/spots";
import { stabilityInWords } from "./names";

const reach = 14; // of a pointer

/** A chart's figure; a point opens its law. Arrow keys go from point to point. */
export class ChartPlot {
  readonly root: HTMLElement;
  private readonly plot: Plot;
  private readonly spots: readonly Spot[];
  private readonly readout = element(
    "p",
    { class: "readout", role: "status" },
    "Point at a mark, or go from mark to mark with the arrow keys. Enter opens its law.",
  );
  private readonly marks: SVGGElement[] = [];
  private current = 0; // in spots by error
  private opened = -1; // in the file
  private readonly byError: Spot[];
  private readonly byCost: Spot[];

  constructor(
    private readonly chart: ChartFile,
    private readonly open: (index: number) => void, // in the file
  ) {
    this.plot = new Plot(`Cost of a tick over error, ${chart.source}`, { ownArrows: true, redrawn: () => this.draw() });
    const spots = (this.spots = spotsOf(chart.figure));
    const { plot } = this;
    this.byError = [...spots].sort((a, b) => a.x - b.x || a.y - b.y);
    this.byCost = [...spots].sort((a, b) => a.y - b.y || a.x - b.x);
    this.root = plot.figure();
    this.root.classList.add("chart_plot");
    plot.reading.replaceWith(this.readout);
    // Marks lie on each other: the nearest is meant, and a second press means the one below it.
    plot.svg.addEventListener("pointermove", (event) => {
      const at = this.near(event)[0];
      if (at) this.tell(at, -1);
    });
    plot.svg.addEventListener("click", (event) => {
      const near = this.near(event);
      const next = near[(near.findIndex((it) => it.of === this.opened) + 1) % near.length];
      if (next) this.open(next.of);
    });
    plot.show(chart.figure);
  }

  end(): void {
    this.plot.end();
  }

  /** Marks the point whose law is open. */
  markOpened(index: number): void {
    this.opened = index;
    this.current = Math.max(
      0,
      this.byError.findIndex((it) => it.of === index),
    );
    this.plot.draw();
  }

  private draw(): void {
    const had_focus = this.marks.includes(document.activeElement as unknown as SVGGElement);
    this.marks.length = 0;
    this.byError.forEach((spot, place) => this.marks.push(this.mark(spot, place)));
    const on_top = (mark: SVGGElement): number =>
      Number(mark.classList.contains("on_front")) + 2 * Number(mark.classList.contains("opened"));
    this.plot.layer.replaceChildren(...[...this.marks].sort((a, b) => on_top(a) - on_top(b)));
    if (had_focus) this.marks[this.current]?.focus();
  }

  private mark(spot: Spot, place: number): SVGGElement {
    const { plot } = this;
    const [x, y] = [plot.x(spot.x), plot.y(spot.y)];
    const { on_front } = this.point(spot);
    return drawn(
      "g",
      {
        class: `point${on_front ? " on_front" : ""}${spot.of === this.opened ? " opened" : ""}`,
        role: "button",
        tabindex: place === this.current ? 0 : -1,
        "aria-label": pointInWords(this.point(spot), this.chart.force_unit),
        keydown: (event: KeyboardEvent) => this.key(event, spot),
        focus: () => this.tell(spot, place),
        // Of who presses it without a pointer.
        click: (event: MouseEvent) => {
          if (event.detail !== 0) return;
          event.stopPropagation();
          this.open(spot.of);
        },
      },
      drawn("circle", { class: "reach", cx: x, cy: y, r: 12 }),
      nodeOf(markShape(spot.curve, x, y, plot.drawing, on_front ? 2 : 0)),
    );
  }

  private point(spot: Spot): ChartPoint {
    return this.chart.points[spot.of]!;
  }

  /** The points about a pointer, nearest first; of those that lie together the front's. */
  private near(event: MouseEvent): Spot[] {
    const { plot, spots } = this;
    const pointer = plot.pointer(event);
    return spots
      .map((at) => ({ at, far: Math.hypot(plot.x(at.x) - pointer.x, plot.y(at.y) - pointer.y) }))
      .filter((it) => it.far <= reach)
      .sort(
        (a, b) =>
          Math.round((a.far - b.far) / 4) || Number(this.point(b.at).on_front) - Number(this.point(a.at).on_front),
      )
      .map((it) => it.at);
  }

  private tell(at: Spot, place: number): void {
    this.readout.textContent = pointInWords(this.point(at), this.chart.force_unit);
    if (place < 0 || place === this.current) return;
    this.marks[this.current]?.setAttribute("tabindex", "-1");
    this.current = place;
    this.marks[place]?.setAttribute("tabindex", "0");
  }

  /** Left and right by error, up and down by cost. */
  private key(event: KeyboardEvent, at: Spot): void {
    if (event.shiftKey) return;
    const along = { ArrowRight: this.byError, ArrowLeft: this.byError, ArrowUp: this.byCost, ArrowDown: this.byCost }[
      event.key
    ];
    if (along) {
      const step = event.key === "ArrowRight" || event.key === "ArrowUp" ? 1 : -1;
      const next = along[along.indexOf(at) + step];
      if (next) this.marks[this.byError.indexOf(next)]?.focus();
    } else if (event.key === "Enter" || event.key === " ") {
      this.open(at.of);
    } else {
      return;
    }
    event.preventDefault();
  }
}

/** One line of a point, for the read-out and for who hears it. */
function pointInWords(point: ChartPoint, unit = "N"): string {
  const cost = `${withUnit(1e-9 * (point.p50_ns ?? 0), "s")} a tick, 99.9 % within ${withUnit(1e-9 * (point.p999_ns ?? NaN), "s")}`;
  const error = `error ${withUnit(point.error_n, unit)} (${plain(point.error_jnd, 2)} JND)`;
  const stable = point.stable ? "" : `; stable: ${stabilityInWords(point)}`;
  const front = point.on_front ? "; on the front" : "";
  return `${point.law}, ${point.fidelity}: ${cost}; ${error}; ${point.parameters} parameters${front}${stable}`;
}
