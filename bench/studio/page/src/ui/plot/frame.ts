import type { Figure, FigureTick } from "../figure_description";
import { rangeAround, Scale, type Range } from "./scale";
import { px, widthOf, type Shape } from "./shapes";
import type { Style } from "./style";

export interface Limits {
  x: Range;
  y: Range;
}

/** A figure's place: axes about the rectangle in which it is drawn. */
export interface Frame {
  width: number; // with axes
  height: number;
  left: number;
  right: number;
  top: number;
  bottom: number;
  x: Scale;
  y: Scale;
}

const mostRows = 4; // of names below an axis

export interface FrameOptions {
  left?: number; // at least, so that plots above each other align
  timeAxis?: boolean; // texts and label below it; else another plot has them
}

/** Limits that hold all of a figure, or what it says itself. */
export function limitsOf(figure: Figure): Limits {
  const { curves, areas = [], cells, x_range, y_range, log_x, log_y } = figure;
  const around = (pick: "x" | "y"): [number, number] => {
    const lists = curves.map((it) => it[pick]);
    for (const it of areas) lists.push(...(pick === "x" ? [it.x] : [it.low, it.high]));
    if (cells.kind.length > 0) lists.push(pick === "x" ? cells.x_edges : cells.y_edges);
    return rangeAround(lists, pick === "x" ? log_x : log_y);
  };
  return { x: x_range ?? around("x"), y: y_range ?? around("y") };
}

interface Tick {
  at: number;
  text: string;
}

function named(ticks: readonly FigureTick[] | undefined, [lower, upper]: Range): Tick[] | null {
  if (!ticks || ticks.length === 0) return null;
  return ticks.flatMap(({ at, name }) => (at !== null && at >= lower && at <= upper ? [{ at, text: name }] : []));
}

function ticksOf(figure: Figure, scale: Scale, of: "x" | "y", style: Style): Tick[] {
  return named(figure[`${of}_ticks`], scale.range) ?? scale.ticks(style.spacing[of]);
}

/** For half of the last number. */
export function roomAtRight(style: Style): number {
  return Math.max(2 * style.gap, 1.2 * style.text);
}

export function frameOf(
  figure: Figure,
  limits: Limits,
  width: number,
  height: number,
  style: Style,
  { left = 0, timeAxis = true }: FrameOptions = {},
): Frame {
  const top = 0.5 * style.text + style.gap;
  const withRows = (rows: number): Frame => {
    const below = (2.4 + rowHeight * (rows - 1)) * style.text + 3 * style.gap;
    const bottom = height - (timeAxis ? below : 0.5 * style.text);
    const y = new Scale(limits.y, bottom, top, figure.log_y);
    const widest = Math.max(0, ...ticksOf(figure, y, "y", style).map((it) => widthOf(it.text, style.text, style.font)));
    const lines = wrapped(figure.y_label, bottom - top + style.text, style).length;
    const begin = Math.max(left, (0.1 + 1.15 * lines) * style.text + widest + 3 * style.gap);
    const end = width - roomAtRight(style);
    const x = new Scale(limits.x, begin, Math.max(begin + 1, end), figure.log_x);
    return { width, height, left: begin, right: Math.max(begin + 1, end), top, bottom, x, y };
  };
  const frame = withRows(1);
  const rows = timeAxis && figure.x_ticks ? rowsOf(ticksOf(figure, frame.x, "x", style), frame.x, style) : 1;
  return rows > 1 ? withRows(rows) : frame;
}

const rowHeight = 1.15; // of a text

/** In how many rows names stand below an axis, by turns, so that none runs into another. */
function rowsOf(ticks: readonly Tick[], x: Scale, { text, font }: Style): number {
  const widths = ticks.map((it) => widthOf(it.text, text, font));
  for (let rows = 1; rows < mostRows; ++rows) {
    const isFree = ticks.every((it, i) => {
      const next = ticks[i + rows];
      return !next || x.at(next.at) - x.at(it.at) > 0.5 * (widths[i]! + widths[i + rows]!) + 0.3 * text;
    });
    if (isFree) return rows;
  }
  return mostRows;
}

/** A label in as many lines as it needs in a room so wide. */
function wrapped(label: string, room: number, { text, font }: Style): string[] {
  const lines: string[] = [];
  for (const word of label.split(" ")) {
    const longer = lines.length > 0 ? `${lines[lines.length - 1]} ${word}` : word;
    if (lines.length > 0 && widthOf(longer, text, font, true) <= room) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

/** Grid, frame, numbers and labels of the axes. */
export function axesOf(figure: Figure, frame: Frame, style: Style, timeAxis = true): Shape[] {
  const { left, right, top, bottom, x, y } = frame;
  const { text: size, ink: colour } = style;
  const grid: string[] = [];
  const texts: Shape[] = [];
  const tick = (text: string, at_x: number, at_y: number, anchor: "middle" | "end"): Shape => {
    return { kind: "text", class: "tick", text, x: at_x, y: at_y, size, colour, anchor };
  };
  const below = ticksOf(figure, x, "x", style);
  const rows = figure.x_ticks ? rowsOf(below, x, style) : 1;
  for (const [i, { at, text }] of below.entries()) {
    grid.push(`M${px(x.at(at))} ${px(top)}V${px(bottom)}`);
    const lower = rowHeight * (i % rows);
    if (timeAxis) texts.push(tick(text, x.at(at), bottom + (1 + lower) * size + style.gap, "middle"));
  }
  for (const { at, text } of ticksOf(figure, y, "y", style)) {
    grid.push(`M${px(left)} ${px(y.at(at))}H${px(right)}`);
    texts.push(tick(text, left - style.gap, y.at(at) + 0.35 * size, "end"));
  }
  const label = (text: string, at_x: number, at_y: number, upwards: boolean): Shape => {
    return { kind: "text", class: "axis", text, x: at_x, y: at_y, size, colour, anchor: "middle", bold: true, upwards };
  };
  if (timeAxis) texts.push(label(figure.x_label, 0.5 * (left + right), frame.height - style.gap, false));
  wrapped(figure.y_label, bottom - top + size, style).forEach((line, i) =>
    texts.push(label(line, (1 + 1.15 * i) * size, 0.5 * (top + bottom), true)),
  );
  return [
    { kind: "path", class: "grid", d: grid.join(""), stroke: style.grid, width: style.hair },
    { kind: "path", class: "border", d: outline(frame), stroke: style.line, width: style.frame },
    ...texts,
  ];
}

export function outline({ left, right, top, bottom }: Frame): string {
  return `M${px(left)} ${px(top)}H${px(right)}V${px(bottom)}H${px(left)}Z`;
}
