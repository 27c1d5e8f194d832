import type { Estimate, FitFile, LawFit } from "../api/results";
import { button, element, numberCell } from "../ui/dom";
import { plain } from "../ui/numbers";
import { csvOf, type CsvColumn } from "../ui/plot/out/csv_file";
import { download, fileName } from "../ui/plot/out/download";
import { tableMenu } from "../ui/plot/out/export_menu";
import { atMostCompared } from "./compared/compared_law";
import { intervalBar, intervalOf, reachOf } from "./interval_bar";

const maxShown = 40;
const entangled = 0.95; // correlations beyond it are told

/** What a law errs by where it was not fitted, as a loop renders it; without folds, where it was. */
export function errorOf(fit: LawFit): number {
  return fit.cv_rmse_rendered ?? fit.cv_rmse ?? fit.rmse;
}

/** What is said of the law that was chosen: it serves only where its error on held-out data is within the JND. */
export function choiceMark(file: FitFile): string {
  const chosen = file.fits.find((it) => it.model === file.choice.model);
  if (!chosen) return "";
  const within = file.choice.within_jnd ?? (chosen.cv_rmse === null ? null : errorOf(chosen) <= file.jnd);
  if (within === null) return "least BIC, nothing held out";
  return within ? "simplest within the JND" : "as good as the best, not within the JND";
}

/** Why a law is not chosen, however small its error. */
function againstIt(fit: LawFit): string[] {
  return [
    fit.converged ? "" : "did not converge",
    fit.r2 < 0 ? "worse than the mean" : "",
    (fit.free_fraction ?? 0) > 0.5 ? "felt in free air" : "",
    (fit.undetermined_arms ?? 0) > 0 ? "an arm not told" : "",
  ].filter(Boolean);
}

/** `file`: what the head is called in a file, with its unit. */
function head(text: string, number = true, file = text): HTMLTableCellElement {
  return element("th", { scope: "col", "data-head": file, ...(number ? { class: "number" } : {}) }, text);
}

function cell(text: string): HTMLTableCellElement {
  return element("td", { class: "number" }, text);
}

/** What laws are held against: a straight line, which any law has to beat, and what hardly any can. */
function references({ line_rmse, line_cv_rmse, floor, jnd }: FitFile): HTMLTableRowElement[] {
  const row = (name: string, free: number | null, errors: readonly (number | null)[], remark: string) => {
    const error = errors[1] ?? errors[0] ?? null; // where it was held out, as that of a law
    const jnds = error === null ? null : error / jnd;
    return element(
      "tr",
      { class: "reference" },
      element("td", {}),
      element("th", { scope: "row" }, name),
      free === null ? cell("") : numberCell(String(free), free),
      ...errors.map((it) => (it === null ? cell("") : numberCell(plain(it), it))),
      jnds === null ? cell("") : numberCell(plain(jnds, 2), jnds),
      cell(""),
      element("td", {}, remark),
    );
  };
  return [
    row("straight line", 2, [line_rmse, line_cv_rmse ?? null, null], "of force over position"),
    floor?.velocity == null ? null : row("floor", null, [null, floor.velocity, null], "best map of position and speed"),
  ].filter((it) => it !== null);
}

/** Every law that was fitted, the least error first; one of them is looked at. */
export class FitTable {
  readonly root: HTMLElement;
  private readonly rows = new Map<string, HTMLTableRowElement>();

  /** The laws as they stand, the least error first. */
  readonly order: readonly LawFit[];
  private readonly boxes = new Map<string, HTMLInputElement>();

  constructor(
    file: FitFile,
    choose: (fit: LawFit) => void,
    private readonly compared: () => void,
  ) {
    const unit = file.force_unit ?? "N";
    const sorted = (this.order = [...file.fits].sort((a, b) => errorOf(a) - errorOf(b)));
    const body = element("tbody");
    for (const fit of sorted) {
      const open = element("button", { type: "button", class: "link", click: () => choose(fit) }, fit.model);
      const chosen = fit.model === file.choice.model;
      const marks = [chosen ? choiceMark(file) : "", ...againstIt(fit)].filter(Boolean);
      const box = element("input", {
        type: "checkbox",
        "aria-label": `Draw ${fit.model}`,
        change: () => this.ticking(box),
      });
      this.boxes.set(fit.model, box);
      const row = element(
        "tr",
        {},
        element("td", {}, box),
        element("th", { scope: "row" }, open),
        numberCell(String(fit.free_parameters), fit.free_parameters),
        ...[fit.rmse, fit.cv_rmse, fit.cv_rmse_rendered].map((it) => numberCell(plain(it), it)),
        numberCell(plain(errorOf(fit) / file.jnd, 2), errorOf(fit) / file.jnd),
        numberCell(fit.bic.toFixed(0).replace("-", "−"), fit.bic),
        element("td", {}, marks.join(", ")),
      );
      row.classList.toggle("taken", chosen);
      this.rows.set(fit.model, row);
      body.append(row);
    }
    const table = element(
      "table",
      { class: "fits" },
      element("caption", {}, "Laws compared"),
      element(
        "thead",
        {},
        element(
          "tr",
          {},
          element("th", { scope: "col", "data-head": "" }, element("span", { class: "unseen" }, "draw")),
          head("law", false),
          head("free", true, "free parameters"),
          head(`error [${unit}]`),
          head(`held out [${unit}]`, true, `held-out error [${unit}]`),
          head(`held out as rendered [${unit}]`, true, `held-out error as rendered [${unit}]`),
          head("in JNDs", true, "error [JND]"),
          head("BIC"),
          head("", false, "remarks"),
        ),
      ),
      body,
      element("tfoot", {}, ...references(file)),
    );
    this.root = element(
      "div",
      { class: "fits_table" },
      element("div", { class: "scrolled" }, table),
      tableMenu(table, `fits-${file.recordings[0]?.name ?? ""}`),
    );
  }

