import { phaseNumbers, type CycleView } from "../api/cycles";
import type { Recording } from "../api/recordings";
import { kindsOf } from "../recordings/cycle_flags";
import type { CycleMark } from "../ui/time/cycle_marks";
import type { Span, TimeMarks } from "../ui/time/time_marks";
import { spanOf, type Draft, type Edge } from "./cycle_draft";

/** A boundary that is being dragged, and where it is. */
export interface Held {
  index: number; // of its phase
  edge: Edge;
  time_s: number;
}

/** Cycles as they are on the page, over time; a boundary that is held where it is held. */
export function draftMarks(about: Recording, view: CycleView, draft: Draft, held: Held | null): TimeMarks {
  const judged = new Map(view.cycles.map((it) => [it.number, it]));
  const spans = draft.phases.map(([cycle, phase, , , from, to], index): Span => {
    const isHeld = held?.index === index;
    const from_s = isHeld && held.edge === "begin" ? held.time_s : from;
    const to_s = isHeld && held.edge === "end" ? held.time_s : to;
    if (phase === phaseNumbers.closing) return { from_s, to_s, shade: "blue", text: `${cycle} closing` };
    if (phase === phaseNumbers.opening) return { from_s, to_s, shade: "orange", text: `${cycle} opening` };
    return { from_s, to_s, shade: "plain", text: "" };
  });
  const cycles = [...new Set(draft.phases.map((it) => it[0]))].map((number): CycleMark => {
    const it = judged.get(number);
    const reasons = it?.flags.map((flag) => flag.reason).join("; ") ?? "";
    return {
      ...spanOf(draft, number)!,
      flagged: it ? !it.good : false,
      texts: [`Cycle ${number}: ${reasons}`, `${number}: ${it ? kindsOf(it) : ""}`, String(number)],
    };
  });
  return { spans, gaps: about.gaps ?? [], events: about.events, cycles, clipped: [] };
}
