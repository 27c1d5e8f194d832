import type { EditorCurve, Knots } from "../api/editor";
import type { Loops } from "../api/recordings";
import { figureOf, lineOf, type FigureCurve } from "../ui/figure_description";
import { limitsOf, type Limits } from "../ui/plot/frame";
import type { Drawing } from "./drawing";
import { branchesOf, jndAt } from "./error";
import { forceAt, type Branch } from "./knots";

// The drawing in the units of its plot.

function drawn(values: readonly (number | null)[], perUnit: number): (number | null)[] {
  return values.map((it) => (it === null ? null : it * perUnit));
}

export function averages(drawing: Drawing): FigureCurve[] {
  const { curve, position, force } = drawing;
  const x = drawn(curve.penetration, position.perUnit);
  return [
    lineOf("averaged opening", x, drawn(curve.opening, force.perUnit), { colour: "vermillion", name: "opening" }),
    lineOf("averaged closing", x, drawn(curve.closing, force.perUnit), { name: "closing", width: 2.5 }),
  ];
}

export function cycles(drawing: Drawing, loops: Loops): FigureCurve[] {
  const { curve, position, force } = drawing;
  return loops.loops.map((loop) => {
    const x = loop.position.map((it) => (it - curve.contact_position) * curve.closing_direction * position.perUnit);
    const name = `cycle ${loop.cycle}`;
    return lineOf("", x, drawn(loop.force, force.perUnit), { colour: "grey", width: 0.7, name });
  });
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

/** The law as it is handed out. */
export function lawCurves(drawing: Drawing): FigureCurve[] {
  return branchesOf(drawing.knots).map((branch) => {
    const { x, y } = lawLine(drawing, branch);
    return lineOf(`law, ${branch}`, x, y, { colour: "black", dashed: true, width: branch === "closing" ? 2.5 : 1.25 });
  });
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
  const at = drawn(knots.penetration, position.perUnit);
  const places = [knots.closing, knots.opening].map((it) => lineOf("", at, drawn(it, force.perUnit)));
  const curves = [...averages(drawing), ...places, lineOf("", [null], [0])];
  const limits = limitsOf(figureOf("", "", { curves }));
  const room = 0.08 * (limits.y[1] - limits.y[0]);
  const least = curve.jnd.threshold_n * force.perUnit;
  return { x: limits.x, y: [limits.y[0] - Math.max(room, least), limits.y[1] + Math.max(room, least)] };
}
