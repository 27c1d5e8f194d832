import { linearTicks, logarithmicTicks, plain } from "../numbers";

export type Range = readonly [number, number];

/** From the numbers of an axis to pixels of a plot and back. */
export class Scale {
  constructor(
    readonly range: Range,
    private readonly begin: number, // where the range begins [px]
    private readonly end: number,
    readonly logarithmic = false,
  ) {}

  /** Not finite for what a logarithmic axis has no place for. */
  at(value: number): number {
    const [lower, upper] = this.range;
    if (this.logarithmic && value <= 0) return NaN;
    const share = this.logarithmic
      ? Math.log(value / lower) / Math.log(upper / lower)
      : (value - lower) / (upper - lower);
    return this.begin + share * (this.end - this.begin);
  }

  value(pixel: number): number {
    return valueAt(this.range, (pixel - this.begin) / (this.end - this.begin), this.logarithmic);
  }

  /** The ends in pixels, the smaller first. */
  get pixels(): [number, number] {
    return [Math.min(this.begin, this.end), Math.max(this.begin, this.end)];
  }

  /** Round numbers with their texts, so many as have room at `spacing` pixels each. */
  ticks(spacing: number): { at: number; text: string }[] {
    const [lower, upper] = this.range;
    const count = Math.max(2, Math.abs(this.end - this.begin) / spacing);
    const all = this.logarithmic ? logarithmicTicks(lower, upper, count) : linearTicks(lower, upper, count);
    return all.map((at) => ({ at, text: plain(at, 6) }));
  }
}

/** The number at a share of a range. */
export function valueAt([lower, upper]: Range, share: number, logarithmic: boolean): number {
  return logarithmic ? lower * (upper / lower) ** share : lower + share * (upper - lower);
}

/** What holds all numbers, with a little room; of a logarithmic axis those above zero. */
export function rangeAround(lists: Iterable<readonly (number | null)[]>, logarithmic = false): [number, number] {
  let lower = Infinity;
  let upper = -Infinity;
  for (const values of lists) {
    for (const value of values) {
      if (value === null || !Number.isFinite(value) || (logarithmic && value <= 0)) continue;
      lower = Math.min(lower, value);
      upper = Math.max(upper, value);
    }
  }
  if (!(lower <= upper)) return logarithmic ? [1, 10] : [0, 1];
  if (logarithmic) return [lower / 1.15, upper * 1.15];
  const room = 0.04 * (upper - lower || Math.abs(upper) || 1);
  return [lower - room, upper + room];
}
