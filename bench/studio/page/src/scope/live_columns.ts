import type { LiveFrame } from "../api/loop";

/**
 * The newest columns of the running loop, oldest first, in arrays that stay: column k holds the smallest and the
 * largest of ticks [k N, (k + 1) N), NaN where there are none.
 */
export class LiveColumns {
  readonly time: Float64Array; // of each column's first tick
  readonly smallest: readonly Float64Array[];
  readonly largest: readonly Float64Array[];
  period_s = 1e-3;
  private newest = -1; // the column at the end of the arrays; -1: none yet
  private run: number | undefined; // of which loop they are
  private first = Infinity; // the oldest column that anything was told of

  constructor(
    readonly traces: number,
    readonly ticks: number, // in a column
    readonly capacity: number,
  ) {
    this.time = new Float64Array(capacity);
    const arrays = (): Float64Array[] => Array.from({ length: traces }, () => new Float64Array(capacity).fill(NaN));
    this.smallest = arrays();
    this.largest = arrays();
    this.setTimes();
  }

  get column_s(): number {
    return this.ticks * this.period_s;
  }

  /** When the oldest column begins that anything was told of. */
  get firstTick_s(): number {
    return this.first === Infinity ? Infinity : this.first * this.column_s;
  }

  /** Numbers of the columns at both ends of the arrays: column k begins at k column_s. */
  get newestColumn(): number {
    return this.newest;
  }

  get oldestColumn(): number {
    return this.newest - this.capacity + 1;
  }

  /** Where the newest column ends. */
  get end_s(): number {
    return (this.newest + 1) * this.column_s;
  }

  /** Room up to where the loop is: what a stream tells of the past is put where it belongs, or left out. */
  beginAt(tick: number): void {
    this.newest = Math.floor(tick / this.ticks) - 1;
    this.setTimes();
  }

  /** False if the frame is of another loop or another grid: a new one of these is needed. */
  push(frame: LiveFrame): boolean {
    if (frame.ticks !== this.ticks || frame.smallest.length !== this.traces) return false;
    const columns = frame.smallest[0]?.length ?? 0;
    if (columns === 0) return true;
    this.run ??= frame.run;
    if (this.run !== frame.run) return false;
    const first = Math.round(frame.from / this.ticks);
    this.period_s = frame.period_s;
    if (this.newest < 0) this.newest = first - 1;
    this.advance(first + columns - 1);
    this.first = Math.min(this.first, first);
    const at = this.capacity - 1 - this.newest + first;
    for (let trace = 0; trace < this.traces; ++trace) {
      const [smallest, largest] = [frame.smallest[trace], frame.largest[trace]];
      const [to, up] = [this.smallest[trace]!, this.largest[trace]!];
      for (let k = Math.max(0, -at); k < columns; ++k) {
        to[at + k] = smallest?.[k] ?? NaN;
        up[at + k] = largest?.[k] ?? NaN;
      }
    }
    return true;
  }

  /** Takes what a finer or coarser one holds: no value is lost, but one may show in two neighbouring columns. */
  takeFrom(other: LiveColumns): void {
    if (other.newest < 0 || other.traces !== this.traces) return;
    this.period_s = other.period_s;
    this.run = other.run;
    this.newest = Math.ceil(((other.newest + 1) * other.ticks) / this.ticks) - 1;
    if (other.first < Infinity) this.first = Math.ceil((other.first * other.ticks) / this.ticks);
    this.setTimes();
    for (let k = 0; k < other.capacity; ++k) {
      const tick = (other.newest - other.capacity + 1 + k) * other.ticks;
      if (tick >= 0) this.merge(tick, tick + other.ticks, other.smallest, other.largest, k);
    }
  }

  /** Widens the columns of ticks [from, to) by column k of others. */
  private merge(
    from: number,
    to: number,
    smallest: readonly Float64Array[],
    largest: readonly Float64Array[],
    k: number,
  ): void {
    const oldest = this.newest - this.capacity + 1;
    const first = Math.max(0, Math.floor(from / this.ticks) - oldest);
    const end = Math.min(this.capacity, Math.ceil(to / this.ticks) - oldest);
    for (let trace = 0; trace < this.traces; ++trace) {
      const low = smallest[trace]?.[k] ?? NaN;
      const high = largest[trace]?.[k] ?? NaN;
      if (Number.isNaN(low)) continue;
      const [down, up] = [this.smallest[trace]!, this.largest[trace]!];
      for (let i = first; i < end; ++i) {
        if (!(down[i]! <= low)) down[i] = low;
        if (!(up[i]! >= high)) up[i] = high;
      }
    }
  }

  private advance(newest: number): void {
    const by = newest - this.newest;
    this.newest = Math.max(newest, this.newest);
    if (by > 0) {
      for (let trace = 0; trace < this.traces; ++trace) {
        shift(this.smallest[trace]!, by);
        shift(this.largest[trace]!, by);
      }
    }
    this.setTimes();
  }

  private setTimes(): void {
    const first = this.newest - this.capacity + 1;
    for (let i = 0; i < this.capacity; ++i) this.time[i] = (first + i) * this.column_s;
  }
}

function shift(values: Float64Array, by: number): void {
  const kept = values.length - by;
  if (kept > 0) values.copyWithin(0, by);
  values.fill(NaN, Math.max(0, kept));
}

/** Ticks in a column, so that a column is at most a pixel wide. */
export function ticksInColumn(window_s: number, rate_hz: number, pixels: number): number {
  return Math.max(1, Math.floor((window_s * rate_hz) / Math.max(1, pixels)));
}
