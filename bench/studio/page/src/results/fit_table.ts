import type { FitFile, LawFit } from "../api/results";
import { element } from "../ui/dom";
import { plain, withUnit } from "../ui/numbers";
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

function head(text: string, number = true): HTMLTableCellElement {
  return element("th", { scope: "col", ...(number ? { class: "number" } : {}) }, text);
}

function cell(text: string): HTMLTableCellElement {
  return element("td", { class: "number" }, text);
}

/** Every law that was fitted, the least error first; one of them is looked at. */
export class FitTable {
  readonly root: HTMLElement;
  private readonly rows = new Map<string, HTMLTableRowElement>();

  constructor(file: FitFile, choose: (fit: LawFit) => void) {
    const unit = file.force_unit ?? "N";
    const sorted = [...file.fits].sort((a, b) => errorOf(a) - errorOf(b));
    const body = element("tbody");
    for (const fit of sorted) {
      const open = element("button", { type: "button", class: "link", click: () => choose(fit) }, fit.model);
      const marks = [
        fit.model === file.choice.model ? choiceMark(file) : "",
        fit.converged ? "" : "did not converge",
      ].filter(Boolean);
      const row = element(
        "tr",
        {},
        element("th", { scope: "row" }, open),
        cell(String(fit.free_parameters)),
        cell(withUnit(fit.rmse, unit)),
        cell(withUnit(fit.cv_rmse, unit)),
        cell(withUnit(fit.cv_rmse_rendered, unit)),
        cell(plain(errorOf(fit) / file.jnd, 2)),
        cell(fit.bic.toFixed(0).replace("-", "−")),
        element("td", {}, marks.join(", ")),
      );
      row.classList.toggle("taken", fit.model === file.choice.model);
      this.rows.set(fit.model, row);
      body.append(row);
    }
    this.root = element(
      "div",
      { class: "scrolled" },
      element(
        "table",
        { class: "fits" },
        element("caption", {}, "Laws compared"),
        element(
          "thead",
          {},
          element(
            "tr",
            {},
            head("law", false),
            head("free"),
            head("error"),
            head("held out"),
            head("as rendered"),
            head("in JNDs"),
            head("BIC"),
            head("", false),
          ),
        ),
        body,
      ),
    );
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
      cell(estimate.value.toPrecision(5)),
      element("td", {}, estimate.unit),
      cell(interval),
      element("td", {}, intervalBar(estimate, reach)),
    );
  });
  const more = all.length - maxShown;
  return element(
    "div",
    { class: "scrolled", tabindex: 0, role: "region", "aria-label": `Parameters of ${fit.model}` },
    element(
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
          head(`−${100 * reach} % to +${100 * reach} %`, false),
        ),
      ),
      element("tbody", {}, ...rows),
    ),
    more > 0 ? element("p", { class: "quiet" }, `and ${more} more, in the law file`) : null,
  );
}
