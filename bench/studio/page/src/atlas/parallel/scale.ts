import type { SweepColumn, SweepFilter } from "../../api/sweeps";
import { shortName } from "../tiles";

/** Where the numbers of a column stand on its axis, from 0 at the bottom to 1. */
export class Scale {
  private readonly smallest: number;
  private readonly largest: number;
  private readonly logarithmic: boolean;
  private readonly listed: number; // so many values at equal distances; 0: they are not listed

  constructor(
    readonly column: SweepColumn,
    numbers: readonly (number | null)[],
  ) {
    this.listed = column.texts.length;
    const known = numbers.filter((it): it is number => it !== null);
    this.smallest = known.reduce((a, b) => Math.min(a, b), Infinity);
    this.largest = known.reduce((a, b) => Math.max(a, b), -Infinity);
    this.logarithmic = this.smallest > 0 && this.largest / this.smallest > 100;
  }

  /** Null: not known. */
  place(value: number | null): number | null {
    if (value === null) return null;
    if (this.listed > 0) return this.listed < 2 ? 0.5 : value / (this.listed - 1);
    if (!(this.smallest < this.largest)) return 0.5;
    return this.logarithmic
      ? Math.log(value / this.smallest) / Math.log(this.largest / this.smallest)
      : (value - this.smallest) / (this.largest - this.smallest);
  }

  private at(place: number): number {
    return this.logarithmic
      ? this.smallest * (this.largest / this.smallest) ** place
      : this.smallest + place * (this.largest - this.smallest);
  }

  ticks(): { at: number; text: string }[] {
    const most = 6;
    if (this.listed > 0) {
      const stride = Math.ceil(this.listed / most);
      const ticks = [];
      for (let i = 0; i < this.listed; i += stride) {
        const value = this.column.values[i];
        const text = value == null ? shortName(this.column.texts[i] ?? "") : String(Number(value.toPrecision(3)));
        ticks.push({ at: this.listed < 2 ? 0.5 : i / (this.listed - 1), text });
      }
      return ticks;
    }
    if (!(this.smallest <= this.largest)) return [];
    if (this.smallest === this.largest) return [{ at: 0.5, text: String(this.smallest) }];
    return Array.from({ length: most }, (_, i) => i / (most - 1)).map((at) => ({
      at,
      text: String(Number(this.at(at).toPrecision(3))),
    }));
  }

  /** What a stretch of the axis lets through; null: it leaves nothing out, or holds no value. */
  filter(lower: number, upper: number): SweepFilter | null {
    if (this.listed > 0) {
      const near = Math.min(0.02, 0.4 / Math.max(1, this.listed - 1)); // nobody hits the very end
      const kept = this.column.texts.filter((_, i) => {
        const at = this.listed < 2 ? 0.5 : i / (this.listed - 1);
        return at >= lower - near && at <= upper + near;
      });
      return kept.length === 0 || kept.length === this.listed ? null : kept;
    }
    return this.smallest < this.largest ? [this.at(lower), this.at(upper)] : null;
  }

  /** The stretch that a filter lets through. */
  stretch(filter: SweepFilter): [number, number] | null {
    const places: number[] = [];
    for (const it of filter) {
      if (typeof it === "string") {
        const i = this.column.texts.indexOf(it);
        if (i >= 0) places.push(this.listed < 2 ? 0.5 : i / (this.listed - 1));
      } else if (this.listed === 0) {
        places.push(Math.min(Math.max(it === null ? (places.length > 0 ? 1 : 0) : (this.place(it) ?? 0), 0), 1));
      }
    }
    if (places.length === 0) return null;
    const half = this.listed > 1 ? 0.4 / (this.listed - 1) : 0;
    return [Math.max(0, Math.min(...places) - half), Math.min(1, Math.max(...places) + half)];
  }
}
