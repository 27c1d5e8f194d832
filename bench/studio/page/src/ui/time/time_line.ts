/** A trace as columns of smallest and largest values over time. */
export interface TimeLine {
  name: string; // as the legend says it
  unit: string;
  look: number; // its colour and dash: see palette.ts
  time: Float64Array; // of each column's first row, ascending
  smallest: Float32Array | Float64Array; // NaN: nothing there
  largest: Float32Array | Float64Array;
  shift_s: number; // added to its times
  step_s: number; // from a column to the next
  middle_s: number; // from a column's first row to its middle
}

/** How times and values become pixels of a canvas that is as large as the plot without its axes. */
export interface Mapping {
  from: number;
  to: number;
  width: number;
  lower: number; // of the values, or of their logarithms
  upper: number;
  height: number;
  logarithmic: boolean;
  pixels: number; // of the canvas in one of the page
}

/** The first index with a time not below t. */
export function indexAt(time: Float64Array, t: number): number {
  let low = 0;
  let high = time.length;
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (time[middle]! < t) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The columns that a stretch shows, and one more at each end: [first, end). */
export function columnsWithin(line: TimeLine, from: number, to: number): [number, number] {
  const shift = line.shift_s + line.middle_s;
  const first = indexAt(line.time, from - shift) - 1;
  const end = indexAt(line.time, to - shift) + 1;
  return [Math.max(0, first), Math.min(line.time.length, end)];
}

/** The column that a time falls into; -1 if none does. */
export function columnAt(line: TimeLine, t: number): number {
  const at = indexAt(line.time, t - line.shift_s + line.step_s * 1e-3) - 1;
  if (at < 0 || t - line.shift_s - line.time[at]! > 2.5 * line.step_s) return -1;
  return Number.isNaN(line.smallest[at]) ? -1 : at;
}

/** Widens `found` by the line's values within a stretch; logarithmic: by those above zero. */
export function widen(
  found: { lower: number; upper: number },
  line: TimeLine,
  from: number,
  to: number,
  logarithmic: boolean,
): void {
  const [first, end] = columnsWithin(line, from, to);
  for (let i = first; i < end; ++i) {
    const smallest = line.smallest[i]!;
    const largest = line.largest[i]!;
    if (largest > found.upper) found.upper = largest;
    if (smallest < found.lower && (!logarithmic || smallest > 0)) found.lower = smallest;
  }
}
