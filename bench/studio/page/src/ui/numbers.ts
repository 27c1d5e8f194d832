// Numbers with units, as the field writes them.

const prefixes: readonly [number, string][] = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
];

/** 0.00123 "s" -> "1.23 ms"; three digits unless told. */
export function withUnit(value: number | null | undefined, unit: string, digits = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (unit === "1" || unit === "") return plain(value, digits);
  if (value === 0) return `0 ${unit}`;
  if (unit.startsWith("kg")) return withUnit(1000 * value, unit.slice(1), digits);
  const size = Math.abs(value);
  const [factor, prefix] = prefixes.find(([it]) => size >= it * 0.9995) ?? [1e-9, "n"];
  return `${plain(value / factor, digits)} ${prefix}${unit}`;
}

export function plain(value: number | null | undefined, digits = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(digits - 1).replace("-", "−");
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}

/** Degrees, as the charts of `kerf report` have them, in place of radians. */
const drawnUnits: Readonly<Record<string, string>> = { rad: "deg", "rad/s": "deg/s" };

/** As withUnit(), of what a plot draws: angles in degrees, as on its axis. */
export function asDrawn(value: number | null, unit: string, digits = 3): string {
  const drawn = drawnUnits[unit];
  if (drawn === undefined || value === null || !Number.isFinite(value)) return withUnit(value, unit, digits);
  return `${plain((value * 180) / Math.PI, digits)} ${drawn}`;
}

/**
 * The unit or prefix that suits an axis reaching to `largest`: value / factor is a number of `text`. Angles are in
 * degrees, whatever their size.
 */
export function unitFor(largest: number, unit: string): { factor: number; text: string } {
  const drawn = drawnUnits[unit];
  if (drawn !== undefined) return { factor: Math.PI / 180, text: drawn };
  const size = Math.abs(largest);
  if (!takesPrefix(unit) || !(size > 0) || !Number.isFinite(size)) return { factor: 1, text: unit === "1" ? "" : unit };
  const [factor, prefix] = prefixes.find(([it]) => size >= it * 0.9995) ?? [1e-9, "n"];
  return { factor, text: `${prefix}${unit}` };
}

/** Degrees, percents, numbers and what already has a prefix are written as they are. */
export function takesPrefix(unit: string): boolean {
  return /^(rad|m|N|V|A|W|J|s|Hz|Pa)([/·*].*)?$/.test(unit);
}

/** Round steps for an axis: about `count` ticks between the ends, and at least two, for one tells no scale. */
export function linearTicks(lower: number, upper: number, count: number): number[] {
  const range = upper - lower;
  if (!(range > 0)) return [lower];
  const rough = range / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  let ticks: number[] = [];
  for (const factor of [10, 5, 2, 1, 0.5, 0.2]) {
    const step = factor * power;
    if (step < 0.999 * rough && ticks.length >= 2) break;
    ticks = multiples(step, lower, upper);
  }
  return ticks;
}

function multiples(step: number, lower: number, upper: number): number[] {
  const found: number[] = [];
  for (let k = Math.ceil(lower / step - 1e-9); k * step <= upper + 1e-9 * (upper - lower); ++k) found.push(k * step);
  return found;
}

/** About `count` numbers: decades, with 3 or with 2 and 5 between them where there is room; equal steps within less than one. */
export function logarithmicTicks(lower: number, upper: number, count = Infinity): number[] {
  const decades = Math.log10(upper / lower);
  const every = Math.max(1, Math.ceil(decades / count));
  const first = every * Math.floor(Math.log10(lower) / every + 1e-9);
  let found: number[] = [];
  for (const within of every > 1 || decades > 4 ? [[1]] : [[1], [1, 3], [1, 2, 5]]) {
    const ticks: number[] = [];
    for (let decade = first; decade <= Math.ceil(Math.log10(upper)); decade += every)
      for (const factor of within) ticks.push(factor * 10 ** decade);
    const seen = ticks.filter((it) => it >= lower * 0.999 && it <= upper * 1.001);
    if (found.length < 3 || seen.length <= count) found = seen;
  }
  return found.length >= 3 ? found : linearTicks(lower, upper, Math.min(count, 6));
}

/** "1 cycle", "2 cycles". */
export function counted(count: number, noun: string): string {
  return `${count} ${noun}${count === 1 ? "" : "s"}`;
}
