import { element } from "./dom";
import { tableMenu } from "./plot/out/export_menu";

export interface Column<Row> {
  head: string;
  text: (row: Row) => string;
  key: (row: Row) => number | string; // to sort by, and in files
  file?: string; // the head there, with the unit of the key
}

/** A table that is sorted by a press on a head; its first column opens the row. */
export class SortableTable<Row> {
  readonly root: HTMLElement;
  private readonly body = element("tbody");
  private readonly heads: HTMLTableCellElement[];
  private by = -1;
  private down = false;

  constructor(
    caption: string,
    private readonly columns: readonly Column<Row>[],
    private readonly rows: readonly Row[],
    private readonly open: (row: Row) => void,
  ) {
    this.heads = columns.map((column, i) => {
      const sort = element("button", { type: "button", class: "link", click: () => this.sort(i) }, column.head);
      const file = column.file === undefined ? {} : { "data-head": column.file };
      return element("th", { scope: "col", "aria-sort": "none", ...file, ...this.numeric(i) }, sort);
    });
    const table = element(
      "table",
      {},
      element("caption", {}, caption),
      element("thead", {}, element("tr", {}, ...this.heads)),
      this.body,
    );
    this.root = element("div", {}, element("div", { class: "scrolled" }, table), tableMenu(table, caption));
    this.sort(0);
  }

  private numeric(column: number): { class?: string } {
    const first = this.rows[0];
    return first !== undefined && typeof this.columns[column]?.key(first) === "number" ? { class: "number" } : {};
  }

  private sort(column: number): void {
    this.down = column === this.by && !this.down;
    this.by = column;
    this.heads.forEach((head, i) =>
      head.setAttribute("aria-sort", i !== column ? "none" : this.down ? "descending" : "ascending"),
    );
    const key = this.columns[column]?.key;
    if (!key) return;
    const order = [...this.rows].sort((a, b) => {
      const [one, other] = [key(a), key(b)];
      const less =
        typeof one === "string" ? one.localeCompare(String(other), "en", { numeric: true }) : one - Number(other);
      return this.down ? -less : less;
    });
    this.body.replaceChildren(...order.map((row) => this.row(row)));
  }

  private row(row: Row): HTMLTableRowElement {
    return element(
      "tr",
      {},
      ...this.columns.map((column, i) => {
        const key = column.key(row);
        const value = typeof key === "number" ? { "data-value": Number.isFinite(key) ? String(key) : "" } : {};
        if (i > 0) return element("td", { ...this.numeric(i), ...value }, column.text(row));
        return element(
          "th",
          { scope: "row" },
          element("button", { type: "button", class: "link", click: () => this.open(row) }, column.text(row)),
        );
      }),
    );
  }
}
