import { markPath } from "../marks";
import { looks } from "../palette";
import { columnAt, columnsWithin, type Mapping, type TimeLine } from "./time_line";

const thickness = 1.6; // of a line, in pixels of the page
const bandAlpha = 0.42; // between the two edges of a band

/**
 * Draws lines into a canvas of its own, which is laid over the plot: for each pixel across, the stretch from the
 * smallest to the largest value there, joined to its neighbours, with soft ends. So every spike is seen, and a
 * ragged line costs what a smooth one does, which a canvas' own lines do not where no graphics processor helps.
 */
export class TimeRaster {
  readonly canvas = document.createElement("canvas");
  private readonly context = this.canvas.getContext("2d", { willReadFrequently: true });
  private image = new ImageData(1, 1);
  private top = new Float32Array(1); // of the line at work, for each pixel across
  private bottom = new Float32Array(1);
  private map: Mapping | null = null;
  private readonly colours = new Map<string, readonly [number, number, number]>();

  begin(map: Mapping): void {
    this.map = map;
    const width = Math.max(1, Math.round(map.width));
    const height = Math.max(1, Math.round(map.height));
    if (this.image.width !== width || this.image.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      this.image = new ImageData(width, height);
      this.top = new Float32Array(width);
      this.bottom = new Float32Array(width);
    } else this.image.data.fill(0);
  }

  /** A line; it breaks where columns are empty or missing, and nowhere else. */
  add(line: TimeLine, colour: string): void {
    const { map } = this;
    if (!map) return;
    this.top.fill(Infinity);
    this.bottom.fill(-Infinity);
    const perSecond = map.width / (map.to - map.from);
    this.trace(line, map, perSecond);
    this.ink(this.rgb(colour), map);
  }

  paint(): void {
    this.context?.putImageData(this.image, 0, 0);
  }

  /** Marks along a line, above what is painted, so that not its colour alone tells it from others. */
  mark(line: TimeLine, colour: string, edge: string): void {
    const { map, context } = this;
    if (!map || !context) return;
    const perSecond = map.width / (map.to - map.from);
    // They stay at their places of the line while it moves.
    const every = 2 ** Math.ceil(Math.log2((130 * map.pixels) / perSecond));
    const first = Math.ceil((map.from - line.shift_s) / every - line.look / looks.length);
    context.fillStyle = colour;
    context.strokeStyle = edge;
    context.lineWidth = map.pixels;
    for (let k = first; ; ++k) {
      const at = (k + line.look / looks.length) * every + line.shift_s;
      if (at > map.to) return;
      const column = columnAt(line, at);
      if (column < 0) continue;
      const value = 0.5 * (line.smallest[column]! + line.largest[column]!);
      const y = ((map.upper - (map.logarithmic ? Math.log10(value) : value)) / (map.upper - map.lower)) * map.height;
      const path = new Path2D(markPath(looks[line.look]!, (at - map.from) * perSecond, y, 4.5 * map.pixels));
      context.fill(path);
      context.stroke(path);
    }
  }

  /** Finds what each pixel across holds. */
  private trace(line: TimeLine, map: Mapping, perSecond: number): void {
    const perValue = map.height / (map.upper - map.lower);
    const floor = map.logarithmic ? 10 ** map.lower : 0;
    const x0 = (line.shift_s + line.middle_s - map.from) * perSecond;
    const y0 = map.upper * perValue;
    const furthest = 2.5 * line.step_s * perSecond;
    const spacing = line.step_s * perSecond;
    const [first, end] = columnsWithin(line, map.from, map.to);
    let before = NaN;
    let upperBefore = 0;
    let lowerBefore = 0;
    for (let i = first; i < end; ++i) {
      const largest = line.largest[i]!;
      const smallest = line.smallest[i]!;
      if (smallest !== smallest) {
        before = NaN;
        continue;
      }
      const x = x0 + line.time[i]! * perSecond;
      const upper = y0 - (map.logarithmic ? Math.log10(largest > floor ? largest : floor) : largest) * perValue;
      const lower = y0 - (map.logarithmic ? Math.log10(smallest > floor ? smallest : floor) : smallest) * perValue;
      this.put(Math.floor(x), upper, lower);
      const joined = x - before < furthest;
      const alone = !joined && !(x0 + (line.time[i + 1] ?? Infinity) * perSecond - x < furthest);
      if (alone || spacing > 12 * map.pixels) this.dot(x, upper, lower, map.pixels);
      if (joined) this.join(before, upperBefore, lowerBefore, x, upper, lower);
      before = x;
      upperBefore = upper;
      lowerBefore = lower;
    }
  }

