import type { Figure, FigureCurve } from "../ui/figure_description";
import { element } from "../ui/dom";
import { linearTicks, plain } from "../ui/numbers";
import { palette } from "../ui/palette";

const size = { width: 240, height: 170 };
const margin = { left: 40, right: 6, top: 6, bottom: 22 };

/** A figure of points as a small picture: a canvas, since there are thousands, and its numbers in words. */
export class SmallPlot {
  readonly root = element("canvas", { class: "small_plot", role: "img" });

  constructor(
    private readonly figure: Figure,
    name: string,
  ) {
    const counts = figure.curves.map((it) => `${it.x.length} ${it.label}`).join(", ");
    this.root.setAttribute("aria-label", `${name}: ${figure.y_label} over ${figure.x_label}; points: ${counts}`);
    this.draw();
  }

  draw(): void {
    const pixels = devicePixelRatio || 1;
    this.root.width = Math.round(size.width * pixels);
    this.root.height = Math.round(size.height * pixels);
    const context = this.root.getContext("2d");
    if (!context) return;
    context.scale(pixels, pixels);
    const [left, right] = rangeOf(this.figure.curves, "x");
    const [lower, upper] = rangeOf(this.figure.curves, "y");
    const [wide, high] = [size.width - margin.left - margin.right, size.height - margin.top - margin.bottom];
    const x = (value: number): number => margin.left + ((value - left) / (right - left)) * wide;
    const y = (value: number): number => margin.top + ((upper - value) / (upper - lower)) * high;
    this.axes(context, linearTicks(left, right, 4), linearTicks(lower, upper, 4), x, y);
    for (const curve of this.figure.curves) points(context, curve, x, y);
    this.units(context);
  }

  /** In the corners where the axes end. */
  private units(context: CanvasRenderingContext2D): void {
    const unit = (label: string): string => /\[.*\]/.exec(label)?.[0] ?? label;
    context.fillStyle = palette().ink;
    context.textAlign = "left";
    context.textBaseline = "top";
    context.fillText(unit(this.figure.y_label), margin.left + 4, margin.top + 3);
    context.textAlign = "right";
    context.textBaseline = "bottom";
    context.fillText(unit(this.figure.x_label), size.width - margin.right - 4, size.height - margin.bottom - 12);
  }

  private axes(
    context: CanvasRenderingContext2D,
    across: readonly number[],
    up: readonly number[],
    x: (value: number) => number,
    y: (value: number) => number,
  ): void {
    const { line, grid, ink } = palette();
    context.font = "12px system-ui, 'Noto Sans', 'DejaVu Sans', sans-serif";
    context.fillStyle = ink;
    context.strokeStyle = grid;
    context.textBaseline = "middle";
    context.textAlign = "right";
    for (const value of up) {
      stroke(context, margin.left, y(value), size.width - margin.right, y(value));
      context.fillText(plain(value, 4), margin.left - 4, y(value));
    }
    context.textBaseline = "top";
    context.textAlign = "center";
    for (const value of across) {
      stroke(context, x(value), margin.top, x(value), size.height - margin.bottom);
      context.fillText(plain(value, 4), Math.min(x(value), size.width - 14), size.height - margin.bottom + 5);
    }
    context.strokeStyle = line;
    context.strokeRect(
      margin.left,
      margin.top,
      size.width - margin.left - margin.right,
      size.height - margin.top - margin.bottom,
    );
  }
}

/** Told apart by shape as well: what is flagged is crosses, what is idle small and faint. */
function points(
  context: CanvasRenderingContext2D,
  curve: FigureCurve,
  x: (value: number) => number,
  y: (value: number) => number,
): void {
  const { ink, lines } = palette();
  const flagged = curve.label === "flagged";
  const half = curve.label === "idle" ? 0.5 : 0.8;
  context.fillStyle = curve.label === "idle" ? lines[5]! : ink;
  context.strokeStyle = lines[1]!;
  curve.x.forEach((at, i) => {
    const value = curve.y[i];
    if (at === null || value === null || value === undefined) return;
    const [left, top] = [x(at), y(value)];
    if (flagged) {
      stroke(context, left - 2, top - 2, left + 2, top + 2);
      stroke(context, left - 2, top + 2, left + 2, top - 2);
    } else context.fillRect(left - half, top - half, 2 * half, 2 * half);
  });
}

function stroke(context: CanvasRenderingContext2D, x1: number, y1: number, x2: number, y2: number): void {
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}

/** With a little room on both sides. */
function rangeOf(curves: readonly FigureCurve[], of: "x" | "y"): [number, number] {
  let [lower, upper] = [Infinity, -Infinity];
  for (const curve of curves) {
    for (const value of curve[of]) {
      if (value === null) continue;
      lower = Math.min(lower, value);
      upper = Math.max(upper, value);
    }
  }
  if (!(lower <= upper)) return [0, 1];
  const room = 0.04 * (upper - lower || 1);
  return [lower - room, upper + room];
}
