import type { FigureMark } from "../figure_description";
import type { Span, TimeMarks } from "./time_marks";
import type { TimeRange } from "./time_range";

const seen = 1 / 400; // of the width: what is shorter is a blur, unless something is wrong with it

const phases: Partial<Record<Span["shade"], FigureMark["kind"]>> = { blue: "closing", orange: "opening" };

/** The marks of a stretch as a figure has them, in the order in which they lie over each other. */
export function figureMarks(marks: TimeMarks, range: TimeRange, origin_s: number, unit: string): FigureMark[] {
  const found: FigureMark[] = [];
  const add = (kind: FigureMark["kind"] | undefined, from: number, to: number, texts: readonly string[] = []): void => {
    if (!kind || to < range.from || from > range.to) return;
    const isBlur = to - from < seen * range.span && ["closing", "opening", "cycle"].includes(kind);
    if (!isBlur) found.push({ kind, begin: from - origin_s, end: to - origin_s, texts });
  };
  for (const { shade, from_s, to_s, text } of marks.spans) add(phases[shade], from_s, to_s, [text]);
  for (const [from, to] of marks.gaps) add("gap", from, to);
  for (const { flagged, from_s, to_s, texts } of marks.cycles ?? []) if (flagged) add("flagged", from_s, to_s, texts);
  for (const { from_s, to_s } of marks.cycles ?? []) add("cycle", from_s, to_s);
  for (const it of marks.clipped ?? []) if (it.unit === unit) add("clipped", it.from_s, it.to_s);
  for (const { time_s } of marks.events) add("event", time_s, time_s);
  return found;
}
