import type { FigureCells } from "../figure_description";
import type { Frame } from "./frame";
import { px, type Shape } from "./shapes";
import type { Style } from "./style";

export interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** The number of a cell in the figure, from the left and from below. */
export function cellAt({ x_edges, y_edges, upwards }: FigureCells, column: number, row: number): number {
  return upwards ? column * (y_edges.length - 1) + row : row * (x_edges.length - 1) + column;
}

/** Where it lies, with those above it where they are several. */
export function cellBox(
  { x_edges, y_edges }: FigureCells,
  frame: Pick<Frame, "x" | "y">,
  column: number,
  row: number,
  rows = 1,
): Box {
  const [x, right] = [frame.x.at(x_edges[column] ?? NaN), frame.x.at(x_edges[column + 1] ?? NaN)];
  const [y, bottom] = [frame.y.at(y_edges[row + rows] ?? NaN), frame.y.at(y_edges[row] ?? NaN)];
  return { x, y, width: right - x, height: bottom - y };
}

/** Grounds of a map, with lines and dots that are seen without colours too; cells of a kind are one path. */
export function cellShapes(cells: FigureCells, frame: Frame, style: Style): Shape[] {
  const boxes = cells.kinds.map((): Box[] => []);
  if (cells.kind.length === 0) return [];
  for (let column = 0; column + 1 < cells.x_edges.length; ++column) {
    for (let row = 0, end = 0; row + 1 < cells.y_edges.length; row = end) {
      const own = cells.kind[cellAt(cells, column, row)];
      while (end + 1 < cells.y_edges.length && cells.kind[cellAt(cells, column, end)] === own) ++end;
      boxes[own ?? 0]?.push(cellBox(cells, frame, column, row, end - row));
    }
  }
  return cells.kinds.flatMap((kind, k) => groundOf(boxes[k]!, kind, style));
}

/** A kind of cells over some boxes: also a sample of the legend. */
export function groundOf(
  boxes: readonly Box[],
  { colour, dotted }: FigureCells["kinds"][number],
  style: Style,
): Shape[] {
  if (boxes.length === 0) return [];
  const fill = style.cell[colour] ?? style.card;
  const d = boxes.map((it) => `M${px(it.x)} ${px(it.y)}h${px(it.width)}v${px(it.height)}h${px(-it.width)}Z`).join("");
  const shapes: Shape[] = [{ kind: "path", class: `cells ${colour}`, d, fill }];
  const step = 0.85 * style.text;
  if (colour === "orange")
    shapes.push({
      kind: "path",
      class: "hatch",
      d: boxes.map((it) => hatch(it, step)).join(""),
      stroke: style.hatch,
      width: 1.6 * style.frame,
    });
  if (dotted) shapes.push({ kind: "path", class: "dots", d: dots(boxes, step), fill: style.ink });
  return shapes;
}

/** Lines from below left to above right, of one grid for all boxes. */
export function hatch({ x, y, width, height }: Box, step: number): string {
  let path = "";
  for (let sum = Math.ceil((x + y) / step) * step; sum < x + y + width + height; sum += step) {
    const from = Math.max(x, sum - y - height);
    const to = Math.min(x + width, sum - y);
    if (to > from) path += `M${px(from)} ${px(sum - from)}L${px(to)} ${px(sum - to)}`;
  }
  return path;
}

/** Dots of one grid for all boxes, each in the box that its middle is in; one in the middle of a sample between them. */
function dots(boxes: readonly Box[], step: number): string {
  const r = 0.18 * step;
  const dot = (cx: number, cy: number): string =>
    `M${px(cx - r)} ${px(cy)}a${px(r)} ${px(r)} 0 1 0 ${px(2 * r)} 0a${px(r)} ${px(r)} 0 1 0 ${px(-2 * r)} 0Z`;
  let path = "";
  for (const { x, y, width, height } of boxes) {
    for (let cx = Math.ceil(x / step) * step; cx < x + width; cx += step)
      for (let cy = Math.ceil((y + r) / step) * step; cy <= y + height - r; cy += step) path += dot(cx, cy);
  }
  const [only] = boxes;
  return path || !only || boxes.length > 1 ? path : dot(only.x + 0.5 * only.width, only.y + 0.5 * only.height);
}
