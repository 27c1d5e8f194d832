import type { Residuals } from "../api/results";
import { bandPath, jndBand } from "../ui/bands";
import { drawn, element } from "../ui/dom";
import { plain, withUnit } from "../ui/numbers";
import { XyPlot } from "../ui/xy_plot";
import type { Limits } from "../ui/xy_plot";

/** Symmetric about zero, with the JND in it. */
function aboutZero(of: Residuals, values: readonly (number | null)[]): [number, number] {
  let most = 1.3 * of.jnd_n;
  for (const value of values) if (value !== null) most = Math.max(most, 1.06 * Math.abs(value));
  return [-most, most];
}

function ends(values: readonly number[]): [number, number] {
  const first = values[0] ?? 0;
  const last = values[values.length - 1] ?? 1;
  return last > first ? [first, last] : [first, first + 1];
}

/** What a law leaves of a recording: over time, over penetration, and both as a loop. */
export class ResidualPlots {
  readonly root: HTMLElement;
  private readonly time: XyPlot;
  private readonly penetration: XyPlot;
  private readonly loop: XyPlot;
  private readonly words = element("p", { class: "figures", role: "status" });
  private residuals: Residuals | null = null;

  constructor(position_unit: string, force_unit: string) {
    const residual = `law − measured [${force_unit}]`;
    const depth = `penetration [${position_unit}]`;
    this.time = new XyPlot({ label: "time [s]" }, { label: residual }, "Residual over time", () => this.drawTime());
    this.penetration = new XyPlot({ label: depth }, { label: residual }, "Residual over penetration", () =>
      this.drawPenetration(),
    );
    this.loop = new XyPlot({ label: depth }, { label: `force [${force_unit}]` }, "Law over the data", () =>
      this.drawLoop(),
    );
    const figure = (title: string, plot: XyPlot, note: string): HTMLElement =>
      element(
        "figure",
        { class: "card" },
        element("figcaption", {}, title),
        element("div", { class: "plot" }, plot.svg),
        element("p", { class: "quiet" }, note),
      );
    this.root = element(
      "div",
      { class: "residuals" },
      this.words,
      figure(
        "Law over the data",
        this.loop,
        "Means of each penetration. Lines: the law; dots: the data. Out of the tissue: dashed, and open dots.",
      ),
      figure("Residual over time", this.time, "Smallest to largest of each stretch."),
      figure("Residual over penetration", this.penetration, "Mean, and one standard deviation about it."),
    );
  }

  end(): void {
    for (const plot of [this.time, this.penetration, this.loop]) plot.end();
  }

  show(of: Residuals): void {
    this.residuals = of;
    const [error, worst, jnd] = [of.rmse, of.worst, of.jnd_n].map((it) => withUnit(it, of.force_unit));
    this.words.textContent = `Error ${error} (${plain(of.rmse / of.jnd_n, 2)} JND), largest ${worst}, over ${of.rows} rows. JND ${jnd}.`;
    const over_time: Limits = { x: ends(of.time_s), y: aboutZero(of, [...of.smallest, ...of.largest]) };
    this.time.show([], over_time);
    const over_depth: Limits = { x: ends(of.penetration), y: aboutZero(of, [...of.low, ...of.high]) };
    this.penetration.show([{ x: of.penetration, y: of.mean, class: "residual" }], over_depth);
    const x = of.penetration;
    const lines = [
      { x, y: of.loop.law_closing, class: "law closing" },
      { x, y: of.loop.law_opening, class: "law opening" },
    ];
    const data = [of.loop.measured_closing, of.loop.measured_opening].map((y) => ({ x, y, class: "" }));
    this.loop.show(lines, XyPlot.around([...lines, ...data]));
  }

  private drawLoop(): void {
    const of = this.residuals;
    if (!of) return;
    const dots = (kind: string, forces: readonly (number | null)[]): SVGElement[] =>
      forces.flatMap((force, i) => {
        const x = of.penetration[i];
        if (force === null || x === undefined) return [];
        return [drawn("circle", { class: `measured ${kind}`, cx: this.loop.x(x), cy: this.loop.y(force), r: 4 })];
      });
    this.loop.layer.replaceChildren(
      ...dots("closing", of.loop.measured_closing),
      ...dots("opening", of.loop.measured_opening),
    );
  }

  private drawTime(): void {
    const of = this.residuals;
    if (!of) return;
    this.time.ground.replaceChildren(...jndBand(this.time, of.jnd_n));
    // A stretch that is a single value would be an area of nothing.
    const path = bandPath(this.time, of.time_s, of.smallest, of.largest);
    this.time.layer.replaceChildren(drawn("path", { class: "extremes", d: path }));
  }

  private drawPenetration(): void {
    const of = this.residuals;
    if (!of) return;
    const path = bandPath(this.penetration, of.penetration, of.low, of.high);
    this.penetration.ground.replaceChildren(
      ...jndBand(this.penetration, of.jnd_n),
      drawn("path", { class: "deviation", d: path }),
    );
  }
}