  /** The laws that are drawn, in the order of the table. */
  get ticked(): string[] {
    return this.order.map((it) => it.model).filter((it) => this.boxes.get(it)?.checked);
  }

  tick(models: readonly string[]): void {
    for (const [model, box] of this.boxes) box.checked = models.includes(model);
  }

  /** One is drawn always, and not more than can be told apart. */
  private ticking(box: HTMLInputElement): void {
    const count = this.ticked.length;
    if (count === 0 || count > atMostCompared) box.checked = !box.checked;
    else this.compared();
  }

  mark(model: string): void {
    for (const [name, row] of this.rows) {
      row.classList.toggle("looked_at", name === model);
      row.querySelector("button")?.setAttribute("aria-pressed", String(name === model));
    }
  }
}

/** "piecewise: knot[1] and closing[1] go together (0.99)": neither is known by itself. */
export function entanglements(fit: LawFit): string[] {
  const { parameters, matrix } = fit.correlation;
  const found: { text: string; size: number }[] = [];
  for (let i = 0; i < parameters.length; ++i) {
    for (let j = 0; j < i; ++j) {
      const value = matrix[i]?.[j];
      if (value == null || Math.abs(value) <= entangled) continue;
      found.push({ text: `${parameters[j]} and ${parameters[i]} (${value.toFixed(3)})`, size: Math.abs(value) });
    }
  }
  return found.sort((a, b) => b.size - a.size).map((it) => it.text);
}

/** Value, unit and interval of each parameter, as numbers and as a bar. */
export function parameterTable(fit: LawFit): HTMLElement {
  const all = Object.entries(fit.parameters);
  const name = all[0] ? intervalOf(all[0][1]).name.replace("ci", "") : "95";
  const reach = reachOf(all.map(([, estimate]) => estimate));
  const rows = all.slice(0, maxShown).map(([parameter, estimate]) => {
    const { lower, upper } = intervalOf(estimate);
    const interval =
      lower === null || upper === null ? "not determined" : `${lower.toPrecision(4)} to ${upper.toPrecision(4)}`;
    return element(
      "tr",
      {},
      element("th", { scope: "row" }, parameter),
      numberCell(estimate.value.toPrecision(5), estimate.value),
      element("td", {}, estimate.unit),
      cell(interval),
      element("td", {}, intervalBar(estimate, reach)),
    );
  });
  const more = all.length - maxShown;
  const table = element(
    "table",
    {},
    element("caption", {}, `Parameters of ${fit.model}`),
    element(
      "thead",
      {},
      element(
        "tr",
        {},
        head("parameter", false),
        head("value"),
        head("unit", false),
        head(`${name} % interval`),
        head(`−${100 * reach} % to +${100 * reach} %`, false, ""),
      ),
    ),
    element("tbody", {}, ...rows),
  );
  const save = button(
    "Save CSV",
    () => download(csvOf(parameterColumns(all, name)), fileName(`parameters ${fit.model}`, "csv")),
    {
      class: "small",
      "aria-label": `Save the parameters of ${fit.model} as CSV`,
    },
  );
  return element(
    "div",
    {},
    element(
      "div",
      { class: "scrolled", tabindex: 0, role: "region", "aria-label": table.caption?.textContent ?? "" },
      table,
    ),
    more > 0 ? element("p", { class: "quiet" }, `and ${more} more, in the law file`) : null,
    save,
  );
}

/** All of them, with their ends apart. */
function parameterColumns(all: readonly [string, Estimate][], name: string): CsvColumn[] {
  const interval = all.map(([, it]) => intervalOf(it));
  return [
    { head: "parameter", cells: all.map(([it]) => it) },
    { head: "value", cells: all.map(([, it]) => it.value) },
    { head: "unit", cells: all.map(([, it]) => it.unit) },
    { head: "standard error", cells: all.map(([, it]) => it.std_error) },
    { head: `lower end of ${name} %`, cells: interval.map((it) => it.lower) },
    { head: `upper end of ${name} %`, cells: interval.map((it) => it.upper) },
  ];
}
