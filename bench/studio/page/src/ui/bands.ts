import { drawn } from "./dom";
import type { XyPlot } from "./xy_plot";

type Values = readonly (number | null)[];

/** An area between two lines over x, as paths: gaps break it. */
export function bandPath(plot: XyPlot, x: readonly number[], low: Values, high: Values): string {
  let path = "";
  let begin = 0;
  const flush = (end: number): void => {
    if (end - begin < 2) return;
    const at = (i: number, of: Values): string => `${plot.x(x[i] ?? 0).toFixed(1)} ${plot.y(of[i] ?? 0).toFixed(1)}`;
    const points: string[] = [];
    for (let i = begin; i < end; ++i) points.push(at(i, high));
    for (let i = end - 1; i >= begin; --i) points.push(at(i, low));
    path += `M${points.join("L")}Z`;
  };
  for (let i = 0; i < x.length; ++i) {
    if (low[i] != null && high[i] != null) continue;
    flush(i);
    begin = i + 1;
  }
  flush(x.length);
  return path;
}

/** What a person cannot feel: a band about zero over the whole width. */
export function jndBand(plot: XyPlot, jnd: number): SVGElement[] {
  const [left, right] = [plot.x(plot.limits.x[0]), plot.x(plot.limits.x[1])];
  const [upper, lower] = plot.limits.y;
  const within = (value: number): number => plot.y(Math.min(Math.max(value, upper), lower));
  const top = within(jnd);
  const bottom = within(-jnd);
  return [
    drawn("rect", { class: "jnd_band", x: left, y: top, width: right - left, height: Math.max(0, bottom - top) }),
    drawn("text", { class: "jnd_label", x: right - 6, y: top + 16, "text-anchor": "end" }, "JND"),
  ];
}
