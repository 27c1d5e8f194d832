// Breakpoints of a law of segments, as values: every change gives new ones.

import type { EditorCurve, Knots } from "../api/editor";

export type Branch = "closing" | "opening";

export const fewestKnots = 2;
export const maxKnots = 17;

function inserted(values: readonly number[], index: number, value: number): number[] {
  return [...values.slice(0, index), value, ...values.slice(index)];
}

function replaced(values: readonly number[], index: number, value: number): number[] {
  return values.map((it, i) => (i === index ? value : it));
}

/** Force of a law at a penetration, as models::Piecewise has it: constant before the first, on beyond the last. */
export function forceAt(knots: Knots, branch: Branch, penetration: number): number {
  const at = knots.penetration;
  const force = branch === "opening" && knots.opening.length > 0 ? knots.opening : knots.closing;
  if (at[0]! >= penetration) return force[0]!;
  let i = 0;
  while (i + 2 < at.length && at[i + 1]! < penetration) ++i;
  return force[i]! + (force[i + 1]! - force[i]!) * ((penetration - at[i]!) / (at[i + 1]! - at[i]!));
}

/** The averaged curve at a penetration: linear between its points, the nearest where it does not reach. */
export function meanAt(curve: EditorCurve, branch: Branch, penetration: number): number | null {
  const force = curve[branch];
  let below = -1;
  for (let i = 0; i < force.length; ++i) {
    const here = force[i];
    if (here == null) continue;
    if (curve.penetration[i]! >= penetration) {
      if (below < 0) return here;
      const share = (penetration - curve.penetration[below]!) / (curve.penetration[i]! - curve.penetration[below]!);
      return force[below]! + share * (here - force[below]!);
    }
    below = i;
  }
  return below < 0 ? null : force[below]!;
}

/** The least distance that the editor leaves between two breakpoints. */
export function leastGap(curve: EditorCurve): number {
  return 1e-4 * (curve.penetration[curve.penetration.length - 1]! - curve.penetration[0]!);
}

/** A line from end to end of what was averaged, on each branch that was. */
export function startKnots(curve: EditorCurve): Knots {
  const reached = curve.penetration.filter((_, i) => curve.closing[i] != null || curve.opening[i] != null);
  const ends = [reached[0] ?? 0, reached[reached.length - 1] ?? 1];
  const closing = ends.map((it) => meanAt(curve, "closing", it) ?? 0);
  return withOpening(
    { penetration: ends, closing, opening: [] },
    curve,
    curve.opening.some((it) => it != null),
  );
}

/** With forces of its own for opening, those of the averaged curve; or without. */
export function withOpening(knots: Knots, curve: EditorCurve, own: boolean): Knots {
  const opening = own ? knots.penetration.map((it, i) => meanAt(curve, "opening", it) ?? knots.closing[i]!) : [];
  return { ...knots, opening };
}

export interface Spot {
  penetration: number;
  force: number;
  branch: Branch;
}

/**
 * One more breakpoint. On the other branch it has the force of the averaged curve, or of the line where that has
 * none. Nothing where there are as many as a law takes.
 */
export function added(knots: Knots, curve: EditorCurve, spot: Spot): { knots: Knots; index: number } | null {
  if (knots.penetration.length >= maxKnots) return null;
  const gap = leastGap(curve);
  let penetration = spot.penetration;
  for (const other of knots.penetration) if (Math.abs(other - penetration) < gap) penetration = other + gap;
  const before = knots.penetration.findIndex((it) => it > penetration);
  const index = before < 0 ? knots.penetration.length : before;
  const next = knots.penetration[index];
  if (next !== undefined && next - penetration < 0.5 * gap) return null;
  const forceOn = (branch: Branch): number =>
    branch === spot.branch ? spot.force : (meanAt(curve, branch, penetration) ?? forceAt(knots, branch, penetration));
  return {
    knots: {
      penetration: inserted(knots.penetration, index, penetration),
      closing: inserted(knots.closing, index, forceOn("closing")),
      opening: knots.opening.length > 0 ? inserted(knots.opening, index, forceOn("opening")) : [],
    },
    index,
  };
}

/** One breakpoint elsewhere, between its neighbours; the force of the other branch stays. */
export function moved(knots: Knots, index: number, spot: Spot, gap: number): Knots {
  const lower = index > 0 ? knots.penetration[index - 1]! + gap : -Infinity;
  const upper = index + 1 < knots.penetration.length ? knots.penetration[index + 1]! - gap : Infinity;
  const penetration = Math.max(lower, Math.min(upper, spot.penetration));
  return {
    penetration: replaced(knots.penetration, index, penetration),
    closing: spot.branch === "closing" ? replaced(knots.closing, index, spot.force) : knots.closing,
    opening:
      spot.branch === "opening" && knots.opening.length > 0
        ? replaced(knots.opening, index, spot.force)
        : knots.opening,
  };
}

/** One breakpoint less; nothing where two are left. */
export function removed(knots: Knots, index: number): Knots | null {
  if (knots.penetration.length <= fewestKnots) return null;
  const rest = (values: readonly number[]): number[] => values.filter((_, i) => i !== index);
  return { penetration: rest(knots.penetration), closing: rest(knots.closing), opening: rest(knots.opening) };
}

/** The same law over penetrations that are counted from elsewhere. */
export function shifted(knots: Knots, by: number): Knots {
  return { ...knots, penetration: knots.penetration.map((it) => it + by) };
}

/** What the server would refuse; empty if nothing. */
export function faultOf(knots: Knots): string {
  const count = knots.penetration.length;
  if (count < fewestKnots || count > maxKnots) return `A law takes ${fewestKnots} to ${maxKnots} breakpoints.`;
  for (const values of [knots.penetration, knots.closing, knots.opening]) {
    if (values.some((it) => !Number.isFinite(it) || Math.abs(it) > 1e6)) return "A number is missing or out of bounds.";
  }
  const back = knots.penetration.findIndex((it, i) => i > 0 && !(it > knots.penetration[i - 1]!));
  return back < 0 ? "" : `Breakpoint ${back + 1} must be deeper than breakpoint ${back}.`;
}
