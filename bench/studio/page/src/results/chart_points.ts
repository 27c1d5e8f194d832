import type { ChartFile, ChartPoint } from "../api";
import { plain, withUnit } from "../ui/numbers";

const cheapest_us = 2e-3; // below it a cost is what the clock can tell
const least_jnd = 1e-4; // errors below so many JNDs stand at the left border

/** A point as it is drawn. */
export interface PlacedPoint {
  point: ChartPoint;
  index: number; // in the file
  law: number; // in the order of the legend
  error: number; // as compared
  cost_us: number;
}

/** A chart's points where they stand, and the lines that they are judged by. */
export class PlacedChart {
  readonly laws: string[];
  readonly points: PlacedPoint[];
  readonly jnd: number;
  readonly tick_us: number;
  readonly unit: "N" | "JND";

  constructor(readonly file: ChartFile) {
    this.unit = file.compared_in;
    this.jnd = this.unit === "N" ? (file.jnd_n ?? 0.05) : 1;
    this.tick_us = 1e6 / file.rate_hz;
    this.laws = [...new Set(file.points.map((it) => it.law))];
    this.points = file.points.map((point, index) => {
      const error = (this.unit === "N" ? point.error_n : point.error_jnd) ?? 1e3 * this.jnd;
      return {
        point,
        index,
        law: this.laws.indexOf(point.law),
        error: Math.min(1e3 * this.jnd, Math.max(error, least_jnd * this.jnd)),
        cost_us: Math.max(1e-3 * (point.p50_ns ?? 0), cheapest_us),
      };
    });
  }

  limits(): { x: [number, number]; y: [number, number] } {
    const errors = [this.jnd, ...this.points.map((it) => it.error)];
    const costs = [0.1, this.tick_us, ...this.points.map((it) => it.cost_us)];
    return {
      x: [0.5 * Math.min(...errors), 3 * Math.max(...errors)],
      y: [0.5 * Math.min(...costs), 3 * Math.max(...costs)],
    };
  }

  /** The front, cheapest first. */
  front(): PlacedPoint[] {
    return this.points.filter((it) => it.point.on_front).sort((a, b) => a.cost_us - b.cost_us);
  }
}

/** One line of a point, for the read-out and for who hears it. */
export function pointInWords(at: PlacedPoint): string {
  const { point } = at;
  const cost = `${withUnit(1e-9 * (point.p50_ns ?? 0), "s")} a tick, 99.9 % within ${withUnit(1e-9 * (point.p999_ns ?? NaN), "s")}`;
  const error = `error ${withUnit(point.error_n, "N")} (${plain(point.error_jnd, 2)} JND)`;
  const stable = point.stable ? "" : `; not stable: ${point.why_not_stable}`;
  const front = point.on_front ? "; on the front" : "";
  return `${point.law}, ${point.fidelity}: ${cost}; ${error}; ${point.parameters} parameters${front}${stable}`;
}
