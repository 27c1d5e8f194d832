import type { Figure, Numbers } from "../../figure_description";

/** A column of a table: its head with its unit, and what stands below. */
export interface CsvColumn {
  head: string;
  cells: readonly (number | string | null)[];
}

/** Numbers to their last digit; nothing where there is none. Texts as `kerf` writes them, in quotes only where it must be. */
function cellOf(value: number | string | null | undefined): string {
  if (value == null) return "";
  if (typeof value === "number") return Number.isFinite(value) ? String(value) : "";
  const text = value.replace(/[\r\n]+/g, " ");
  // What a spreadsheet would take for a formula is a text to it behind an apostrophe.
  const plain = /^[=+@]|^-(?![\d.])/.test(text) ? `'${text}` : text;
  return /[",#]/.test(plain) ? `"${plain.replaceAll('"', '""')}"` : plain;
}

export function csvOf(all: readonly CsvColumn[]): string {
  const rows = Math.max(0, ...all.map((it) => it.cells.length));
  const lines = [all.map((it) => cellOf(it.head)).join(",")];
  for (let row = 0; row < rows; ++row) lines.push(all.map((it) => cellOf(it.cells[row])).join(","));
  return `${lines.join("\r\n")}\r\n`;
}

/** "force [N]" and "kelvin": "force kelvin [N]". */
export function headOf(label: string, name: string): string {
  const [, what = label, unit = ""] = /^(.*?)\s*(\[.*\].*)?$/.exec(label) ?? [];
  return [what, name, unit].filter(Boolean).join(" ");
}

const same = (one: Numbers, other: Numbers): boolean =>
  one === other || (one.length === other.length && one.every((it, i) => it === other[i]));

/** What x stands for, where names stand below it in place of numbers. */
function namesOf({ x_ticks }: Figure, x: Numbers): Numbers | string[] {
  const names = x.map((at) => (at === null ? "" : (x_ticks?.find((tick) => tick.at === at)?.name ?? "0")));
  return names.some(Boolean) && names.every((it) => !it || Number.isNaN(Number(it))) ? names : x;
}

/** The numbers of figures: x once for all that share it, then what is drawn over it; maps as one row a cell. */
export function figureColumns(figures: readonly Figure[]): CsvColumn[] {
  const groups: {
    head: string;
    x: Numbers;
    each: number | undefined;
    cells: CsvColumn["cells"];
    columns: CsvColumn[];
  }[] = [];
  const add = (figure: Figure, x: Numbers, columns: CsvColumn[], each?: number): void => {
    const known = groups.find((it) => it.head === figure.x_label && it.each === each && same(it.x, x));
    if (known) known.columns.push(...columns);
    else groups.push({ head: figure.x_label, x, each, cells: namesOf(figure, x), columns });
  };
  figures.forEach((figure) => {
    for (const { x, low, high, label, name = label, extremes, each } of figure.areas ?? []) {
      const [least, most] = extremes ? ["smallest", "largest"] : ["lower", "upper"];
      if (extremes && same(low, high)) add(figure, x, [{ head: headOf(figure.y_label, name), cells: low }], each);
      else {
        const columns = [
          { head: headOf(figure.y_label, `${name} ${least}`.trim()), cells: low },
          { head: headOf(figure.y_label, `${name} ${most}`.trim()), cells: high },
        ];
        add(figure, x, columns, each);
      }
    }
    for (const { x, y, label, name = label } of figure.curves) {
      if (x.length > 0) add(figure, x, [{ head: headOf(figure.y_label, name), cells: y }]);
    }
  });
  return [
    ...groups.flatMap(({ head, x, each, cells, columns }) => [
      { head, cells },
      // In each row, since a table has no other place for it that every program reads.
      ...(each === undefined ? [] : [{ head: headOf(head, "covered by a row"), cells: x.map(() => each) }]),
      ...columns,
    ]),
    ...figures.flatMap(cellColumns),
  ];
}

function cellColumns({ cells, x_label, y_label }: Figure): CsvColumn[] {
  if (cells.kind.length === 0) return [];
  const { x_edges, y_edges, upwards, kinds } = cells;
  const [columns, rows] = [x_edges.length - 1, y_edges.length - 1];
  const place = (i: number): [number, number] =>
    upwards ? [Math.floor(i / rows), i % rows] : [i % columns, Math.floor(i / columns)];
  const edges = (of: number[], axis: 0 | 1, end: 0 | 1): number[] =>
    cells.kind.map((_, i) => of[place(i)[axis] + end]!);
  return [
    { head: headOf(x_label, "from"), cells: edges(x_edges, 0, 0) },
    { head: headOf(x_label, "to"), cells: edges(x_edges, 0, 1) },
    { head: headOf(y_label, "from"), cells: edges(y_edges, 1, 0) },
    { head: headOf(y_label, "to"), cells: edges(y_edges, 1, 1) },
    { head: "what", cells: cells.kind.map((it) => kinds[it]?.label ?? "") },
  ];
}

/** A table of the page, with the numbers that its cells stand for: `data-value` where a cell has one, `data-head` likewise. */
export function tableColumns(table: HTMLTableElement): CsvColumn[] {
  const heads = [...(table.tHead?.rows[0]?.cells ?? [])];
  const rows = [...table.tBodies, table.tFoot].flatMap((part) => [...(part?.rows ?? [])]);
  return heads.flatMap((head, i) => {
    const title = (head.dataset.head ?? head.textContent).trim();
    const cells = rows.map((row) => cellValue(row.cells[i]));
    return title || cells.some((it) => it !== null) ? [{ head: title, cells }] : [];
  });
}

function cellValue(cell: HTMLTableCellElement | undefined): number | string | null {
  if (!cell) return null;
  const { value } = cell.dataset;
  if (value === undefined) return cell.textContent.trim() || null;
  return value === "" ? null : Number(value);
}
