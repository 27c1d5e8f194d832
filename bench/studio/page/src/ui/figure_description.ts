// A figure as the server describes it, in print and here: bench/figures/plot/chart_json.h.

export type Colour = "black" | "blue" | "vermillion" | "green" | "purple" | "orange" | "sky" | "yellow" | "grey";
export interface FigureCurve {
  label: string; // empty: not in the legend
  x: (number | null)[]; // null breaks a line
  y: (number | null)[];
  colour: Colour;
  mark: "line" | "points" | "circles" | "crosses";
  width: number;
  dashed: boolean;
  of: number[]; // the number of what each point stands for; empty: of nothing
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
/** What the server sends of chart_to_json() in bench/figures/plot. */
export interface Figure {
  title?: string;
  x_label: string;
  y_label: string;
  curves: FigureCurve[];
  cells: FigureCells;
  vertical: FigureMarker[];
  horizontal: FigureMarker[];
  labels: FigureLabel[];
  x_range: [number, number] | null; // null: what the curves need
  y_range: [number, number] | null;
  log_x: boolean;
  log_y: boolean;
}
