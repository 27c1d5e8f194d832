import type { EditorCurve, Knots } from "../api/editor";
import type { Loops } from "../api/recordings";
import { XyPlot, type Limits, type PlotLine } from "../ui/xy_plot";
import type { Drawing } from "./drawing";
import { jndAt } from "./error";
import { forceAt, type Branch } from "./knots";

// The drawing in the units of its plot.

function drawn(values: readonly (number | null)[], perUnit: number): (number | null)[] {
  return values.map((it) => (it === null ? null : it * perUnit));
}

export function averages(drawing: Drawing): PlotLine[] {
  const { curve, position, force } = drawing;
  const x = drawn(curve.penetration, position.perUnit);
  return [
    { x, y: drawn(curve.opening, force.perUnit), class: "opening" },
    { x, y: drawn(curve.closing, force.perUnit), class: "closing" },
  ];
}

export function cycles(drawing: Drawing, loops: Loops): PlotLine[] {
  const { curve, position, force } = drawing;
  return loops.loops.map((loop) => ({
    x: loop.position.map((it) => (it - curve.contact_position) * curve.closing_direction * position.perUnit),
    y: drawn(loop.force, force.perUnit),
    class: "faint",
  }));
}

/** The law from end to end of the curve, with what it does beyond its breakpoints. */
export function lawLine(drawing: Drawing, branch: Branch): { x: number[]; y: number[] } {
  const { curve, knots, position, force } = drawing;
  const at = [...knots.penetration];
  const first = curve.penetration[0]!;
  const last = curve.penetration[curve.penetration.length - 1]!;
  if (first < at[0]!) at.unshift(first);
  if (last > at[at.length - 1]!) at.push(last);
  return {
    x: at.map((it) => it * position.perUnit),
    y: at.map((it) => forceAt(knots, branch, it) * force.perUnit),
  };
}

/** Outlines of one JND to either side of an average, one for each stretch of it. */
export function jndBands(drawing: Drawing, branch: Branch): { x: number[]; y: number[] }[] {
  const { curve, position, force } = drawing;
  const bands: { x: number[]; y: number[] }[] = [];
  let upper: [number, number][] = [];
  let lower: [number, number][] = [];
  const close = (): void => {
    if (upper.length > 1) {
      const outline = [...upper, ...lower.reverse()];
      bands.push({ x: outline.map(([x]) => x), y: outline.map(([, y]) => y) });
    }
    upper = [];
    lower = [];
  };
  curve.penetration.forEach((penetration, i) => {
    const mean = curve[branch][i];
    if (mean == null) return close();
    const jnd = jndAt(curve, mean);
    const x = penetration * position.perUnit;
    upper.push([x, (mean + jnd) * force.perUnit]);
    lower.push([x, (mean - jnd) * force.perUnit]);
  });
  close();
  return bands;
}

/** Limits with room to draw in around the curve and the breakpoints. */
export function limitsFor(curve: EditorCurve, knots: Knots, drawing: Drawing): Limits {
  const { position, force } = drawing;
  const limits = XyPlot.around([
    ...averages(drawing),
    { x: drawn(knots.penetration, position.perUnit), y: drawn(knots.closing, force.perUnit), class: "" },
    { x: drawn(knots.penetration, position.perUnit), y: drawn(knots.opening, force.perUnit), class: "" },
    { x: [null], y: [0], class: "" },
  ]);
  const room = 0.08 * (limits.y[1] - limits.y[0]);
  const least = curve.jnd.threshold_n * force.perUnit;
  return { x: limits.x, y: [limits.y[0] - Math.max(room, least), limits.y[1] + Math.max(room, least)] };
}
