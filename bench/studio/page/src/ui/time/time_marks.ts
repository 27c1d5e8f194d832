import type { KerfEvent } from "../../api/recordings";
import type { Mapping } from "./time_line";
import { palette } from "../palette";
import type { ClippedMark, CycleMark } from "./cycle_marks";

export type Shade = "blue" | "orange" | "plain";

/** A stretch with a meaning, such as a phase of a cycle. */
export interface Span {
  from_s: number;
  to_s: number;
  shade: Shade;
  text: string; // written where there is room
}

export interface TimeMarks {
  spans: readonly Span[]; // in order, not overlapping
  gaps: readonly (readonly [number, number])[]; // without rows
  events: readonly KerfEvent[];
  cycles?: readonly CycleMark[];
  clipped?: readonly ClippedMark[];
}

export const noMarks: TimeMarks = { spans: [], gaps: [], events: [] };

const strip = 5; // pixels of the page, along the top: tells a span where its shade is too faint

/** What lies under the lines: spans, and gaps hatched. */
export function drawGround(context: CanvasRenderingContext2D, marks: TimeMarks, map: Mapping, texts: boolean): void {
  const colours = palette();
  context.save();
  context.font = `${13 * map.pixels}px system-ui, sans-serif`;
  context.textBaseline = "top";
  context.textAlign = "left";
  for (const span of marks.spans) {
    if (span.to_s < map.from || span.from_s > map.to) continue;
    if (((span.to_s - span.from_s) / (map.to - map.from)) * map.width < 2 * map.pixels) continue; // a blur
    const [left, width] = within(map, span.from_s, span.to_s);
    context.fillStyle = colours.lines[span.shade === "orange" ? 4 : 0]!;
    if (span.shade !== "plain") {
      context.globalAlpha = 0.1;
      context.fillRect(left, 0, width, map.height);
      context.globalAlpha = 1;
      if (span.shade === "blue") context.fillRect(left, 0, width, strip * map.pixels);
      else stripes(context, left, 0, width, strip * map.pixels, 4 * map.pixels);
    }
    if (texts && span.text && width > context.measureText(span.text).width + 8 * map.pixels) {
      context.fillStyle = colours.ink;
      context.fillText(span.text, left + 4 * map.pixels, (strip + 3) * map.pixels);
    }
  }
  for (const [from, to] of marks.gaps) {
    if (to < map.from || from > map.to) continue;
    const [left, width] = within(map, from, to);
    context.fillStyle = colours.grid;
    context.fillRect(left, 0, width, map.height);
    context.strokeStyle = colours.line;
    hatch(context, left, 0, width, map.height, 10 * map.pixels);
  }
  context.restore();
}

/** Events: a line through the plot with a small flag. */
export function drawEvents(context: CanvasRenderingContext2D, marks: TimeMarks, map: Mapping): void {
  context.save();
  context.strokeStyle = context.fillStyle = palette().ink;
  context.lineWidth = map.pixels;
  context.setLineDash([2 * map.pixels, 2 * map.pixels]);
  let last = -Infinity;
  for (const event of marks.events) {
    if (event.time_s < map.from || event.time_s > map.to) continue;
    const x = Math.round(((event.time_s - map.from) / (map.to - map.from)) * map.width);
    if (x - last < map.pixels) continue;
    last = x;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, map.height);
    context.stroke();
    const size = 7 * map.pixels;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x + size, size / 2);
    context.lineTo(x, size);
    context.fill();
  }
  context.restore();
}

/** Left end and width within the plot; at least a pixel. */
export function within(map: Mapping, from: number, to: number): [number, number] {
  const perSecond = map.width / (map.to - map.from);
  const left = Math.max(0, (from - map.from) * perSecond);
  const right = Math.min(map.width, (to - map.from) * perSecond);
  return [left, Math.max(map.pixels, right - left)];
}

function stripes(
  context: CanvasRenderingContext2D,
  left: number,
  top: number,
  width: number,
  height: number,
  step: number,
): void {
  for (let x = left; x < left + width; x += 2 * step) {
    context.fillRect(x, top, Math.min(step, left + width - x), height);
  }
}

export function hatch(
  context: CanvasRenderingContext2D,
  left: number,
  top: number,
  width: number,
  height: number,
  step: number,
): void {
  context.save();
  context.beginPath();
  context.rect(left, top, width, height);
  context.clip();
  context.beginPath();
  for (let x = left - height; x < left + width; x += step) {
    context.moveTo(x, top + height);
    context.lineTo(x + height, top);
  }
  context.lineWidth = step / 10;
  context.stroke();
  context.restore();
}
