import { drawn, element } from "../ui/dom";
import { XyPlot } from "../ui/xy_plot";
import { pointInWords } from "./chart_points";
import type { PlacedChart, PlacedPoint } from "./chart_points";
import { markClass, markPath, markSample } from "./marks";

const radius = 7;
const reach = 14; // of a pointer

/** Cost of a tick over error, both logarithmic; a point opens its law. Arrow keys go from point to point. */
export class ChartPlot {
  readonly root: HTMLElement;
  private readonly plot: XyPlot;
  private readonly readout = element(
    "p",
    { class: "readout", role: "status" },
    "Point at a mark, or go from mark to mark with the arrow keys. Enter opens its law.",
  );
  private readonly marks: SVGGElement[] = [];
  private current = 0; // in points by error
  private opened = -1; // in the file
  private readonly byError: PlacedPoint[];
  private readonly byCost: PlacedPoint[];

  constructor(
    private readonly chart: PlacedChart,
    private readonly open: (at: PlacedPoint) => void,
  ) {
    this.byError = [...chart.points].sort((a, b) => a.error - b.error || a.cost_us - b.cost_us);
    this.byCost = [...chart.points].sort((a, b) => a.cost_us - b.cost_us || a.error - b.error);
    this.plot = new XyPlot(
      { label: `error, root mean square [${chart.unit}]`, logarithmic: true },
      { label: "cost of a tick, median [µs]", logarithmic: true },
      `Cost of a tick over error, ${chart.points.length} points`,
      () => this.draw(),
    );
    this.root = element(
      "figure",
      { class: "card chart_plot" },
      element("div", { class: "plot tall" }, this.plot.svg),
      this.readout,
      this.legend(),
    );
    // Marks lie on each other: the nearest is meant, and a second press means the one below it.
    const { svg } = this.plot;
    svg.addEventListener("pointermove", (event) => {
      const at = this.near(event)[0];
      if (at) this.tell(at, -1);
    });
    svg.addEventListener("click", (event) => {
      const near = this.near(event);
      const next = near[(near.findIndex((it) => it.index === this.opened) + 1) % near.length];
      if (next) this.open(next);
    });
    this.plot.show([], chart.limits());
  }

  end(): void {
    this.plot.end();
  }

  /** Marks the point whose law is open. */
  markOpened(index: number): void {
    this.opened = index;
    this.current = this.byError.findIndex((it) => it.index === index);
    this.draw();
  }

  private legend(): HTMLElement {
    const entry = (sample: Element, text: string): HTMLLIElement =>
      element("li", {}, sample, element("span", {}, text));
    const line = (kind: string): SVGSVGElement =>
      drawn(
        "svg",
        { class: "sample", viewBox: "0 0 30 22", width: 30, height: 22, "aria-hidden": "true" },
        drawn("line", { class: kind, x1: 1, x2: 29, y1: 11, y2: 11 }),
      );
    const cross = drawn(
      "svg",
      { class: "sample", viewBox: "0 0 22 22", width: 22, height: 22, "aria-hidden": "true" },
      drawn("path", { class: "cross", d: crossPath(11, 11) }),
    );
    return element(
      "ul",
      { class: "legend", "aria-label": "Legend" },
      ...this.chart.laws.map((law, i) => entry(markSample(i), law)),
      entry(cross, "not stable"),
      entry(line("stairs"), "front"),
      entry(line("jnd_line"), "JND"),
      entry(line("tick_line"), "a tick, and half of it"),
    );
  }

