import type { LoopStatus, Percentiles } from "../api/loop";
import { element } from "../ui/dom";
import { plain } from "../ui/numbers";

const shares: readonly [keyof Percentiles, string][] = [
  ["p50", "median"],
  ["p99", "99 %"],
  ["p999", "99.9 %"],
  ["max", "max"],
];

/** How well the loop keeps time, in a table that never changes its size. */
export class ScopeFigures {
  readonly root: HTMLElement;
  private readonly cells = new Map<string, HTMLElement>();

  constructor() {
    const cell = (name: string): HTMLElement => {
      const node = element("td", { class: "number" }, "–");
      this.cells.set(name, node);
      return node;
    };
    const row = (head: string, name: string): HTMLElement =>
      element("tr", {}, element("th", { scope: "row" }, head), ...shares.map(([share]) => cell(`${name} ${share}`)));
    const heads = shares.map(([, text]) => element("th", { scope: "col", class: "number" }, text));
    this.root = element(
      "div",
      { class: "figures" },
      element(
        "table",
        {},
        element("caption", {}, "Timing of the last ten seconds [µs]"),
        element("thead", {}, element("tr", {}, element("td", {}), ...heads)),
        element("tbody", {}, row("wake", "wake"), row("cycle", "cycle")),
      ),
      element(
        "table",
        {},
        element("caption", { class: "unseen" }, "Counts since the start"),
        element(
          "thead",
          {},
          element(
            "tr",
            {},
            ...["ticks", "missed", "rows lost"].map((it) => element("th", { scope: "col", class: "number" }, it)),
          ),
        ),
        element("tbody", {}, element("tr", {}, cell("ticks"), cell("missed"), cell("lost"))),
      ),
    );
  }

  show(status: LoopStatus): void {
    for (const [share] of shares) {
      this.put(`wake ${share}`, status.running ? microseconds(status.wake_s[share]) : "–");
      this.put(`cycle ${share}`, status.running ? microseconds(status.cycle_s[share]) : "–");
    }
    this.put("ticks", status.ticks.toLocaleString("en-GB"));
    this.put("missed", status.missed.toLocaleString("en-GB"), status.missed > 0);
    this.put("lost", status.rows_lost.toLocaleString("en-GB"), status.rows_lost > 0);
  }

  private put(name: string, text: string, alarming = false): void {
    const cell = this.cells.get(name);
    if (!cell) return;
    if (cell.textContent !== text) cell.textContent = text;
    cell.classList.toggle("alarming", alarming);
  }
}

function microseconds(seconds: number | null): string {
  return seconds === null ? "–" : plain(seconds * 1e6, 3);
}
