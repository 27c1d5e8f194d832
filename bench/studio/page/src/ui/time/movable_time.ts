import { element } from "../dom";
import type { Movable, Place } from "../plot/gestures";
import type { TimeRange } from "./time_range";

/** A stretch of time under pointers and keys: what goes up and down is nothing to it. */
export class MovableTime implements Movable {
  private readonly mark = element("div", { class: "time_select", hidden: true });

  constructor(
    private readonly range: TimeRange,
    private readonly over: HTMLElement,
  ) {
    over.append(this.mark);
  }

  get fixed(): boolean {
    return this.range.following;
  }

  private timeAt({ x }: Place): number {
    return this.range.from + x * this.range.span;
  }

  box(): DOMRect {
    return this.over.getBoundingClientRect();
  }
  point(at: Place | null): void {
    this.range.point(at && this.timeAt(at));
  }
  pan(right: number): void {
    this.range.pan(right);
  }
  zoom(factor: number, at: Place | null): void {
    if (at) this.range.zoom(factor, this.timeAt(at));
    else this.range.zoom(factor);
  }
  showPart(from: Place, to: Place): void {
    const [a, b] = [this.timeAt(from), this.timeAt(to)];
    this.range.show(Math.min(a, b), Math.max(a, b));
  }
  whole(): void {
    this.range.whole();
  }
  takesWheel(): boolean {
    return true;
  }

  selecting(from: Place | null, to: Place | null): void {
    this.mark.hidden = !from || !to || Math.abs(to.x - from.x) * this.box().width < 4;
    if (!from || !to) return;
    const [left, right] = [from.x, to.x].map((it) => Math.min(1, Math.max(0, it))).sort((a, b) => a - b) as [
      number,
      number,
    ];
    this.mark.style.left = `${100 * left}%`;
    this.mark.style.width = `${100 * (right - left)}%`;
  }

  /** The cursor by a two-hundredth of what is shown; at the edge the picture moves on. */
  step(to: "left" | "right" | "up" | "down" | "begin" | "end"): void {
    const { range } = this;
    if (to === "begin" || to === "end") return range.point(to === "begin" ? range.from : range.to);
    if (to === "up" || to === "down") return;
    if (range.cursor === null) return range.point((range.from + range.to) / 2);
    const by = ((to === "right" ? 1 : -1) * range.span) / 200;
    const next = range.cursor + by;
    if (next < range.from || next > range.to) range.panBy(20 * by);
    range.point(next);
  }
}
