import { linearTicks, logarithmicTicks, plain, takesPrefix, unitFor, withUnit } from "../../ui/numbers";
import { palette } from "../../ui/palette";

/** A side of a plot: from where to where, in which unit, and what it is. */
export interface Side {
  from: number;
  to: number;
  unit: string;
  name: string;
  logarithmic?: boolean;
}

/** Where values are on a canvas: what both axes give back. */
export interface Axes {
  context: CanvasRenderingContext2D;
  x: (value: number) => number;
  y: (value: number) => number;
  left: number;
  right: number;
  top: number;
  bottom: number;
  pixels: number; // of the canvas in one of the page
}

const font = "13px system-ui, 'Noto Sans', 'DejaVu Sans', sans-serif";

/** Takes the size of its box, clears the canvas and draws a frame with ticks, units and names; null: no room. */
export function drawAxes(canvas: HTMLCanvasElement, across: Side, up: Side): Axes | null {
  const pixels = window.devicePixelRatio || 1;
  const { clientWidth: width, clientHeight: height } = canvas;
  if (width < 150 || height < 100) return null;
  const wanted = [Math.round(width * pixels), Math.round(height * pixels)] as const;
  if (canvas.width !== wanted[0] || canvas.height !== wanted[1]) [canvas.width, canvas.height] = wanted;
  const context = canvas.getContext("2d");
  if (!context) return null;
  context.setTransform(pixels, 0, 0, pixels, 0, 0);
  context.clearRect(0, 0, width, height);
  const [left, right, top, bottom] = [76, width - 20, 10, height - 46];
  const place = (side: Side, low: number, high: number) => {
    const of = side.logarithmic ? Math.log10 : (it: number): number => it;
    const [from, to] = [of(side.from), of(side.to)];
    return (value: number): number => low + ((of(value) - from) / (to - from || 1)) * (high - low);
  };
  const axes = { context, x: place(across, left, right), y: place(up, bottom, top), left, right, top, bottom, pixels };
  const colours = palette();
  context.font = font;
  context.lineWidth = 1;
  context.strokeStyle = colours.grid;
  context.fillStyle = colours.ink;
  labels(across, axes.x, (right - left) / 90, (at, text) => {
    line(context, at, top, at, bottom);
    context.textAlign = "center";
    context.textBaseline = "top";
    context.fillText(text, at, bottom + 5);
  });
  labels(up, axes.y, (bottom - top) / 34, (at, text) => {
    line(context, left, at, right, at);
    context.textAlign = "right";
    context.textBaseline = "middle";
    context.fillText(text, left - 6, at);
  });
  context.strokeStyle = colours.line;
  context.strokeRect(left, top, right - left, bottom - top);
  context.font = `600 ${font}`;
  context.textAlign = "center";
  context.textBaseline = "bottom";
  context.fillText(titleOf(across), (left + right) / 2, height - 4);
  context.save();
  context.translate(8, (top + bottom) / 2);
  context.rotate(-Math.PI / 2);
  context.textBaseline = "middle";
  context.fillText(titleOf(up), 0, 0);
  context.restore();
  return axes;
}

/** Nothing that is drawn now leaves the frame; the caller restores the context. */
export function clipTo({ context, left, right, top, bottom }: Axes): void {
  context.save();
  context.beginPath();
  context.rect(left, top, right - left, bottom - top);
  context.clip();
}

function titleOf(side: Side): string {
  const text = hasPrefixes(side) ? "" : unitOf(side).text;
  return text ? `${side.name} [${text}]` : side.name;
}

/** Over decades each tick has a prefix of its own, but for a frequency and what takes none. */
function hasPrefixes(side: Side): boolean {
  return side.logarithmic === true && side.unit !== "Hz" && takesPrefix(side.unit);
}

function unitOf(side: Side): { factor: number; text: string } {
  if (side.logarithmic) return { factor: 1, text: side.unit };
  return unitFor(Math.max(Math.abs(side.from), Math.abs(side.to)), side.unit);
}

function labels(
  side: Side,
  place: (value: number) => number,
  count: number,
  draw: (at: number, text: string) => void,
): void {
  const { factor } = unitOf(side);
  const ticks = side.logarithmic
    ? logarithmicTicks(side.from, side.to)
    : linearTicks(side.from / factor, side.to / factor, Math.max(2, count)).map((it) => it * factor);
  const every = side.logarithmic ? Math.max(1, Math.ceil(ticks.length / Math.max(2, count))) : 1;
  ticks.forEach((tick, k) => {
    if (k % every !== 0) return;
    draw(
      Math.round(place(tick)) + 0.5,
      hasPrefixes(side) ? withUnit(tick, side.unit, 1) : plain(tick / factor, side.logarithmic && tick < 1e-4 ? 1 : 4),
    );
  });
}

function line(context: CanvasRenderingContext2D, x1: number, y1: number, x2: number, y2: number): void {
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}
