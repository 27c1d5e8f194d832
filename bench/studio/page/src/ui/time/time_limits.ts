import { linearTicks } from "../numbers";

/**
 * Limits of a value axis that stay calm: round, and kept while the values stay within and fill two fifths of them.
 * Logarithmic axes are given and give logarithms to base 10.
 */
export function calmLimits(
  lower: number,
  upper: number,
  before: readonly [number, number] | null,
  logarithmic: boolean,
): [number, number] {
  if (!(lower <= upper) || !Number.isFinite(upper - lower))
    return before ? [before[0], before[1]] : logarithmic ? [-6, -3] : [-1, 1];
  if (logarithmic) return wholeDecades(lower, upper, before);
  const least = Math.max(Math.abs(lower), Math.abs(upper)) * 1e-5;
  if (upper - lower <= least) {
    const room = Math.max(Math.abs(upper) * 0.1, least) || 1;
    lower -= room;
    upper += room;
  }
  if (before && lower >= before[0] && upper <= before[1] && upper - lower > 0.4 * (before[1] - before[0])) {
    return [before[0], before[1]];
  }
  const room = 0.06 * (upper - lower);
  const ticks = linearTicks(lower - room, upper + room, 16); // finer than any axis writes them
  const step = (ticks[1] ?? 1) - (ticks[0] ?? 0);
  return [Math.floor((lower - room) / step) * step, Math.ceil((upper + room) / step) * step];
}

function wholeDecades(lower: number, upper: number, before: readonly [number, number] | null): [number, number] {
  const first = Math.floor(lower);
  const last = Math.max(Math.ceil(upper), first + 1);
  if (before && first >= before[0] && last <= before[1] && last - first > (before[1] - before[0]) / 2) {
    return [before[0], before[1]];
  }
  return [first, last];
}
