import type { LiveColumns } from "./live_columns";

export type TriggerMode = "off" | "auto" | "normal" | "single";
export type TriggerEdge = "rising" | "falling";

export interface TriggerSettings {
  mode: TriggerMode;
  trace: number; // index in the loop's traces
  level: number; // in the trace's unit
  edge: TriggerEdge;
}

/** Of the window that is shown when it has triggered, so much lies before. */
export const beforeTrigger = 0.2;

/**
 * Finds where a trace crosses a level, in columns as they come. A crossing counts where the trace was beyond the level
 * by a share of its swing before: noise about the level is none. It is told once the window after it is whole.
 */
export class TriggerFinder {
  private next = -1; // the first column that was not looked at
  private armed = false;
  private found: number | null = null; // column of a crossing whose window is not whole yet

  /** Another loop, grid or setting: nothing is known any more. */
  reset(): void {
    this.next = -1;
    this.armed = false;
    this.found = null;
  }

  /** The time of a crossing whose window [-0.2, 0.8] of `window_s` has just become whole; null: none. */
  look(columns: LiveColumns, settings: TriggerSettings, window_s: number): number | null {
    const { newestColumn: newest, oldestColumn: oldest, column_s } = columns;
    if (this.next < 0) this.next = Math.max(oldest, newest);
    this.next = Math.max(this.next, oldest);
    const after = Math.ceil(((1 - beforeTrigger) * window_s) / column_s);
    this.found ??= this.search(columns, settings);
    if (this.found === null || newest < this.found + after) return null;
    const at = this.found;
    this.found = null;
    this.armed = false; // what is shown now has its own crossing
    this.next = Math.max(this.next, at + after);
    return at * column_s;
  }

  private search(columns: LiveColumns, { trace, level, edge }: TriggerSettings): number | null {
    const up = edge === "rising" ? 1 : -1;
    const [smallest, largest] = [columns.smallest[trace], columns.largest[trace]];
    if (!smallest || !largest) return null;
    const aside = 0.02 * swingOf(smallest, largest);
    const oldest = columns.oldestColumn;
    for (; this.next <= columns.newestColumn; ++this.next) {
      const k = this.next - oldest;
      const low = up > 0 ? smallest[k]! : -largest[k]!;
      const high = up > 0 ? largest[k]! : -smallest[k]!;
      if (Number.isNaN(low)) continue;
      if (this.armed && high >= up * level) {
        this.armed = false;
        return this.next++;
      }
      if (low < up * level - aside) this.armed = true;
    }
    return null;
  }
}

/** The time of the first row from `from_s` on that is at the level or beyond it; null: none. */
export function crossingRow(
  time: ArrayLike<number>,
  values: ArrayLike<number>,
  { level, edge }: TriggerSettings,
  from_s: number,
): number | null {
  const up = edge === "rising" ? 1 : -1;
  for (let k = 0; k < time.length; ++k) if (time[k]! >= from_s && up * values[k]! >= up * level) return time[k]!;
  return null;
}

function swingOf(smallest: Float64Array, largest: Float64Array): number {
  let [low, high] = [Infinity, -Infinity];
  for (let k = 0; k < smallest.length; ++k) {
    if (smallest[k]! < low) low = smallest[k]!;
    if (largest[k]! > high) high = largest[k]!;
  }
  return high > low ? high - low : 0;
}
