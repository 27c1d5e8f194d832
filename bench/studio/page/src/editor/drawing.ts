import type { EditorCurve, Knots } from "../api/editor";
import { type History } from "./history";
import { added, leastGap, moved, removed, withOpening, type Branch, type Spot } from "./knots";
import { scaleFor, type Scale } from "./scale";

/** What is drawn over one curve, and what is chosen of it; tells its listeners of every change. */
export class Drawing {
  branch: Branch = "closing"; // that new breakpoints are put on
  selected = -1;
  band = false;
  readonly position: Scale;
  readonly force: Scale;
  private readonly listeners: (() => void)[] = [];

  constructor(
    readonly curve: EditorCurve,
    readonly history: History<Knots>,
  ) {
    this.position = scaleFor(curve.penetration, curve.position_unit);
    this.force = scaleFor([...curve.closing, ...curve.opening], curve.force_unit);
  }

  get knots(): Knots {
    return this.history.now;
  }
  get segments(): number {
    return this.knots.penetration.length - 1;
  }
  get hasOpening(): boolean {
    return this.knots.opening.length > 0;
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
  changed(): void {
    if (!this.hasOpening) this.branch = "closing";
    this.selected = Math.min(this.selected, this.segments);
    for (const listener of this.listeners) listener();
  }

  set(knots: Knots, tag = ""): void {
    this.history.record(knots, tag);
    this.changed();
  }
  /** Where it was put; -1 where there is no room for one more. */
  add(spot: Spot, tag = ""): number {
    const next = added(this.knots, this.curve, spot);
    if (!next) return -1;
    this.selected = next.index;
    this.branch = spot.branch;
    this.set(next.knots, tag);
    return next.index;
  }
  move(index: number, spot: Spot, tag: string): void {
    this.selected = index;
    this.branch = spot.branch;
    this.set(moved(this.knots, index, spot, leastGap(this.curve)), tag);
  }
  remove(index: number): boolean {
    const next = removed(this.knots, index);
    if (!next) return false;
    this.selected = Math.max(0, index - 1);
    this.set(next);
    return true;
  }
  choose(index: number, branch: Branch): void {
    if (index === this.selected && branch === this.branch) return;
    this.selected = index;
    this.branch = branch;
    this.changed();
  }
  ownOpening(own: boolean): void {
    this.set(withOpening(this.knots, this.curve, own));
  }
  undo(): void {
    if (this.history.undo()) this.changed();
  }
  redo(): void {
    if (this.history.redo()) this.changed();
  }
}
