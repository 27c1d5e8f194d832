import type { Estimate } from "../api/results";
import { drawn } from "../ui/dom";

/** The interval of an estimate, however confident it was asked to be. */
export function intervalOf(estimate: Estimate): { name: string; lower: number | null; upper: number | null } {
  const entry = Object.entries(estimate).find(([name]) => name.startsWith("ci"));
  const [lower, upper] = Array.isArray(entry?.[1]) ? entry[1] : [null, null];
  return { name: entry?.[0] ?? "ci95", lower, upper };
}

const width = 160;
const height = 20;

/** How far the bars of some estimates reach, as a share of the value: what holds all that are known, or 100 %. */
export function reachOf(estimates: readonly Estimate[]): number {
  let most = 0;
  for (const estimate of estimates) {
    const { lower, upper } = intervalOf(estimate);
    if (lower === null || upper === null || estimate.value === 0) continue;
    most = Math.max(most, Math.max(upper - estimate.value, estimate.value - lower) / Math.abs(estimate.value));
  }
  return [0.01, 0.1].find((it) => most <= it) ?? 1;
}

/**
 * An interval as a bar: the middle is the value, the ends are the reach off it. One that the data do not determine goes from
 * end to end, dashed.
 */
export function intervalBar(estimate: Estimate, reach: number): SVGSVGElement {
  const { lower, upper } = intervalOf(estimate);
  const size = Math.abs(estimate.value);
  const known = lower !== null && upper !== null && size > 0;
  const at = (value: number): number => {
    const share = Math.max(-1, Math.min(1, (value - estimate.value) / (reach * size)));
    return width / 2 + (share * (width - 8)) / 2;
  };
  const from = known ? at(lower) : 4;
  const to = known ? Math.max(at(upper), from + 2) : width - 4;
  return drawn(
    "svg",
    {
      class: `interval${known ? "" : " unknown"}`,
      viewBox: `0 0 ${width} ${height}`,
      width,
      height,
      "aria-hidden": "true",
    },
    drawn("line", { class: "scale", x1: 4, x2: width - 4, y1: height / 2, y2: height / 2 }),
    drawn("line", { class: "span", x1: from, x2: to, y1: height / 2, y2: height / 2 }),
    drawn("line", { class: "value", x1: width / 2, x2: width / 2, y1: 3, y2: height - 3 }),
  );
}
