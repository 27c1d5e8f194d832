import type { FitFile, LawFit } from "../../api/results";
import { figureOf, lineOf, type Figure, type FigureCurve } from "../../ui/figure_description";

type Error = (fit: LawFit) => number | null | undefined;

/** Errors of all laws where they were fitted, where they were held out, and as a loop renders them; the JND as a line. */
export function heldOutFigure(file: FitFile, order: readonly LawFit[]): Figure {
  const x = order.map((_, i) => i + 1);
  const marks = (label: string, of: Error, more: Partial<FigureCurve>): FigureCurve =>
    lineOf(
      label,
      x,
      order.map((it) => of(it) ?? null),
      { mark: "points", width: 4, ...more },
    );
  const spread = order.flatMap((it, i) => {
    const [value, error] = [it.cv_rmse, it.cv_std_error];
    return value == null || error == null ? [] : [[i + 1, value - error, value + error] as const];
  });
  const bars = lineOf(
    "",
    spread.flatMap(([at]) => [at, at, null]),
    spread.flatMap(([, low, high]) => [Math.max(low, 0), high, null]),
    { colour: "blue", width: 1.5, name: "held out, standard error" },
  );
  const unit = file.force_unit ?? "N";
  const all = [
    marks("where it was fitted", (it) => it.rmse, { colour: "grey", mark: "circles" }),
    marks("held out, with its standard error", (it) => it.cv_rmse, { colour: "blue" }),
    marks("held out, as rendered", (it) => it.cv_rmse_rendered, { colour: "vermillion" }),
    marks("on the last share, which no fit saw", (it) => it.test_rmse, { colour: "green" }),
  ].filter((it) => it.y.some((value) => value !== null));
  const line = file.line_cv_rmse ?? file.line_rmse;
  const floor = file.floor?.velocity ?? file.floor?.position;
  return figureOf("law", `error, root mean square [${unit}]`, {
    curves: [bars, ...all],
    horizontal: [
      { at: file.jnd, label: "JND", label_after: false },
      { at: line, label: "a straight line", label_after: false },
      ...(floor == null ? [] : [{ at: floor, label: "the best curve of position and speed", label_after: false }]),
    ],
    x_ticks: order.map((it, i) => ({ at: i + 1, name: it.model })),
    x_range: [0.5, 1.45 * order.length + 0.5], // what the levels are called stands right of all marks
    y_range: [0, 1.1 * Math.max(file.jnd, line, ...all.flatMap((it) => it.y.map((value) => value ?? 0)))],
    notes: [`Errors of ${file.settings.folds || "no"} folds.`],
  });
}
