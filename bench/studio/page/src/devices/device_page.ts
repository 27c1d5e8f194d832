import type { DescribedChart, DeviceAxis, DeviceFile, DeviceNumber, Estimate } from "../api/results";
import { element, table } from "../ui/dom";
import { withUnit } from "../ui/numbers";
import { Plot } from "../ui/plot/plot";
import { intervalBar, reachOf } from "../results/interval_bar";

/** "the model fits: this model predicts the device to 2.1 %", or why that cannot be said. */
function verdictOf(axis: DeviceAxis): string {
  if (axis.fits === undefined) return "Nothing was found.";
  const verdict = axis.verdict ?? "";
  if (axis.fits === null) return `Unknown whether the model fits${verdict ? `: ${verdict}` : ""}.`;
  return `The model ${axis.fits ? "fits" : "does not fit"}: ${verdict || "no other data to try it on"}.`;
}

/** What the bars are drawn of; nothing where no interval is known. */
function estimateOf({ value, lower, upper, unit }: DeviceNumber): Estimate | null {
  if (value === null || lower === null || upper === null || lower === upper) return null;
  return { value, std_error: null, unit, ci95: [lower, upper] };
}

function numberTable(axis: string, numbers: readonly DeviceNumber[]): HTMLElement {
  const reach = reachOf(numbers.map(estimateOf).filter((it) => it !== null));
  const rows = numbers.map((it) => {
    const estimate = estimateOf(it);
    const interval = estimate ? `${withUnit(it.lower, it.unit, 4)} to ${withUnit(it.upper, it.unit, 4)}` : "";
    return [
      it.name,
      it.value === null ? "unknown" : withUnit(it.value, it.unit, 4),
      interval,
      estimate ? intervalBar(estimate, reach) : "",
    ];
  });
  const all = table(
    `Numbers of axis ${axis}`,
    ["number", "value", "interval of 95 %", `its bar, ± ${100 * reach} % of the value`],
    rows,
  );
  return element(
    "div",
    { class: "scrolled", tabindex: 0, role: "region", "aria-label": `Numbers of axis ${axis}` },
    all,
  );
}

function words(lines: readonly string[]): HTMLElement {
  return element("ul", { class: "words" }, ...lines.map((it) => element("li", {}, it)));
}

/** A device as `kerf identify` found it: of each axis the verdict, the numbers, and every chart that the file describes. */
export class DevicePage {
  readonly root = element("div", { class: "device" });
  private readonly plots: Plot[] = [];

  constructor(of: DeviceFile) {
    const how = of.held ? "held in a hand: mass and friction are those of both" : "nobody held it";
    this.root.append(element("p", { class: "quiet" }, `${of.device}, ${of.model}; ${how}.`));
    for (const axis of of.axes) this.root.append(this.axis(axis));
    if (of.charts) this.root.append(this.charts(of.charts));
  }

  end(): void {
    for (const it of this.plots) it.end();
  }

  private axis(axis: DeviceAxis): HTMLElement {
    return element(
      "section",
      { class: "axis_of_device", "aria-label": `Axis ${axis.name}` },
      element("h2", {}, `Axis ${axis.name}`),
      element("p", { class: axis.fits === false ? "verdict wrong" : "verdict" }, verdictOf(axis)),
      axis.problem ? element("p", { class: "wrong" }, axis.problem) : null,
      axis.why_not && axis.why_not.length > 0 ? words(axis.why_not) : null,
      axis.numbers ? numberTable(axis.name, axis.numbers) : null,
      axis.charts ? this.charts(axis.charts) : null,
      axis.z_width ? element("h3", {}, "Z-width") : null,
      axis.z_width ? words(axis.z_width.in_words) : null,
    );
  }

  private charts(described: readonly DescribedChart[]): HTMLElement {
    const figures = described.map(({ name, figure }) => {
      const title = figure.title || name;
      const plot = new Plot(title);
      this.plots.push(plot);
      plot.show(figure);
      return plot.figure(title);
    });
    return element("div", { class: "charts" }, ...figures);
  }
}
