import type { SweepAnswer, SweepAxis } from "../api/sweeps";
import { plain } from "../ui/numbers";

/** Where everything stands [px]. */
export interface Layout {
  width: number;
  height: number;
  across: number;
  panels: number;
  panelWidth: number;
  panelHeight: number;
  left: number;
  top: number;
}

export const gap = 14;
export const titleHeight = 22;

export function partsOf(axis: SweepAxis | undefined): number {
  if (!axis) return 1;
  return axis.names.length > 0 ? axis.names.length : Math.max(1, axis.edges.length - 1);
}

/** "0.001", or "0.1 to 0.2" of a stretch. */
export function partInWords(axis: SweepAxis, part: number): string {
  if (axis.names.length === 0) return `${plain(axis.edges[part])} to ${plain(axis.edges[part + 1])}`;
  const value = axis.values[part];
  return value === null || value === undefined ? shortName(axis.names[part] ?? "") : plain(value);
}

export function shortName(name: string): string {
  return name.replace(/^.*\//, "").replace(/\.h5$/, "") || "–";
}

export function withItsUnit(text: string, axis: SweepAxis): string {
  return axis.unit === "1" || axis.unit === "" ? text : `${text} ${axis.unit}`;
}

export function layoutOf(answer: SweepAnswer, width: number): Layout {
  const columns = partsOf(answer.axes[2]);
  const across = answer.axes.length === 3 && columns > 4 ? Math.ceil(columns / 2) : columns;
  const panels = columns * partsOf(answer.axes[3]);
  const left = 84;
  const panelWidth = Math.max(40, (width - left - 12 - gap * (across - 1)) / across);
  const ratio = partsOf(answer.axes[1]) / partsOf(answer.axes[0]);
  const panelHeight = Math.min(Math.max(panelWidth * Math.min(Math.max(ratio, 0.6), 0.9), 80), 420);
  const rows = Math.ceil(panels / across);
  return {
    width,
    height: rows * (panelHeight + titleHeight) + 48,
    across,
    panels,
    panelWidth,
    panelHeight,
    left,
    top: 2,
  };
}

/** One tile: which panel, column and row, counted from the bottom. */
export interface TilePlace {
  panel: number;
  column: number;
  row: number;
}

export function indexOf(answer: SweepAnswer, place: TilePlace): number {
  const [columns, rows] = [partsOf(answer.axes[0]), partsOf(answer.axes[1])];
  return (place.panel * rows + place.row) * columns + place.column;
}

export function boxOf(answer: SweepAnswer, layout: Layout, place: TilePlace): [number, number, number, number] {
  const [columns, rows] = [partsOf(answer.axes[0]), partsOf(answer.axes[1])];
  const left = layout.left + (place.panel % layout.across) * (layout.panelWidth + gap);
  const top = layout.top + titleHeight + Math.floor(place.panel / layout.across) * (layout.panelHeight + titleHeight);
  const width = layout.panelWidth / columns;
  const height = layout.panelHeight / rows;
  return [left + place.column * width, top + (rows - 1 - place.row) * height, width, height];
}

export function placeAt(answer: SweepAnswer, layout: Layout, x: number, y: number): TilePlace | null {
  for (let panel = 0; panel < layout.panels; ++panel) {
    const [left, lowest, width, height] = boxOf(answer, layout, { panel, column: 0, row: 0 });
    const column = Math.floor((x - left) / width);
    const row = Math.floor((lowest + height - y) / height);
    if (column >= 0 && row >= 0 && column < partsOf(answer.axes[0]) && row < partsOf(answer.axes[1]))
      return { panel, column, row };
  }
  return null;
}

/** "delay 0.001 s, stiffness 3000 N/m: 0.84; 50 of 50 cells known". */
export function tileInWords(answer: SweepAnswer, place: TilePlace): string {
  const at = indexOf(answer, place);
  const columns = partsOf(answer.axes[2]);
  const parts = [place.column, place.row, place.panel % columns, Math.floor(place.panel / columns)];
  const where = answer.axes.map((axis, i) => withItsUnit(`${axis.column} ${partInWords(axis, parts[i] ?? 0)}`, axis));
  const [computed, known] = [answer.computed[at] ?? 0, answer.known[at] ?? 0];
  const [failed, missing] = [answer.failed[at] ?? 0, answer.missing[at] ?? 0];
  const value = answer.value[at];
  const unit = answer.unit === "1" ? "" : ` ${answer.unit}`;
  const found = computed + failed + missing === 0 ? "no cell" : known === 0 ? "no number" : `${plain(value)}${unit}`;
  const counts = [`${known} of ${computed} computed cells have a number`];
  if (failed > 0) counts.push(`${failed} failed`);
  if (missing > 0) counts.push(`${missing} are missing`);
  return `${where.join(", ")}: ${found}; ${counts.join(", ")}`;
}
