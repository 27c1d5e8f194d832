import type { LawError } from "../api/editor";
import type { Loops } from "../api/recordings";
import { drawn } from "../ui/dom";
import { figureOf, type FigureCurve } from "../ui/figure_description";
import { plain } from "../ui/numbers";
import { linePath } from "../ui/plot/draw";
import { Plot } from "../ui/plot/plot";
import type { Limits } from "../ui/plot/frame";
import type { Range } from "../ui/plot/scale";
import type { Drawing } from "./drawing";
import { branchesOf } from "./error";
import { Handles } from "./handles";
import { forceAt, type Spot } from "./knots";
import { averages, cycles, jndBands, lawCurves, lawLine, limitsFor } from "./lines";
import { inUnits } from "./scale";

/** The plot that is drawn on: averages and law, breakpoints, the worst place, and a cursor for the keyboard. */
export class Canvas {
  readonly plot: Plot;
  readonly handles: Handles;
  /** Where the keyboard's cursor is, in the units of the plot; shown while the plot itself has the focus. */
  cursor: { x: number; y: number };
  private worst: LawError | null = null;
  private single: FigureCurve[] = [];
  private isFitted = false;
  private readonly below = drawn("g", { class: "law" });
  private readonly above = drawn("g", { class: "marks" });

  constructor(private readonly drawing: Drawing) {
    const { curve } = drawing;
    this.plot = new Plot("Averaged cycle and drawn law", {
      still: true,
      redrawn: () => this.draw(),
      with: () => lawCurves(drawing),
    });
    this.below.setAttribute("clip-path", this.plot.clip);
    this.handles = new Handles(drawing, this.plot);
    this.plot.svg.setAttribute("role", "application");
    this.plot.svg.setAttribute("tabindex", "0");
    this.plot.layer.append(this.below, this.above, this.handles.group);
    this.cursor = this.fromSpot(
      this.onLaw(0.5 * (curve.penetration[0]! + curve.penetration[curve.penetration.length - 1]!)),
    );
    this.fit();
  }

  end(): void {
    this.plot.end();
  }

  /** Wider limits where the breakpoints need them; not while one is dragged. */
  fit(): void {
    const wanted = limitsFor(this.drawing.curve, this.drawing.knots, this.drawing);
    if (this.isFitted) {
      const { x, y } = this.plot.limits;
      const grown = (old: Range, now: Range): Range => [Math.min(old[0], now[0]), Math.max(old[1], now[1])];
      wanted.x = grown(x, wanted.x);
      wanted.y = grown(y, wanted.y);
    }
    this.isFitted = true;
    this.show(wanted);
  }

  showCycles(loops: Loops | null): void {
    this.single = loops ? cycles(this.drawing, loops) : [];
    this.show(this.plot.limits);
  }

  private show(limits: Limits): void {
    const { curve, position, force } = this.drawing;
    const x = `penetration along ${curve.axis} [${position.unit}]`;
    const curves = [...this.single, ...averages(this.drawing)];
    this.plot.show(figureOf(x, `resisting force [${force.unit}]`, { curves }), limits);
  }

  showWorst(error: LawError | null): void {
    this.worst = error;
    this.draw();
  }

