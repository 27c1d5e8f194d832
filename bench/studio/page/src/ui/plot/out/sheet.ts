import type { Figure } from "../../figure_description";
import { draw } from "../draw";
import { frameOf, limitsOf, outline, type Frame } from "../frame";
import { entriesOf, type Entry } from "../legend";
import { widthOf, type Shape } from "../shapes";
import { printStyle } from "../style";

/** What is handed out: one figure, or several above each other with one axis of x. */
export interface Sheet {
  name: string; // of the plot, as a person reads it
  figures: Figure[];
}

/** Widths of journals' columns; lengths of a printed sheet are points. */
export const columns = {
  one: { text: "one column, 88 mm", mm: 88 },
  two: { text: "two columns, 180 mm", mm: 180 },
} as const;
export type Column = keyof typeof columns;
export const pointsOf = (mm: number): number => (mm * 72) / 25.4;

/** A part of a printed sheet: what is cut off at a frame, and what is not. */
export interface Part {
  shapes: Shape[];
  clip: Frame | null;
  down: number; // of its upper edge
}
export interface Printed {
  title: string;
  notes: string[];
  width: number;
  height: number;
  parts: Part[];
}

/** A sheet as it is printed: letters of 8 pt, thin lines, dark on white, the legend below. */
export function printed(sheet: Sheet, column: Column): Printed {
  const width = pointsOf(columns[column].mm);
  const style = printStyle;
  const { figures } = sheet;
  const one = figures.length === 1;
  const high = one ? width * (column === "one" ? 0.72 : 0.5) : Math.max(64, (width * 0.9) / figures.length);
  const parts: Part[] = [];
  let down = 0;
  const bottom = (i: number): boolean => i === figures.length - 1;
  const limits = figures.map(limitsOf);
  const place = (i: number, left: number): Frame =>
    frameOf(figures[i]!, limits[i]!, width, high + (!one && bottom(i) ? 22 : 0), style, { left, timeAxis: bottom(i) });
  const left = Math.max(...figures.map((_, i) => place(i, 0).left));
  figures.forEach((figure, i) => {
    const frame = place(i, left);
    const { ground, axes, curves, over } = draw(figure, frame, style, bottom(i));
    parts.push({ shapes: ground, clip: frame, down }, { shapes: axes, clip: null, down });
    parts.push(
      { shapes: [...curves, ...spotsOf(figure, frame)], clip: frame, down },
      { shapes: over, clip: null, down },
    );
    down += frame.height;
  });
  const legend = legendOf(uniqueEntries(figures), left, width);
  if (legend.height > 0) parts.push({ shapes: legend.shapes, clip: null, down: down + 3 });
  return {
    title: sheet.name,
    notes: [...new Set(figures.flatMap((it) => it.notes ?? []))],
    width,
    height: down + (legend.height > 0 ? legend.height + 3 : 0),
    parts,
  };
}

/** Marks that a page draws itself, since they can be opened. */
function spotsOf(figure: Figure, frame: Frame): Shape[] {
  const plain = { ...figure, areas: [], bands: [], marks: [], vertical: [], horizontal: [], labels: [] };
  const curves = figure.curves.filter((it) => it.of.length > 0 && it.mark !== "line").map((it) => ({ ...it, of: [] }));
  return curves.length === 0
    ? []
    : draw({ ...plain, curves, cells: { ...figure.cells, kind: [] } }, frame, printStyle).curves;
}

function uniqueEntries(figures: readonly Figure[]): Entry[] {
  const named = figures.flatMap(entriesOf);
  const all = [...named.filter((it) => !it.isMark), ...named.filter((it) => it.isMark)];
  return all.filter((it, i) => all.findIndex((other) => other.label === it.label) === i);
}

/** Entries in rows below the plot. */
function legendOf(entries: readonly Entry[], left: number, width: number): { shapes: Shape[]; height: number } {
  const { text: size, font, ink: colour } = printStyle;
  const shapes: Shape[] = [];
  let [x, y] = [left, 0];
  for (const { label, sample } of entries) {
    const wide = 22 + widthOf(label, size, font) + 10;
    if (x > left && x + wide - 10 > width) [x, y] = [left, y + 1.4 * size];
    shapes.push(...sample(x, y + 0.15 * size, 18, 0.8 * size, printStyle));
    shapes.push({
      kind: "text",
      class: "legend",
      text: label,
      x: x + 22,
      y: y + 0.9 * size,
      size,
      colour,
      anchor: "start",
    });
    x += wide;
  }
  return { shapes, height: entries.length === 0 ? 0 : y + 1.6 * size };
}

export { outline };
