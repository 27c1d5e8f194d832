import "./compared.css";

import { element } from "../../ui/dom";
import type { Figure } from "../../ui/figure_description";
import { plain, withUnit } from "../../ui/numbers";
import { Plot } from "../../ui/plot/plot";
import { scaledFor } from "../../ui/plot/scaled";
import type { ComparedLaw } from "./compared_law";
import { errorPlaces } from "./error_places";
import { lawsOverData, residualsOverPenetration } from "./over_penetration";
import { forcesOverTime, residualsOverTime } from "./over_time";

const views: readonly (readonly [string, (laws: readonly ComparedLaw[]) => Figure])[] = [
  ["Laws over the data", lawsOverData],
  ["Forces over time", forcesOverTime],
  ["Residual over time", residualsOverTime],
  ["Residual over penetration", residualsOverPenetration],
];

/** Penetrations in the unit that suits them. */
function inDrawnUnits(laws: readonly ComparedLaw[]): ComparedLaw[] {
  const unit = laws[0]!.residuals.position_unit;
  const scaled = scaledFor(
    "",
    unit,
    laws.map((it) => it.residuals.penetration),
  );
  const position_unit = /\[(.*)\]/.exec(scaled.label)?.[1] ?? unit;
  return laws.map((it) => ({
    ...it,
    residuals: { ...it.residuals, position_unit, penetration: scaled.of(it.residuals.penetration) as number[] },
  }));
}

/** One law or several over the same recording: by penetration, over time, and what they leave of it. */
export class Comparison {
  readonly first: HTMLElement; // what is looked at while laws are ticked: forces
  readonly rest: HTMLElement; // what laws leave of them, and where
  private readonly words = element("div", { class: "figures", role: "status" });
  private readonly plots: readonly Plot[];

  constructor(
    private readonly recording: string, // its id
    name: string,
  ) {
    this.plots = views.map(([title]) => new Plot(`${title}: ${name}`));
    const figures = this.plots.map((it, k) => it.figure(views[k]![0]));
    this.first = element("div", { class: "residuals" }, ...figures.slice(0, 2));
    this.rest = element("div", { class: "residuals" }, this.words, ...figures.slice(2));
  }

  end(): void {
    for (const plot of this.plots) plot.end();
  }

  show(laws: readonly ComparedLaw[]): void {
    if (laws.length === 0) return;
    this.words.replaceChildren(...laws.map((it) => this.sentence(it)));
    const drawn = inDrawnUnits(laws);
    this.plots.forEach((plot, k) => plot.show(views[k]![1](drawn)));
  }

  private sentence({ model, residuals: of }: ComparedLaw): HTMLElement {
    const [error, worst, jnd] = [of.rmse, of.worst, of.jnd_n].map((it) => withUnit(it, of.force_unit));
    const text = `${model}: Error ${error} (${plain(of.rmse / of.jnd_n, 2)} JND), largest ${worst}, over ${of.rows} rows. JND ${jnd}.`;
    return element("div", {}, element("p", {}, text), errorPlaces(this.recording, of));
  }
}