  /** A place of the plot in pixels, within its frame, as a breakpoint. */
  spotAt(pixel: { x: number; y: number }): Spot {
    const { position, force, branch } = this.drawing;
    const at = this.within({ x: this.plot.xAt(pixel.x), y: this.plot.yAt(pixel.y) });
    return { penetration: at.x / position.perUnit, force: at.y / force.perUnit, branch };
  }
  isInFrame(pixel: { x: number; y: number }): boolean {
    const at = { x: this.plot.xAt(pixel.x), y: this.plot.yAt(pixel.y) };
    const inside = this.within(at);
    return inside.x === at.x && inside.y === at.y;
  }
  within(at: { x: number; y: number }): { x: number; y: number } {
    const { x, y } = this.plot.limits;
    return { x: Math.max(x[0], Math.min(x[1], at.x)), y: Math.max(y[0], Math.min(y[1], at.y)) };
  }
  /** One pixel, in the units of the plot. */
  get pixel(): { x: number; y: number } {
    return { x: this.plot.xAt(1) - this.plot.xAt(0), y: this.plot.yAt(0) - this.plot.yAt(1) };
  }
  cursorSpot(): Spot {
    const { position, force, branch } = this.drawing;
    return { penetration: this.cursor.x / position.perUnit, force: this.cursor.y / force.perUnit, branch };
  }
  /** Puts the cursor on the law, at its penetration. */
  cursorOnLaw(): void {
    this.cursor = this.fromSpot(this.onLaw(this.cursor.x / this.drawing.position.perUnit));
  }
  private onLaw(penetration: number): Spot {
    const { knots, branch } = this.drawing;
    return { penetration, force: forceAt(knots, branch, penetration), branch };
  }
  private fromSpot(spot: Spot): { x: number; y: number } {
    return { x: spot.penetration * this.drawing.position.perUnit, y: spot.force * this.drawing.force.perUnit };
  }

  draw(): void {
    const { plot } = this;
    const left = plot.x(plot.limits.x[0]);
    const top = plot.y(plot.limits.y[1]);
    const sides = { x: left, y: top, width: plot.x(plot.limits.x[1]) - left, height: plot.y(plot.limits.y[0]) - top };
    const branches = branchesOf(this.drawing.knots);
    const bands = this.drawing.band
      ? branches.flatMap((it) => jndBands(this.drawing, it).map((band) => ({ band, branch: it })))
      : [];
    this.below.replaceChildren(
      ...bands.map(({ band, branch }) =>
        drawn("path", { class: `jnd ${branch}`, d: `${linePath(band.x, band.y, plot.frame)}Z` }),
      ),
      ...branches.map((it) =>
        drawn("path", {
          class: `drawn ${it}`,
          d: linePath(lawLine(this.drawing, it).x, lawLine(this.drawing, it).y, plot.frame),
        }),
      ),
    );
    this.above.replaceChildren(...this.worstMark(sides), ...this.cursorMark(sides));
    this.handles.draw();
  }

  private worstMark(frame: { x: number; y: number; width: number; height: number }): SVGElement[] {
    if (!this.worst) return [];
    const { curve, position, force, knots } = this.drawing;
    const at = this.worst.worst_penetration;
    const mean = curve[this.worst.worst_branch][curve.penetration.indexOf(at)];
    if (mean == null) return [];
    const x = this.plot.x(at * position.perUnit);
    const onCurve = this.plot.y(mean * force.perUnit);
    const onLaw = this.plot.y(forceAt(knots, this.worst.worst_branch, at) * force.perUnit);
    const atRight = x > frame.x + 0.6 * frame.width;
    const middle = Math.max(frame.y + 14, Math.min(frame.y + frame.height - 6, 0.5 * (onCurve + onLaw) + 5));
    const text = `worst ${inUnits(this.worst.worst_n, force)}, ${plain(this.worst.worst_jnd, 2)} JND`;
    return [
      drawn("line", { class: "worst", x1: x, x2: x, y1: onCurve, y2: onLaw, "clip-path": this.plot.clip }),
      drawn("path", { class: "worst", d: `M${x - 6} ${onCurve - 6}l12 12m0 -12l-12 12` }),
      drawn(
        "text",
        { class: "worst", x: atRight ? x - 22 : x + 22, y: middle, "text-anchor": atRight ? "end" : "start" },
        text,
      ),
    ];
  }

  private cursorMark(frame: { x: number; y: number; width: number; height: number }): SVGElement[] {
    const x = this.plot.x(this.cursor.x);
    const y = this.plot.y(this.cursor.y);
    return [
      drawn("line", { class: "cursor", x1: x, x2: x, y1: frame.y, y2: frame.y + frame.height }),
      drawn("line", { class: "cursor", x1: frame.x, x2: frame.x + frame.width, y1: y, y2: y }),
    ];
  }
}
