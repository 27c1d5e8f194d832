import type { Residuals } from "../../api/results";
import {
  figureOf,
  lineOf,
  type Figure,
  type FigureArea,
  type FigureCurve,
  type Numbers,
} from "../../ui/figure_description";
import { rangeAround } from "../../ui/plot/scale";
import type { ComparedLaw } from "./compared_law";

const branches = ["closing", "opening"] as const;
type Branch = (typeof branches)[number];

/** Where few rows lie nothing is known; a line goes on over it, since the next place is near. */
function known(x: Numbers, y: Numbers): { x: Numbers; y: Numbers; places: number[] } {
  const places = y.flatMap((it, i) => (it === null ? [] : [i]));
  return { x: places.map((i) => x[i] ?? null), y: places.map((i) => y[i] ?? null), places };
}

function lineOfBranch(
  of: Residuals,
  from: "measured" | "law",
  branch: Branch,
  label: string,
  more: Partial<FigureCurve>,
): FigureCurve {
  const { x, y } = known(of.penetration, of.loop[`${from}_${branch}`]);
  return lineOf(label, x, y, {
    ...more,
    marked: from === "law",
    width: branch === "closing" ? 2.5 : 1.2,
    name: `${more.name ?? label} ${branch}`,
  });
}

function band({ model, colour, residuals }: ComparedLaw, branch: Branch): FigureArea[] {
  const half = residuals.interval?.[branch];
  if (!half) return [];
  const { x, y, places } = known(residuals.penetration, residuals.loop[`law_${branch}`]);
  const edge = (sign: 1 | -1): (number | null)[] =>
    y.map((it, k) => (it === null ? null : it + sign * (half[places[k]!] ?? NaN)));
  const label = `interval of ${model}, ${100 * residuals.interval!.confidence} %`;
  return [{ label, x, low: edge(-1), high: edge(1), colour, name: `${model} ${branch} interval` }];
}

/** What was measured, solid, and laws over it, dashed, with the intervals of their force; out of the tissue thin. */
export function lawsOverData(laws: readonly ComparedLaw[]): Figure {
  const of = laws[0]!.residuals;
  const measured = branches.map((branch) =>
    lineOfBranch(of, "measured", branch, branch === "closing" ? "measured (going out: thin)" : "", {
      colour: "black",
      name: "measured",
    }),
  );
  const curves = laws.flatMap(({ model, colour, residuals }) =>
    branches.map((branch) =>
      lineOfBranch(residuals, "law", branch, branch === "closing" ? model : "", { colour, dashed: true, name: model }),
    ),
  );
  const told = laws.some((it) => it.residuals.interval) ? " Intervals are of the law's force, without noise." : "";
  return figureOf(`penetration [${of.position_unit}]`, `force [${of.force_unit}]`, {
    curves: [...measured, ...curves],
    areas: laws.flatMap((law) => branches.flatMap((branch) => band(law, branch))),
    y_range: rangeAround([...measured, ...curves].map((it) => it.y)), // an interval may reach anywhere
    notes: [`Means of each penetration, over the rows that laws are judged by.${told}`],
  });
}

/** What laws leave, by penetration: mean and one standard deviation about it. */
export function residualsOverPenetration(laws: readonly ComparedLaw[]): Figure {
  const of = laws[0]!.residuals;
  const deviations = laws.map(
    ({ model, colour, residuals }): FigureArea => ({
      label: laws.length > 1 ? `${model}, ± standard deviation` : "± standard deviation",
      x: residuals.penetration,
      low: residuals.low,
      high: residuals.high,
      colour,
      name: `${model} standard deviation`,
    }),
  );
  return figureOf(`penetration [${of.position_unit}]`, `measured − law [${of.force_unit}]`, {
    areas: [jndBand(of, of.penetration), ...deviations],
    curves: laws.map(({ model, colour, residuals }) =>
      lineOf(model, residuals.penetration, residuals.mean, { colour, name: `${model} mean`, marked: laws.length > 1 }),
    ),
    y_range: aboutZero(laws, (it) => [...it.low, ...it.high]),
    notes: ["Mean of each penetration, and one standard deviation about it."],
  });
}

/** What a person cannot feel: a band about zero over the whole width. */
export function jndBand({ jnd_n }: Residuals, x: Numbers): FigureArea {
  const ends = [x[0] ?? 0, x[x.length - 1] ?? 1];
  return {
    label: "within the JND",
    x: ends,
    low: [-jnd_n, -jnd_n],
    high: [jnd_n, jnd_n],
    colour: "orange",
    name: "JND",
  };
}

/** Symmetric about zero, with the JND in it. */
export function aboutZero(laws: readonly ComparedLaw[], of: (residuals: Residuals) => Numbers): [number, number] {
  let most = 0;
  for (const { residuals } of laws) {
    most = Math.max(most, 1.3 * residuals.jnd_n);
    for (const value of of(residuals)) if (value !== null) most = Math.max(most, 1.06 * Math.abs(value));
  }
  return [-most, most];
}
