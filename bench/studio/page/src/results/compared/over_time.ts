import type { Residuals } from "../../api/results";
import {
  figureOf,
  lineOf,
  type Figure,
  type FigureArea,
  type FigureBand,
  type FigureCurve,
  type Numbers,
} from "../../ui/figure_description";
import type { ComparedLaw } from "./compared_law";
import { aboutZero, jndBand } from "./over_penetration";

const columnsNote = "Smallest and largest value of each stretch of rows, at its begin; no spike is lost.";

function extremes(label: string, x: number[], low: Numbers, high: Numbers, colour: FigureArea["colour"]): FigureArea {
  return { label, x, low, high, colour, extremes: true, name: label };
}

/** Out of contact, and in cycles that were left out: nothing there is a law's to explain. */
function notJudged({ time_s, over_time }: Residuals): FigureBand[] {
  const bands: FigureBand[] = [];
  time_s.forEach((begin, i) => {
    if (over_time.measured_smallest[i] !== null) return;
    const end = time_s[i + 1] ?? begin;
    const last = bands[bands.length - 1];
    if (last?.end === begin) last.end = end;
    else bands.push({ begin, end, colour: "grey", label: "rows that no law is judged by" });
  });
  return bands;
}

/** Dashed as laws are: one line, or two where a stretch holds more than one value. */
function lawLines({ model, colour, residuals }: ComparedLaw): FigureCurve[] {
  const { law_smallest: low, law_largest: high } = residuals.over_time;
  const line = (y: Numbers, label: string, name: string): FigureCurve =>
    lineOf(label, residuals.time_s, y, { colour, dashed: true, width: 1.75, name, marked: label !== "" });
  if (low.every((it, i) => it === high[i])) return [line(low, model, model)];
  return [line(high, model, `${model} largest`), line(low, "", `${model} smallest`)];
}

/** What was measured and what laws render along it, over time: also where nothing moves. */
export function forcesOverTime(laws: readonly ComparedLaw[]): Figure {
  const of = laws[0]!.residuals;
  const { time_s, over_time, force_unit } = of;
  const others = extremes("", time_s, over_time.not_judged_smallest, over_time.not_judged_largest, "grey");
  return figureOf("time [s]", `force [${force_unit}]`, {
    bands: notJudged(of),
    areas: [
      { ...others, name: "measured not judged" },
      extremes("measured", time_s, over_time.measured_smallest, over_time.measured_largest, "black"),
    ],
    curves: laws.flatMap(lawLines),
    notes: [columnsNote],
  });
}

export function residualsOverTime(laws: readonly ComparedLaw[]): Figure {
  const of = laws[0]!.residuals;
  return figureOf("time [s]", `measured − law [${of.force_unit}]`, {
    bands: notJudged(of),
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
