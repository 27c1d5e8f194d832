import type { Axis } from "../api/recordings";
import { element, labelled, select } from "../ui/dom";

type Value = number | string | boolean | string[];
type Read = () => Value | null; // null: as `kerf fit` has it

/** What `kerf fit` can be asked for beside laws and axis, by its names; what is left empty is as the program has it. */
export class FitOptions {
  readonly root: HTMLElement;
  private readonly reads = new Map<string, Read>();

  constructor(axis: Axis | undefined) {
    const position = axis?.position_unit ?? "m";
    const force = axis?.force_unit ?? "N";
    const folds = this.number("folds", "Folds that are held out by turns (0: none)", {
      min: 0,
      max: 100,
      step: 1,
      value: 5,
    });
    this.root = element(
      "div",
      { class: "fit_options" },
      element("div", { class: "row" }, folds),
      element(
        "details",
        {},
        element("summary", {}, "More options"),
        this.group(
          "Rows",
          this.choice("rows", "Rows that count", ["contact", "all"]),
          this.text("cycles", "Cycles: good, all or 2-8,10", "good"),
          this.number("contact", `Contact at [${position}]`),
          this.choice("direction", "Tool goes in where the position is", ["", "increasing", "decreasing"]),
          this.number("noise", `Noise of the force [${force}]`, { min: 0 }),
        ),
        this.group(
          "Laws",
          this.text("segments", "Segments of the piecewise law: 1 to 16, bic, jnd", "5"),
          this.number("points_per_segment", "Fewest samples in a segment", { min: 1, step: 1 }),
          this.list("breakpoints", "Inner breakpoints: 3,7.5mm,12", ","),
          this.number("arms", "Arms of the Maxwell law, 1 to 6", { min: 1, max: 6, step: 1 }),
          this.number("memberships", "Memberships of fuzzy laws, 1 to 5", { min: 1, max: 5, step: 1 }),
          this.number("thickness", `Thickness of the sample [${position}]`, { min: 0 }),
          this.list("option", "Options of laws: NAME=VALUE, by spaces", " "),
        ),
        this.group(
          "Judging",
          this.number("test_share", "Last share that no fit sees, 0 to 0.9", { min: 0, max: 0.9 }),
          this.number("confidence", "Confidence of intervals, 0.5 to 0.9999", { min: 0.5, max: 0.9999 }),
          this.choice("loss", "Loss of residuals", ["squares", "huber", "soft_l1", "cauchy"]),
          this.number("loss_scale", `Scale of a robust loss [${force}]`, { min: 0 }),
          this.flag("profile", "Intervals from the profile too"),
          this.number("rate", "Rate of the loop [Hz]", { min: 100, max: 10000 }),
          this.number("weber", "JND: Weber fraction", { min: 0, max: 1 }),
          this.number("threshold", `JND: threshold [${force}]`, { min: 0 }),
        ),
      ),
    );
  }

  /** For the order: only what was given. */
  get given(): Record<string, Value> {
    const found: Record<string, Value> = {};
    for (const [name, read] of this.reads) {
      const value = read();
      if (value !== null) found[name] = value;
    }
    return found;
  }

  private group(title: string, ...fields: HTMLElement[]): HTMLElement {
    return element("fieldset", {}, element("legend", {}, title), ...fields);
  }

  private number(name: string, label: string, limits: Record<string, number> = {}): HTMLElement {
    const input = element("input", { type: "number", step: "any", ...limits });
    this.reads.set(name, () => (input.value === "" ? null : Number(input.value)));
    return labelled(label, input);
  }

  private text(name: string, label: string, standard: string): HTMLElement {
    const input = element("input", { type: "text", placeholder: standard, autocomplete: "off", spellcheck: "false" });
    this.reads.set(name, () => input.value.trim() || null);
    return labelled(label, input);
  }

  private list(name: string, label: string, between: string): HTMLElement {
    const input = element("input", { type: "text", autocomplete: "off", spellcheck: "false" });
    this.reads.set(name, () => {
      const parts = input.value
        .split(between)
        .map((it) => it.trim())
        .filter(Boolean);
      return parts.length > 0 ? parts : null;
    });
    return labelled(label, input);
  }

  private choice(name: string, label: string, values: readonly string[]): HTMLElement {
    const standard = values[0] ?? "";
    const input = select(
      values.map((it) => ({ value: it, text: it || "as known" })),
      standard,
      () => {},
    );
    this.reads.set(name, () => (input.value === standard ? null : input.value));
    return labelled(label, input);
  }

  private flag(name: string, label: string): HTMLElement {
    const box = element("input", { type: "checkbox" });
    this.reads.set(name, () => (box.checked ? true : null));
    return element("label", { class: "tick" }, box, label);
  }
}
