// A figure as it is described, for the screen, for print and as a table: bench/figures/plot/chart_json.h has what the server
// sends; areas and notes are the page's own.

export type Colour = "black" | "blue" | "vermillion" | "green" | "purple" | "orange" | "sky" | "yellow" | "grey";
export type Numbers = readonly (number | null)[];
export interface FigureCurve {
  label: string; // empty: not in the legend
  x: Numbers; // null breaks a line
  y: Numbers;
  colour: Colour;
  mark: "line" | "points" | "circles" | "crosses" | "steps" | "boxes";
  width: number;
  dashed: boolean; // laws and theories; what was measured is solid
  of: readonly number[]; // the number of what each point stands for; empty: of nothing
  name?: string; // of its column in a table, where the label does not say it
  marked?: boolean; // with its colour's shape along it, so that not the colour alone tells it from others
  order?: number; // its place in an order, from 0 to 1, which gives it a colour of a sequence
}
/** What lies between two lines over x; null breaks it. */
export interface FigureArea {
  label: string; // empty: not in the legend
  x: Numbers;
  low: Numbers;
  high: Numbers;
  colour: Colour;
  /** What was measured, from the smallest to the largest value of a stretch: as solid as a line. Else a faint band. */
  extremes?: boolean;
  each?: number; // of extremes: how much of x each pair of them is of
  name?: string;
  marked?: boolean;
}
export interface FigureCells {
  x_edges: number[];
  y_edges: number[];
  upwards: boolean; // cells follow each other along y, else along x
  kinds: { colour: Colour; label: string; dotted: boolean }[];
  kind: number[]; // of each cell
}
export interface FigureMarker {
  at: number | null;
  label: string;
  label_after: boolean; // right of a vertical line instead of left
}
export interface FigureLabel {
  x: number;
  y: number;
  text: string;
  left: boolean;
  text_x: number | null; // where the text begins, or ends if it is left; null: beside the point
  text_y: number | null;
}
export interface FigureTick {
  at: number | null;
  name: string;
}
/** A stretch of x, behind everything. */
export interface FigureBand {
  begin: number | null;
  end: number | null;
  colour: Colour;
  label?: string; // none: not in the legend
}
/** What is told of a stretch of x, or of a place, which begins and ends there: on pictures of recordings over time. */
export interface FigureMark {
  kind: "closing" | "opening" | "gap" | "cycle" | "flagged" | "clipped" | "event";
  begin: number;
  end: number;
  texts: readonly string[]; // the first for which there is room is written
}
export interface Figure {
  title?: string;
  x_label: string; // with its unit: "time [s]"
  y_label: string;
  curves: FigureCurve[];
  areas?: FigureArea[];
  bands?: FigureBand[];
  marks?: FigureMark[];
  ordered?: string; // what the order of its curves is, in the words of the legend
  cells: FigureCells;
  vertical: FigureMarker[];
  horizontal: FigureMarker[];
  labels: FigureLabel[];
  x_ticks?: FigureTick[]; // in place of numbers
  y_ticks?: FigureTick[];
  x_range: [number, number] | null; // null: what the curves need
  y_range: [number, number] | null;
  log_x: boolean;
  log_y: boolean;
  notes?: string[]; // what a file says of its numbers
}

const nothing = { x_edges: [], y_edges: [], upwards: false, kinds: [], kind: [] };

/** A figure of the page's own. */
export function figureOf(x_label: string, y_label: string, more: Partial<Figure>): Figure {
  const empty = { curves: [], vertical: [], horizontal: [], labels: [], x_range: null, y_range: null };
  return { x_label, y_label, cells: nothing, log_x: false, log_y: false, ...empty, ...more };
}

export function lineOf(label: string, x: Numbers, y: Numbers, more: Partial<FigureCurve> = {}): FigureCurve {
  return { label, x, y, colour: "blue", mark: "line", width: 2, dashed: false, of: [], ...more };
}
