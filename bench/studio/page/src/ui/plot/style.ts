import type { Colour } from "../figure_description";
import { palette } from "../palette";
import { orderedInPrint, orderedOnScreen } from "../sequential";

/** How a figure is drawn: in pixels of the page, or in points of a printed one. */
export interface Style {
  font: string;
  text: number; // size of letters
  hair: number; // width of grid lines
  frame: number; // of axes
  lines: number; // of curves: times the curve's own width
  marks: number; // radius of marks: times the curve's own width
  gap: number; // between things
  spacing: { x: number; y: number }; // least distance of ticks
  ink: string;
  soft: string;
  line: string;
  grid: string;
  card: string;
  colours: Record<Colour, string>;
  ordered: (share: number) => string; // colours of a sequence
  cell: Partial<Record<Colour, string>>; // grounds of a map's cells
  hatch: string;
}

/** Of the page as it is now, in light or dark. */
export function screenStyle(): Style {
  const { ink, soft, line, grid, card, figure } = palette();
  const { sky_cell: sky = card, orange_cell: orange = card, hatch = line, ...colours } = figure;
  return {
    font: "system-ui, 'Noto Sans', 'DejaVu Sans', sans-serif",
    text: 12,
    hair: 1,
    frame: 1,
    lines: 1,
    marks: 1.4,
    gap: 5,
    spacing: { x: 84, y: 44 },
    ink,
    soft,
    line,
    grid,
    card,
    colours: { ...(colours as Record<Colour, string>), black: ink },
    ordered: orderedOnScreen,
    cell: { sky, orange },
    hatch,
  };
}

/** Of a journal's page: letters of 8 pt, lines of 0.25 to 1 pt, dark on white [OkabeIto2008]. */
export const printStyle: Style = {
  font: "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif",
  text: 8,
  hair: 0.25,
  frame: 0.5,
  lines: 0.4,
  marks: 0.55,
  gap: 2.5,
  spacing: { x: 34, y: 20 },
  ink: "#000000",
  soft: "#333333",
  line: "#000000",
  grid: "#dddddd",
  card: "#ffffff",
  colours: {
    black: "#000000",
    blue: "#0072b2",
    vermillion: "#c14d00",
    green: "#00775a",
    purple: "#a34e80",
    orange: "#8a5a00",
    sky: "#1d7fb5",
    yellow: "#7d7a00",
    grey: "#6b7680",
  },
  ordered: orderedInPrint,
  cell: { sky: "#dcebf6", orange: "#f8e3cf" },
  hatch: "#a5642a",
};
