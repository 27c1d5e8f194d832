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

/** How times and values become pixels of the canvas. */
export interface Mapping {
  from: number;
  to: number;
  left: number;
  width: number;
  lower: number; // of the values, or of their logarithms
  upper: number;
  top: number;
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
    if ((time[middle] as number) < t) low = middle + 1;
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
  if (at < 0 || t - line.shift_s - (line.time[at] as number) > 2.5 * line.step_s) return -1;
  return Number.isNaN(line.smallest[at]) ? -1 : at;
}

/** Widens `found` by the line's values within a stretch; logarithmic: by those above zero. */
export function widen(found: { lower: number; upper: number }, line: TimeLine, from: number, to: number, logarithmic: boolean): void {
  const [first, end] = columnsWithin(line, from, to);
  for (let i = first; i < end; ++i) {
    const smallest = line.smallest[i] as number;
    const largest = line.largest[i] as number;
    if (largest > found.upper) found.upper = largest;
    if (smallest < found.lower && (!logarithmic || smallest > 0)) found.lower = smallest;
  }
}

/**
 * Draws a line: each column from its smallest to its largest value, so that every spike is seen, with both edges as
 * lines. Breaks where columns are empty or missing. The canvas is clipped to the plot and has its colours set.
 */
export function drawLine(context: CanvasRenderingContext2D, line: TimeLine, map: Mapping, dash: readonly number[]): void {
  const [first, end] = columnsWithin(line, map.from, map.to);
  const furthest = 2.5 * line.step_s;
  let begin = -1;
  for (let i = first; i <= end; ++i) {
    const holds = i < end && !Number.isNaN(line.smallest[i]);
    const far = holds && begin >= 0 && (line.time[i] as number) - (line.time[i - 1] as number) > furthest;
    if (begin >= 0 && (!holds || far)) {
      drawRun(context, line, map, dash, begin, i);
      begin = -1;
    }
    if (holds && begin < 0) begin = i;
  }
}

function drawRun(
  context: CanvasRenderingContext2D,
  line: TimeLine,
  map: Mapping,
  dash: readonly number[],
  begin: number,
  end: number,
): void {
  const perSecond = map.width / (map.to - map.from);
  const perValue = map.height / (map.upper - map.lower);
  const x0 = map.left + (line.shift_s + line.middle_s - map.from) * perSecond;
  const y0 = map.top + map.upper * perValue;
  const floor = map.logarithmic ? 10 ** map.lower : 0;
  const x = (i: number): number => x0 + (line.time[i] as number) * perSecond;
  const y = (value: number): number => y0 - (map.logarithmic ? Math.log10(value > floor ? value : floor) : value) * perValue;
  const pixel = map.pixels / perValue;

  context.setLineDash([]);
  const spacing = line.step_s * perSecond;
  if (end - begin === 1 || spacing > 12 * map.pixels) dots(context, line, map, begin, end, x, y);

  let thick = false;
  context.beginPath();
  for (let i = begin; i < end; ++i) {
    const largest = line.largest[i] as number;
    context.lineTo(x(i), y(largest));
    thick ||= map.logarithmic ? largest > (line.smallest[i] as number) : largest - (line.smallest[i] as number) > pixel;
  }
  if (thick) {
    const upper = context.globalAlpha;
    for (let i = end - 1; i >= begin; --i) context.lineTo(x(i), y(line.smallest[i] as number));
    context.closePath();
    context.globalAlpha = 0.3 * upper;
    context.fill();
    context.globalAlpha = upper;
    context.stroke();
    return;
  }
  if (dash.length > 0) context.setLineDash(dash.map((it) => it * map.pixels));
  context.stroke();
}

function dots(
  context: CanvasRenderingContext2D,
  line: TimeLine,
  map: Mapping,
  begin: number,
  end: number,
  x: (i: number) => number,
  y: (value: number) => number,
): void {
  const radius = 2.2 * map.pixels;
  context.beginPath();
  for (let i = begin; i < end; ++i) {
    const at = y(line.largest[i] as number);
    context.moveTo(x(i) + radius, at);
    context.arc(x(i), at, radius, 0, 2 * Math.PI);
  }
  context.fill();
}
