import type { Knots } from "../../api/editor";
import { button, element } from "../../ui/dom";
import type { Drawing } from "../drawing";
import { faultOf } from "../knots";
import { asField, type Scale } from "../scale";

type Column = keyof Knots;

/** The breakpoints as numbers that can be changed. */
export class KnotTable {
  readonly root = element("div", { class: "card knot_table" });
  private inputs: Record<Column, HTMLInputElement[]> = { penetration: [], closing: [], opening: [] };

  constructor(
    private readonly drawing: Drawing,
    private readonly settled: () => void,
    private readonly refuse: (why: string) => void,
  ) {}

  show(): void {
    const { knots } = this.drawing;
    for (const column of ["penetration", "closing", "opening"] as const) {
      if (this.inputs[column].length !== knots[column].length) return this.build();
    }
    this.fill();
  }

  private scale(column: Column): Scale {
    return column === "penetration" ? this.drawing.position : this.drawing.force;
  }

  private fill(): void {
    for (const column of ["penetration", "closing", "opening"] as const) {
      this.inputs[column].forEach((input, i) => {
        const text = asField(this.drawing.knots[column][i]!, this.scale(column));
        if (document.activeElement !== input || Number(input.value) !== Number(text)) input.value = text;
      });
    }
  }

  private build(): void {
    const { knots, hasOpening } = this.drawing;
    const columns: Column[] = hasOpening ? ["penetration", "closing", "opening"] : ["penetration", "closing"];
    const heads = { penetration: "Penetration", closing: "Closing force", opening: "Opening force" };
    this.inputs = { penetration: [], closing: [], opening: [] };
    const rows = knots.penetration.map((_, i) =>
      element(
        "tr",
        {},
        element("th", { scope: "row" }, String(i + 1)),
        ...columns.map((column) =>
          element(
            "td",
            {},
            this.input(column, i, `${heads[column]} of breakpoint ${i + 1} in ${this.scale(column).unit}`),
          ),
        ),
        element(
          "td",
          {},
          button("Remove", () => this.remove(i), {
            "aria-label": `Remove breakpoint ${i + 1}`,
            disabled: knots.penetration.length <= 2,
          }),
        ),
      ),
    );
    this.root.replaceChildren(
      element(
        "table",
        {},
        element("caption", {}, "Breakpoints"),
        element(
          "thead",
          {},
          element(
            "tr",
            {},
            element("th", { scope: "col" }, "No."),
            ...columns.map((it) => element("th", { scope: "col" }, `${heads[it]} [${this.scale(it).unit}]`)),
            element("td", {}),
          ),
        ),
        element("tbody", {}, ...rows),
      ),
    );
    this.fill();
  }

  private input(column: Column, index: number, name: string): HTMLInputElement {
    const input = element("input", {
      type: "number",
      step: "any",
      "aria-label": name,
      change: () => this.take(column, index, input),
    });
    this.inputs[column].push(input);
    return input;
  }

  private take(column: Column, index: number, input: HTMLInputElement): void {
    const value = input.value.trim() === "" ? NaN : Number(input.value) / this.scale(column).perUnit;
    const knots = {
      ...this.drawing.knots,
      [column]: this.drawing.knots[column].map((it, i) => (i === index ? value : it)),
    };
    const fault = faultOf(knots);
    if (fault) {
      this.refuse(fault);
      input.value = "";
      return this.fill();
    }
    this.drawing.set(knots);
    this.settled();
  }

  private remove(index: number): void {
    if (!this.drawing.remove(index)) return;
    this.settled();
    this.inputs.penetration[Math.min(index, this.inputs.penetration.length - 1)]?.focus();
  }
}
