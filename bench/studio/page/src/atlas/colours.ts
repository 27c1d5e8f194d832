// Steps of viridis, as in the report.

import { colourAt } from "../ui/sequential";

export interface Steps {
  bounds: number[]; // one more than there are colours
  colours: string[];
}

function linearBounds(smallest: number, largest: number): number[] {
  const rough = (largest - smallest) / 9;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = ([1, 2, 2.5, 5, 10].find((it) => it * power >= rough * (1 - 1e-9)) ?? 10) * power;
  const bounds: number[] = [];
  for (let k = Math.floor(smallest / step + 1e-9); ; ++k) {
    bounds.push(k * step);
    if (k * step >= largest - 1e-9 * step) return bounds;
  }
}

function logarithmicBounds(smallest: number, largest: number): number[] {
  const decades = Math.log10(largest / smallest);
  const factors = decades <= 3.5 ? [1, 2, 5] : decades <= 6 ? [1, 3] : [1];
  const all: number[] = [];
  for (let decade = Math.floor(Math.log10(smallest)); decade <= Math.ceil(Math.log10(largest)) + 1; ++decade)
    for (const factor of factors) all.push(factor * 10 ** decade);
  const first = Math.max(0, all.findIndex((it) => it > smallest * (1 + 1e-9)) - 1);
  const last = all.findIndex((it) => it >= largest * (1 - 1e-9));
  return all.slice(first, last + 1);
}

/** The part of the scale that thin lines are seen by on the page's ground, in light and dark. */
export function rangeOfLines(): [number, number] {
  return matchMedia("(prefers-color-scheme: dark)").matches ? [0.3, 1] : [0, 0.8];
}

/** Round steps that hold all numbers; tenths where they are shares. Of the scale they take the part from `range`. */
export function stepsOf(
  numbers: readonly (number | null)[],
  share: boolean,
  range: readonly [number, number] = [0, 1],
): Steps {
  let smallest = Infinity;
  let largest = -Infinity;
  for (const it of numbers) {
    if (it === null || !Number.isFinite(it)) continue;
    smallest = Math.min(smallest, it);
    largest = Math.max(largest, it);
  }
  let bounds: number[];
  if (share || !(smallest <= largest)) bounds = Array.from({ length: 11 }, (_, i) => i / 10);
  else if (smallest === largest)
    bounds = [smallest - (Math.abs(smallest) / 2 || 1), largest + (Math.abs(largest) / 2 || 1)];
  else if (smallest > 0 && largest / smallest > 100) bounds = logarithmicBounds(smallest, largest);
  else bounds = linearBounds(smallest, largest);
  const steps = bounds.length - 1;
  const at = (i: number): number => range[0] + (range[1] - range[0]) * (steps < 2 ? 0.5 : i / (steps - 1));
  return { bounds, colours: Array.from({ length: steps }, (_, i) => colourAt(at(i))) };
}

/** Null where there is no number. */
export function colourOf(steps: Steps, value: number | null): string | null {
  if (value === null || Number.isNaN(value)) return null;
  let step = 0;
  while (step + 1 < steps.colours.length && value >= (steps.bounds[step + 1] ?? Infinity)) ++step;
  return steps.colours[step] ?? null;
}
