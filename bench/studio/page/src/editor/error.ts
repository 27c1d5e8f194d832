// How far a law is from the averaged cycle: the same figures as the server's law_error(), while a knot is dragged.

import type { EditorCurve, Knots, LawError } from "../api/editor";
import { forceAt, type Branch } from "./knots";

/** What a person can feel of a force, in its unit. */
export function jndAt(curve: EditorCurve, force: number): number {
  return Math.max(curve.jnd.weber_fraction * Math.abs(force), curve.jnd.threshold_n);
}

export function branchesOf(knots: Knots): Branch[] {
  return knots.opening.length > 0 ? ["closing", "opening"] : ["closing"];
}

/** Over all finite points of the branches that the law has; nothing where there is none. */
export function lawError(curve: EditorCurve, knots: Knots): LawError | null {
  let squares = 0;
  let forceSquares = 0;
  let count = 0;
  const error: LawError = {
    rmse_n: 0,
    worst_n: -1,
    worst_penetration: 0,
    worst_branch: "closing",
    jnd_n: 0,
    rmse_jnd: 0,
    worst_jnd: 0,
  };
  for (const branch of branchesOf(knots)) {
    for (let i = 0; i < curve.penetration.length; ++i) {
      const force = curve[branch][i];
      if (force == null) continue;
      const penetration = curve.penetration[i]!;
      const off = Math.abs(forceAt(knots, branch, penetration) - force);
      squares += off * off;
      forceSquares += force * force;
      ++count;
      if (!(off > error.worst_n)) continue;
      error.worst_n = off;
      error.worst_penetration = penetration;
      error.worst_branch = branch;
      error.worst_jnd = off / jndAt(curve, force);
    }
  }
  if (count === 0) return null;
  error.rmse_n = Math.sqrt(squares / count);
  error.jnd_n = jndAt(curve, Math.sqrt(forceSquares / count));
  error.rmse_jnd = error.rmse_n / error.jnd_n;
  return error;
}
