import { isSilence } from "../../api/api";
import type { TraceView } from "../../api/recordings";
import type { TimeRange } from "./time_range";

const maxColumns = 4000; // that the server gives at once
const again_ms = 1000; // after an answer that is not yet what it will be

type Fetch = (from: number, to: number, columns: number, signal: AbortSignal) => Promise<TraceView>;

/**
 * Fetches what a plot shows, at the plot's pixels: the newest wish only, an outdated one is given up. When nothing
 * happens for a while it fetches a screen more on either side, so that moving along finds it there. What is shown
 * stays, stretched, until the new picture has come. What was made of some rows is asked for again until it is of all.
 */
export class StretchLoader {
  private asked: AbortController | null = null;
  private idle = 0;
  private soon = 0;
  private have: { from: number; to: number; span: number; columns: number; complete: boolean } | null = null;

  constructor(
    private readonly fetch: Fetch,
    private readonly show: (view: TraceView) => void,
    private readonly failed: (error: unknown) => void,
  ) {}

  end(): void {
    this.asked?.abort();
    clearTimeout(this.idle);
    clearTimeout(this.soon);
  }

  /** Fetches what the range shows now, unless it is there. */
  want(range: TimeRange, columns: number): void {
    clearTimeout(this.idle);
    clearTimeout(this.soon);
    if (this.holds(range, columns)) {
      this.prefetchWhenIdle(range, columns);
      return;
    }
    // A wheel turns many times in a moment: one request for them all.
    this.soon = window.setTimeout(() => void this.load(range, columns, 0), 40);
  }

  private holds({ from, to, span }: TimeRange, columns: number): boolean {
    const { have } = this;
    if (!have || from < have.from - 1e-9 || to > have.to + 1e-9) return false;
    return have.complete || (span > 0.999 * have.span && have.columns >= columns);
  }

  private async load(range: TimeRange, columns: number, screens: number): Promise<void> {
    this.asked?.abort();
    const asked = (this.asked = new AbortController());
    const span = range.span;
    const beside = screens * span * Math.min(1, Math.max(0, (maxColumns / columns - 1) / 2));
    const from = Math.max(range.first, range.from - beside);
    const to = Math.min(range.last, range.to + beside);
    const share = span > 0 ? (to - from) / span : 1; // of one row there is no span
    const wanted = Math.min(maxColumns, Math.max(1, Math.round(columns * share)));
    try {
      const view = await this.fetch(from, to, wanted, asked.signal);
      if (asked.signal.aborted) return;
      this.have = { from, to, span, columns, complete: view.rowsPerColumn <= 1 };
      this.show(view);
      if (view.prepared < 1) {
        this.have = null;
        this.idle = window.setTimeout(() => void this.load(range, columns, 0), again_ms);
        return;
      }
      if (screens === 0) this.prefetchWhenIdle(range, columns);
    } catch (error) {
      if (asked.signal.aborted || screens > 0) return;
      // That nobody answers the bar says.
      if (isSilence(error)) this.idle = window.setTimeout(() => void this.load(range, columns, 0), again_ms);
      else this.failed(error);
    }
  }

  private prefetchWhenIdle(range: TimeRange, columns: number): void {
    const { have } = this;
    clearTimeout(this.idle);
    if (!have) return;
    const left = range.from <= range.first || have.from <= range.from - 0.2 * range.span;
    const right = range.to >= range.last || have.to >= range.to + 0.2 * range.span;
    if ((left && right) || columns * 1.5 > maxColumns) return;
    this.idle = window.setTimeout(() => void this.load(range, columns, 1), 300);
  }
}
