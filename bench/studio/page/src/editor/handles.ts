import { drawn } from "../ui/dom";
import type { Plot } from "../ui/plot/plot";
import type { Drawing } from "./drawing";
import { branchesOf } from "./error";
import type { Branch } from "./knots";
import { inUnits } from "./scale";

const hitRadius = 14; // a target of 28 px

interface Handle {
  node: SVGGElement;
  circles: SVGCircleElement[];
}

/** A breakpoint as it is read out: "Breakpoint 3 of 5, closing, 12.3 mm, 4.56 N". */
export function nameOf(drawing: Drawing, index: number, branch: Branch): string {
  const { knots, position, force } = drawing;
  return [
    `Breakpoint ${index + 1} of ${knots.penetration.length}`,
    branch,
    inUnits(knots.penetration[index]!, position),
    inUnits(knots[branch][index]!, force),
  ].join(", ");
}

/** The breakpoints as circles that take the focus; the same nodes as long as there are as many. */
export class Handles {
  readonly group = drawn("g", { class: "knots" });
  private readonly handles: Record<Branch, Handle[]> = { closing: [], opening: [] };

  constructor(
    private readonly drawing: Drawing,
    private readonly plot: Plot,
  ) {}

  draw(): void {
    const branches = branchesOf(this.drawing.knots);
    const count = this.drawing.knots.penetration.length;
    this.match("closing", count);
    this.match("opening", branches.length > 1 ? count : 0);
    for (const branch of branches) this.handles[branch].forEach((handle, index) => this.place(handle, index, branch));
  }

  focus(index: number, branch: Branch): void {
    this.handles[branch][index]?.node.focus({ preventScroll: true });
  }

  /** Which breakpoint a node belongs to. */
  static of(target: EventTarget | null): { index: number; branch: Branch } | null {
    const node = target instanceof Element ? target.closest<SVGGElement>("g.knot") : null;
    if (!node) return null;
    return {
      index: Number(node.dataset.index),
      branch: node.dataset.branch === "opening" ? "opening" : "closing",
    };
  }

  private match(branch: Branch, count: number): void {
    const handles = this.handles[branch];
    while (handles.length > count) handles.pop()?.node.remove();
    while (handles.length < count) {
      const circles = ["hit", "halo", "mark"].map((it) =>
        drawn("circle", { class: it, r: it === "mark" ? 7 : hitRadius }),
      );
      const node = drawn("g", { class: `knot ${branch}`, role: "slider", tabindex: 0 }, ...circles);
      node.dataset.branch = branch;
      node.dataset.index = String(handles.length);
      handles.push({ node, circles });
      // Closing first, then opening: the order of the Tab key.
      if (branch === "closing") this.group.insertBefore(node, this.handles.opening[0]?.node ?? null);
      else this.group.append(node);
    }
  }

  private place(handle: Handle, index: number, branch: Branch): void {
    const { knots, position, force } = this.drawing;
    const at = { x: knots.penetration[index]! * position.perUnit, y: knots[branch][index]! * force.perUnit };
    for (const circle of handle.circles) {
      circle.setAttribute("cx", this.plot.x(at.x).toFixed(2));
      circle.setAttribute("cy", this.plot.y(at.y).toFixed(2));
    }
    const name = nameOf(this.drawing, index, branch);
    handle.node.setAttribute("aria-label", name);
    handle.node.setAttribute("aria-valuenow", String(Number(at.y.toPrecision(6))));
    handle.node.setAttribute("aria-valuetext", name.split(", ").slice(2).join(", "));
    const chosen = index === this.drawing.selected && branch === this.drawing.branch;
    handle.node.classList.toggle("chosen", chosen);
  }
}
