import type { Knots } from "../api/editor";

/** What was drawn over an axis of a recording and not saved: it outlives tabs, reloads and a studio that is started anew. */
const keyOf = (curve: string): string => `kerf-drawing-${curve}`;

export function keepDrawing(curve: string, knots: Knots): void {
  try {
    localStorage.setItem(keyOf(curve), JSON.stringify(knots));
  } catch {
    // a browser that keeps nothing: the drawing lives as long as the page does
  }
}

const isNumbers = (value: unknown): value is number[] =>
  Array.isArray(value) && value.every((it) => typeof it === "number" && Number.isFinite(it));

export function keptDrawing(curve: string): Knots | null {
  try {
    const kept = JSON.parse(localStorage.getItem(keyOf(curve)) ?? "null") as Knots | null;
    if (!kept || !isNumbers(kept.penetration) || !isNumbers(kept.closing) || !isNumbers(kept.opening)) return null;
    const count = kept.penetration.length;
    const isWhole = count > 1 && kept.closing.length === count && [0, count].includes(kept.opening.length);
    return isWhole ? kept : null;
  } catch {
    return null;
  }
}
