import { plain } from "../ui/numbers";

const prefixes: readonly [number, string][] = [
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
];

/** A unit with the prefix that suits a whole range, so that plot, labels and table agree. */
export interface Scale {
  unit: string; // "mm"
  perUnit: number; // drawn value = value in SI * perUnit
  decimals: number; // that a number field shows: a hundred-thousandth of the range
}

export function scaleFor(values: readonly (number | null)[], unit: string): Scale {
  let largest = 0;
  for (const it of values) if (it !== null && Number.isFinite(it)) largest = Math.max(largest, Math.abs(it));
  // Angles in degrees, as every plot has them.
  if (unit === "rad") {
    const most = (largest * 180) / Math.PI;
    return {
      unit: "deg",
      perUnit: 180 / Math.PI,
      decimals: most > 0 ? Math.max(0, 4 - Math.floor(Math.log10(most))) : 4,
    };
  }
  const [factor, prefix] = prefixes.find(([it]) => largest >= it) ?? (largest > 0 ? [1e-6, "µ"] : [1, ""]);
  const whole = largest > 0 ? Math.floor(Math.log10(largest / factor)) : 0;
  return { unit: prefix + unit, perUnit: 1 / factor, decimals: Math.max(0, 4 - whole) };
}

export function inUnits(value: number, scale: Scale, digits = 3): string {
  return `${plain(value * scale.perUnit, digits)} ${scale.unit}`;
}

/** For a number field. */
export function asField(value: number, scale: Scale): string {
  return String(Number((value * scale.perUnit).toFixed(scale.decimals)));
}
