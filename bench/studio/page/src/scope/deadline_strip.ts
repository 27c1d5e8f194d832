import type { KerfEvent } from "../api/recordings";
import { element } from "../ui/dom";
import { palette } from "../ui/palette";
import type { TimeLine } from "../ui/time/time_line";

/** What a column of ticks is like: each kind has a height of its own beside its colour. */
export type Deadline = "met" | "late" | "missed" | "none";

/** Late: reading, computing and writing, begun as late as it was, did not end within the period. */
export function deadlineAt(wake: TimeLine, cycle: TimeLine, column: number, period_s: number): Deadline {
  const [late, work] = [wake.largest[column], cycle.largest[column]];
  if (late === undefined || work === undefined) return "none";
  if (Number.isNaN(late) || Number.isNaN(work)) return "missed";
  return late + work > period_s ? "late" : "met";
}

/** A strip as wide as the plots: which deadlines were met, tick by tick or column by column. */
export class DeadlineStrip {
  readonly root: HTMLElement;
  /** The counts, in words; beside the strip, which is as wide as the plots. */
  readonly reading = element("p", { class: "scope_reading deadline_reading" });
  private readonly canvas = element("canvas", { class: "deadline_canvas", "aria-hidden": "true" });

  constructor() {
    this.root = element("div", { class: "deadline_strip" }, element("span", {}, "Deadlines"), this.canvas);
  }

  /** `events` tell how many ticks were missed: a column has a value as long as one of its ticks has. */
  draw(
    lines: readonly TimeLine[],
    events: readonly KerfEvent[],
    range: { from: number; to: number },
    period_s: number,
    firstTick_s: number,
  ): void {
    const { from, to } = range;
    const wake = lines.find((it) => it.name === "wake latency");
    const cycle = lines.find((it) => it.name === "cycle time");
    const pixels = window.devicePixelRatio || 1;
    const { canvas } = this;
    const [width, height] = [Math.round(canvas.clientWidth * pixels), Math.round(canvas.clientHeight * pixels)];
    if (width < 2 || height < 2 || !wake || !cycle) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const context = canvas.getContext("2d");
    if (!context) return;
    context.clearRect(0, 0, width, height);
    const colours = palette();
    const counts: Record<Deadline, number> = { met: 0, late: 0, missed: 0, none: 0 };
    const fills: Record<Deadline, string> = {
      met: colours.lines[2]!,
      late: colours.lines[4]!,
      missed: colours.ink,
      none: "",
    };
    const tall: Record<Deadline, number> = { met: 0.3, late: 0.65, missed: 1, none: 0 };
    const step = wake.step_s;
    const end = lastWithValue(wake);
    const add = (kind: Deadline, at: number, until: number): void => {
      if (kind === "none" || until < from || at > to) return;
      ++counts[kind];
      const x = ((at - from) / (to - from)) * width;
      context.fillStyle = fills[kind];
      context.fillRect(
        x,
        height * (1 - tall[kind]),
        Math.max(1, ((until - at) / (to - from)) * width),
        height * tall[kind],
      );
    };
    for (let k = 0; k <= end; ++k) {
      const at = wake.time[k]! + wake.shift_s;
      if (at < firstTick_s) continue;
      add(deadlineAt(wake, cycle, k, period_s), at, at + step);
    }
    const stretches = counts.met + counts.late + counts.missed;
    let missed = 0;
    for (const event of events) {
      if (event.kind !== "missed_deadline" || event.time_s < from || event.time_s > to) continue;
      const ticks = missedTicks(event.text);
      missed += ticks;
      add("missed", event.time_s - ticks * period_s, event.time_s);
    }
    const each = step > 1.5 * period_s ? `stretches of ${Math.round(step / period_s)} ticks` : "ticks";
    const text = `Deadlines: ${missed} missed, ${counts.late} late of ${stretches} ${each}`;
    if (this.reading.textContent !== text) this.reading.textContent = text;
  }
}

/** 3 of "3 ticks are not in the file". */
export function missedTicks(text: string): number {
  return Number(/^(\d+) ticks?\b/.exec(text)?.[1] ?? 1);
}

/** Columns after it are yet to come; one without a value before it was missed. */
function lastWithValue(line: TimeLine): number {
  let k = line.smallest.length - 1;
  while (k >= 0 && Number.isNaN(line.smallest[k])) --k;
  return k;
}
