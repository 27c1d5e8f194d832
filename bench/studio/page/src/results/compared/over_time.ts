import { figureOf, lineOf, type Figure, type FigureArea, type FigureCurve } from "../../ui/figure_description";
import type { ComparedLaw } from "./compared_law";
import { aboutZero, jndBand } from "./over_penetration";

const columnsNote = "Smallest and largest value of each stretch of rows, at its begin; no spike is lost.";

function extremes(label: string, x: number[], low: number[], high: number[], colour: FigureArea["colour"]): FigureArea {
  return { label, x, low, high, colour, extremes: true, name: label };
}

/** Dashed as laws are: one line, or two where a stretch holds more than one value. */
function lawLines({ model, colour, residuals }: ComparedLaw): FigureCurve[] {
  const { law_smallest: low, law_largest: high } = residuals.over_time;
  const line = (y: number[], label: string, name: string): FigureCurve =>
    lineOf(label, residuals.time_s, y, { colour, dashed: true, width: 1.75, name, marked: label !== "" });
  if (low.every((it, i) => it === high[i])) return [line(low, model, model)];
  return [line(high, model, `${model} largest`), line(low, "", `${model} smallest`)];
}

/** What was measured and what laws render along it, over time: also where nothing moves. */
export function forcesOverTime(laws: readonly ComparedLaw[]): Figure {
  const { time_s, over_time, force_unit } = laws[0]!.residuals;
  return figureOf("time [s]", `force [${force_unit}]`, {
    areas: [extremes("measured", time_s, over_time.measured_smallest, over_time.measured_largest, "black")],
    curves: laws.flatMap(lawLines),
    notes: [columnsNote],
  });
}

export function residualsOverTime(laws: readonly ComparedLaw[]): Figure {
  const of = laws[0]!.residuals;
  return figureOf("time [s]", `law − measured [${of.force_unit}]`, {
    areas: [
      jndBand(of, of.time_s),
      ...laws.map(({ model, colour, residuals }) =>
        extremes(model, residuals.time_s, residuals.smallest, residuals.largest, colour),
      ),
    ],
    y_range: aboutZero(laws, (it) => [...it.smallest, ...it.largest]),
    notes: [columnsNote],
  });
}
