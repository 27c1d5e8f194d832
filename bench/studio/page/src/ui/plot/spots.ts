import type { Figure, FigureCurve } from "../figure_description";

/** A mark that stands for something: the page draws it in the plot's layer, and opens what it stands for. */
export interface Spot {
  of: number;
  x: number;
  y: number;
  curve: FigureCurve;
}

export function spotsOf(figure: Figure): Spot[] {
  return figure.curves
    .flatMap((curve) => curve.of.map((of, i) => ({ of, x: curve.x[i] ?? NaN, y: curve.y[i] ?? NaN, curve })))
    .filter((it) => Number.isFinite(it.x) && Number.isFinite(it.y));
}
