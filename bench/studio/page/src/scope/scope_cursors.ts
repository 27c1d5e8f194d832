import { button, element } from "../ui/dom";
import { asDrawn, plain, withUnit } from "../ui/numbers";
import { columnAt, type TimeLine } from "../ui/time/time_line";
import type { TimeStack } from "../ui/time/time_stack";
import { middle } from "./views/xy_view";

const names = ["A", "B"] as const;
type Name = (typeof names)[number];

/** Two cursors that stay at their time, and what lies between them. */
export class ScopeCursors {
  readonly root: HTMLElement;
  private readonly at: Record<Name, number | null> = { A: null, B: null };
  private readonly body = element("tbody");
  private readonly between = element("p", { class: "scope_reading" });
  private readonly table: HTMLElement;
  private lines: readonly TimeLine[] = [];
  private cells: HTMLElement[][] = [];

  constructor(private readonly stack: TimeStack) {
    const heads = ["", "A", "B", "B − A"].map((it) => element("th", { scope: "col", class: it ? "number" : "" }, it));
    this.table = element(
      "table",
      { hidden: true },
      element("caption", { class: "unseen" }, "Values at the cursors"),
      element("thead", {}, element("tr", {}, ...heads)),
      this.body,
    );
    this.root = element(
      "div",
      { class: "scope_cursors" },
      element(
        "div",
        { class: "row" },
        ...names.map((it) =>
          button(`${it} here`, () => this.put(it), { title: `${it.toLowerCase()}: at the pointer`, class: "small" }),
        ),
        button("No cursors", () => this.clear(), { class: "small" }),
      ),
      this.between,
      this.table,
    );
  }

  offer(lines: readonly TimeLine[]): void {
    this.lines = lines;
    this.cells = lines.map(() => [0, 1, 2].map(() => element("td", { class: "number" }, "–")));
    this.body.replaceChildren(
      ...lines.map((it, k) => element("tr", {}, element("th", { scope: "row" }, it.name), ...this.cells[k]!)),
    );
    this.draw();
  }

  /** At the pointer, or in the middle of what is shown. */
  put(name: Name): void {
    const { cursor, from, to } = this.stack.range;
    this.at[name] = cursor ?? 0.5 * (from + to);
    this.draw();
  }

  clear(): void {
    this.at.A = this.at.B = null;
    this.draw();
  }

  /** Lines over the plots in their places, and the numbers. */
  draw(): void {
    const { A: a, B: b } = this.at;
    for (const over of this.stack.root.querySelectorAll<HTMLElement>(".time_over"))
      for (const it of names) this.mark(over, it);
    this.table.hidden = a === null && b === null;
    const apart = a !== null && b !== null ? b - a : null;
    const text =
      apart === null
        ? ""
        : `B − A: ${withUnit(apart, "s", 5)}${apart !== 0 ? `, 1 / that: ${plain(1 / Math.abs(apart), 4)} Hz` : ""}`;
    if (this.between.textContent !== text) this.between.textContent = text;
    if (this.table.hidden) return;
    this.lines.forEach((line, k) => {
      const values = [a, b].map((at) => valueAt(line, at));
      const [first = null, second = null] = values;
      const texts = [...values, first !== null && second !== null ? second - first : null];
      texts.forEach((value, i) => {
        const written = asDrawn(value, line.unit, 4);
        const cell = this.cells[k]?.[i];
        if (cell && cell.textContent !== written) cell.textContent = written;
      });
    });
  }

  private mark(over: HTMLElement, name: Name): void {
    let line = over.querySelector<HTMLElement>(`.scope_cursor.is_${name}`);
    const { from, to, span } = this.stack.range;
    const at = this.at[name];
    const seen = at !== null && at >= from && at <= to;
    if (!line && !seen) return;
    if (!line) over.append((line = element("div", { class: `scope_cursor is_${name}`, "aria-hidden": "true" }, name)));
    line.hidden = !seen;
    if (seen) line.style.transform = `translateX(${Math.round(((at - from) / span) * over.clientWidth)}px)`;
  }
}

function valueAt(line: TimeLine, at: number | null): number | null {
  const column = at === null ? -1 : columnAt(line, at);
  return column < 0 ? null : middle(line, column);
}