  private put(pixel: number, upper: number, lower: number): void {
    if (upper < this.top[pixel]!) this.top[pixel] = upper;
    if (lower > this.bottom[pixel]!) this.bottom[pixel] = lower;
  }

  /** From one column to the next, over all pixels between them. */
  private join(x0: number, upper0: number, lower0: number, x1: number, upper1: number, lower1: number): void {
    const from = Math.max(0, Math.floor(x0));
    const to = Math.min(this.top.length - 1, Math.floor(x1));
    if (from === to) {
      // Within one pixel both are there already; what lies between them belongs to it as well.
      this.put(to, Math.min(upper0, upper1), Math.max(lower0, lower1));
      return;
    }
    const share = (x: number): number => Math.min(1, Math.max(0, (x - x0) / (x1 - x0)));
    for (let pixel = from; pixel <= to; ++pixel) {
      const a = share(pixel);
      const b = share(pixel + 1);
      const upperA = upper0 + a * (upper1 - upper0);
      const upperB = upper0 + b * (upper1 - upper0);
      const lowerA = lower0 + a * (lower1 - lower0);
      const lowerB = lower0 + b * (lower1 - lower0);
      this.put(pixel, Math.min(upperA, upperB), Math.max(lowerA, lowerB));
    }
  }

  /** A row that stands alone, or can be told from its neighbours. */
  private dot(x: number, upper: number, lower: number, pixels: number): void {
    const radius = 2.4 * pixels;
    const from = Math.max(0, Math.ceil(x - radius - 0.5));
    const to = Math.min(this.top.length - 1, Math.floor(x + radius - 0.5));
    for (let pixel = from; pixel <= to; ++pixel) {
      const across = pixel + 0.5 - x;
      const half = Math.sqrt(Math.max(0, radius * radius - across * across)) - 0.5 * thickness * pixels;
      if (half > 0) this.put(pixel, upper - half, lower + half);
    }
  }

  private ink(rgb: readonly [number, number, number], map: Mapping): void {
    const half = 0.5 * thickness * map.pixels;
    const edge = 2 * half;
    for (let pixel = 0; pixel < this.top.length; ++pixel) {
      const top = this.top[pixel]!;
      const bottom = this.bottom[pixel]!;
      if (top === Infinity) continue;
      const thick = bottom - top > 2 * edge;
      if (!thick) {
        this.bar(pixel, top - half, bottom + half, 1, rgb);
        continue;
      }
      // The edges go up and down with the band: what stands out beyond a neighbour is all edge, as a spike is.
      const upper = Math.min(bottom + half, Math.max(top + half, this.further(pixel, this.top, top, 1)));
      const lower = Math.max(upper, Math.min(bottom - half, this.further(pixel, this.bottom, bottom, -1)));
      this.bar(pixel, top - half, upper, 1, rgb);
      this.bar(pixel, upper, lower, bandAlpha, rgb);
      this.bar(pixel, lower, bottom + half, 1, rgb);
    }
  }

  /** An end of the neighbour whose end lies further within. */
  private further(pixel: number, ends: Float32Array, own: number, inwards: 1 | -1): number {
    let found = own;
    for (const neighbour of [pixel - 1, pixel + 1]) {
      const end = ends[neighbour];
      if (end !== undefined && Number.isFinite(end) && (end - found) * inwards > 0) found = end;
    }
    return found;
  }

  /** An upright bar over what is there already; its ends cover a share of their pixels. */
  private bar(
    x: number,
    top: number,
    bottom: number,
    alpha: number,
    [red, green, blue]: readonly [number, number, number],
  ): void {
    const { data, width, height } = this.image;
    const first = Math.max(0, Math.floor(top));
    const last = Math.min(height - 1, Math.ceil(bottom) - 1);
    for (let y = first; y <= last; ++y) {
      const covered = Math.min(bottom, y + 1) - Math.max(top, y);
      const over = alpha * (covered < 1 ? covered : 1);
      const at = 4 * (y * width + x);
      const under = (data[at + 3]! / 255) * (1 - over);
      const sum = over + under;
      if (sum <= 0) continue;
      data[at] = (red * over + data[at]! * under) / sum;
      data[at + 1] = (green * over + data[at + 1]! * under) / sum;
      data[at + 2] = (blue * over + data[at + 2]! * under) / sum;
      data[at + 3] = 255 * sum;
    }
  }

  private rgb(colour: string): readonly [number, number, number] {
    const known = this.colours.get(colour);
    if (known) return known;
    const hex = Number.parseInt(colour.slice(1), 16);
    const rgb = [(hex >> 16) & 255, (hex >> 8) & 255, hex & 255] as const;
    this.colours.set(colour, rgb);
    return rgb;
  }
}
