import type { Mapping } from "./time_line";
import { palette } from "../palette";
import { hatch, within, type TimeMarks } from "./time_marks";

/** A cycle along the bottom of a plot; one that is flagged is hatched over the whole height. */
export interface CycleMark {
  from_s: number;
  to_s: number;
  flagged: boolean;
  texts: readonly string[]; // the first for which there is room is written
}

/** Rows in which a signal stands at an end of its range; drawn in the plots of its unit. */
export interface ClippedMark {
  from_s: number;
  to_s: number;
  unit: string;
}

const bracket = 6; // pixels of the page
const strip = 9;

/** Cycles, and clipped rows of what is drawn in this unit. */
export function drawCycleMarks(
  context: CanvasRenderingContext2D,
  { cycles, clipped }: TimeMarks,
  map: Mapping,
  unit: string | undefined,
): void {
  if (cycles) drawCycles(context, cycles, map);
  if (clipped)
    drawClipped(
      context,
      clipped.filter((it) => it.unit === unit),
      map,
    );
}

function drawCycles(context: CanvasRenderingContext2D, cycles: readonly CycleMark[], map: Mapping): void {
  const { ink, lines } = palette();
  const alarm = lines[1]!; // vermillion
  context.save();
  context.font = `${13 * map.pixels}px system-ui, sans-serif`;
  context.textBaseline = "bottom";
  context.textAlign = "left";
  context.lineWidth = map.pixels;
  for (const cycle of cycles) {
    if (cycle.to_s < map.from || cycle.from_s > map.to) continue;
    const [left, width] = within(map, cycle.from_s, cycle.to_s);
    if (width < 4 * map.pixels && !cycle.flagged) continue; // a blur
    context.strokeStyle = ink;
    frame(context, left, width, map);
    if (!cycle.flagged) continue;
    const wide = Math.max(width, 2 * map.pixels);
    context.strokeStyle = context.fillStyle = alarm;
    context.globalAlpha = 0.12;
    context.fillRect(left, 0, wide, map.height);
    context.globalAlpha = 0.5;
    hatch(context, left, 0, wide, map.height, 14 * map.pixels);
    context.globalAlpha = 1;
    context.fillRect(left, map.height - strip * map.pixels, wide, strip * map.pixels);
    write(context, cycle.texts, left, width, map);
  }
  context.restore();
}

/** From the begin of the cycle to its end, with an upright at each that is within the plot. */
function frame(context: CanvasRenderingContext2D, left: number, width: number, map: Mapping): void {
  const bottom = map.height - map.pixels;
  const top = bottom - bracket * map.pixels;
  context.beginPath();
  context.moveTo(left + map.pixels, top);
  context.lineTo(left + map.pixels, bottom);
  context.lineTo(left + width - map.pixels, bottom);
  context.lineTo(left + width - map.pixels, top);
  context.stroke();
}

function write(
  context: CanvasRenderingContext2D,
  texts: readonly string[],
  left: number,
  width: number,
  map: Mapping,
): void {
  const { ink, card } = palette();
  const margin = 4 * map.pixels;
  const text = texts.find((it) => context.measureText(it).width + 2 * margin < width);
  if (text === undefined) return;
  const bottom = map.height - (strip + 3) * map.pixels;
  context.fillStyle = card;
  context.globalAlpha = 0.8;
  context.fillRect(left, bottom - 16 * map.pixels, context.measureText(text).width + 2 * margin, 17 * map.pixels);
  context.globalAlpha = 1;
  context.fillStyle = ink;
  context.fillText(text, left + margin, bottom);
}

/** Between two lines, beneath a block that is seen however short it is. */
function drawClipped(context: CanvasRenderingContext2D, clipped: readonly ClippedMark[], map: Mapping): void {
  const { ink } = palette();
  context.save();
  context.fillStyle = ink;
  for (const run of clipped) {
    if (run.to_s < map.from || run.from_s > map.to) continue;
    const [left, width] = within(map, run.from_s, run.to_s);
    const block = Math.max(width, 7 * map.pixels);
    context.fillRect(left + width / 2 - block / 2, 0, block, 12 * map.pixels);
    context.globalAlpha = 0.25;
    context.fillRect(left, 0, width, map.height);
    context.globalAlpha = 1;
    for (const x of [left, left + width]) context.fillRect(x - map.pixels / 2, 0, map.pixels, map.height);
  }
  context.restore();
}