  private draw(): void {
    const { plot, chart } = this;
    const [left, right] = plot.limits.x;
    const [bottom, top] = plot.limits.y;
    const horizontal = (us: number, text: string, below: number): SVGElement[] => [
      drawn("line", { class: "tick_line", x1: plot.x(left), x2: plot.x(right), y1: plot.y(us), y2: plot.y(us) }),
      drawn("text", { class: "line_label", x: plot.x(right) - 6, y: plot.y(us) + below, "text-anchor": "end" }, text),
    ];
    plot.ground.replaceChildren(
      ...horizontal(chart.tick_us, `a tick at ${Math.round(chart.file.rate_hz)} Hz`, -6),
      ...horizontal(chart.tick_us / 2, "half of it", 18),
      drawn("line", {
        class: "jnd_line",
        x1: plot.x(chart.jnd),
        x2: plot.x(chart.jnd),
        y1: plot.y(bottom),
        y2: plot.y(top),
      }),
      drawn("text", { class: "line_label", x: plot.x(chart.jnd) + 6, y: plot.y(bottom) - 8 }, "JND"),
      drawn("path", { class: "stairs", d: this.stairs() }),
    );
    const had_focus = this.marks.includes(document.activeElement as unknown as SVGGElement);
    this.marks.length = 0;
    this.byError.forEach((at, place) => this.marks.push(this.mark(at, place)));
    const on_top = (mark: SVGGElement): number =>
      Number(mark.classList.contains("on_front")) + 2 * Number(mark.classList.contains("opened"));
    plot.layer.replaceChildren(...[...this.marks].sort((a, b) => on_top(a) - on_top(b)));
    if (had_focus) this.marks[this.current]?.focus();
  }

  private stairs(): string {
    const { plot } = this;
    const front = this.chart.front();
    let x = plot.x(plot.limits.x[1]);
    let path = "";
    for (const at of front) {
      const y = plot.y(at.cost_us);
      path += `${path ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}L${plot.x(at.error).toFixed(1)} ${y.toFixed(1)}`;
      x = plot.x(at.error);
    }
    return path && `${path}L${x.toFixed(1)} ${plot.y(plot.limits.y[1]).toFixed(1)}`;
  }

  private mark(at: PlacedPoint, place: number): SVGGElement {
    const x = this.plot.x(at.error);
    const y = this.plot.y(at.cost_us);
    const mark = drawn(
      "g",
      {
        class: `point${at.point.on_front ? " on_front" : ""}${at.index === this.opened ? " opened" : ""}`,
        role: "button",
        tabindex: place === this.current ? 0 : -1,
        "aria-label": pointInWords(at),
        keydown: (event: KeyboardEvent) => this.key(event, at),
        focus: () => this.tell(at, place),
        // Of who presses it without a pointer.
        click: (event: MouseEvent) => {
          if (event.detail !== 0) return;
          event.stopPropagation();
          this.open(at);
        },
      },
      drawn("circle", { class: "reach", cx: x, cy: y, r: 12 }),
      drawn("path", {
        class: markClass(at.law),
        d: markPath(at.law, x, y, at.point.on_front ? radius + 1 : radius - 1),
      }),
    );
    if (!at.point.stable) mark.append(drawn("path", { class: "cross", d: crossPath(x, y) }));
    return mark;
  }

  /** The points about a pointer, nearest first; of those that lie together the front's. */
  private near(event: MouseEvent): PlacedPoint[] {
    const pointer = this.plot.pointer(event);
    return this.chart.points
      .map((at) => ({ at, far: Math.hypot(this.plot.x(at.error) - pointer.x, this.plot.y(at.cost_us) - pointer.y) }))
      .filter((it) => it.far <= reach)
      .sort((a, b) => Math.round((a.far - b.far) / 4) || Number(b.at.point.on_front) - Number(a.at.point.on_front))
      .map((it) => it.at);
  }

  private tell(at: PlacedPoint, place: number): void {
    this.readout.textContent = pointInWords(at);
    if (place < 0 || place === this.current) return;
    this.marks[this.current]?.setAttribute("tabindex", "-1");
    this.current = place;
    this.marks[place]?.setAttribute("tabindex", "0");
  }

  /** Left and right by error, up and down by cost. */
  private key(event: KeyboardEvent, at: PlacedPoint): void {
    const along = { ArrowRight: this.byError, ArrowLeft: this.byError, ArrowUp: this.byCost, ArrowDown: this.byCost }[
      event.key
    ];
    if (along) {
      const step = event.key === "ArrowRight" || event.key === "ArrowUp" ? 1 : -1;
      const next = along[along.indexOf(at) + step];
      if (next) this.marks[this.byError.indexOf(next)]?.focus();
    } else if (event.key === "Enter" || event.key === " ") {
      this.open(at);
    } else {
      return;
    }
    event.preventDefault();
  }
}

function crossPath(x: number, y: number): string {
  const r = radius + 2;
  return `M${x - r} ${y - r}L${x + r} ${y + r}M${x - r} ${y + r}L${x + r} ${y - r}`;
}
