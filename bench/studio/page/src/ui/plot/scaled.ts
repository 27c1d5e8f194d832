import type { Numbers } from "../figure_description";
import { unitFor } from "../numbers";

/** A quantity in the unit that suits its size: its label, and its numbers in that unit. */
export interface Scaled {
  label: string; // "penetration [mm]"
  of: (values: Numbers) => (number | null)[];
}

/** By the largest of some numbers in SI. */
export function scaledFor(name: string, unit: string, lists: Iterable<Numbers>): Scaled {
  let largest = 0;
  for (const values of lists)
    for (const it of values) if (it !== null && Number.isFinite(it)) largest = Math.max(largest, Math.abs(it));
  const { factor, text } = unitFor(largest, unit);
  const inUnit = (value: number): number => (factor === 1 ? value : Number((value / factor).toPrecision(12)));
  return { label: `${name} [${text || "1"}]`, of: (values) => values.map((it) => (it === null ? null : inUnit(it))) };
}
