import type { ClippedRun, CycleSpan, Recording, RecordingInspection } from "../api/recordings";
import { button, element } from "../ui/dom";
import { plain } from "../ui/numbers";
import type { ClippedMark, CycleMark } from "../ui/time/cycle_marks";

/** A cycle of a recording and what is said of it. */
export interface Cycle {
  number: number;
  from_s: number;
  to_s: number;
  good: boolean;
  accepted: string | null;
  flags: { kind: string; reason: string }[];
}

const words: Record<string, string> = {
  put_down: "tool put down",
  under_force: "under force",
  clipped: "clipped",
  interrupted: "interrupted",
  outlier: "outlier",
  by_hand: "flagged by hand",
};

/** Kinds in words: "tool put down, clipped". */
export function kindsOf(cycle: { flags: { kind: string }[] }): string {
  return [...new Set(cycle.flags.map((it) => words[it.kind] ?? it.kind))].join(", ");
}

/** What is found now; before that, and of recordings that are too long, what the file says. */
export function cyclesOf(recording: Recording, found: RecordingInspection | null): Cycle[] {
  if (found?.inspection)
    return (found.inspection.cycles?.list ?? []).map((it) => ({
      number: it.number,
      from_s: it.begin_s,
      to_s: it.begin_s + it.duration_s,
      good: it.good,
      accepted: it.accepted,
      flags: it.flags,
    }));
  return storedCycles(recording);
}

function storedCycles(recording: Recording): Cycle[] {
  const cycles = new Map<number, Cycle>();
  for (const span of recording.cycles?.spans ?? []) widen(cycles, span);
  for (const { cycle, kind, reason } of recording.cycles?.flags ?? []) {
    const of = cycles.get(cycle);
    if (!of) continue;
    if (kind === "accepted") of.accepted = reason;
    else of.flags.push({ kind, reason });
    of.good = of.flags.length === 0 || of.accepted !== null;
  }
  return [...cycles.values()];
}

function widen(cycles: Map<number, Cycle>, span: CycleSpan): void {
  const { cycle: number, from_s, to_s } = span;
  const known = cycles.get(number);
  if (!known) cycles.set(number, { number, from_s, to_s, good: true, accepted: null, flags: [] });
  else [known.from_s, known.to_s] = [Math.min(known.from_s, from_s), Math.max(known.to_s, to_s)];
}

/** What is drawn of them; those that are flagged with the longest text for which there is room. */
export function cycleMarks(cycles: readonly Cycle[]): CycleMark[] {
  return cycles.map((it) => ({
    from_s: it.from_s,
    to_s: it.to_s,
    flagged: !it.good,
    texts: [
      `Cycle ${it.number}: ${it.flags.map((flag) => flag.reason).join("; ")}`,
      `${it.number}: ${kindsOf(it)}`,
      String(it.number),
    ],
  }));
}

export function clippedMarks(runs: readonly ClippedRun[] | null): ClippedMark[] {
  return (runs ?? []).map(({ from_s, to_s, unit }) => ({ from_s, to_s, unit }));
}

/** "Cycles 12, 2 flagged". */
export function flaggedInWords(cycles: readonly Cycle[]): string {
  const flagged = cycles.filter((it) => !it.good).length;
  return `Cycles ${cycles.length === 0 ? "none" : cycles.length}${flagged > 0 ? `, ${flagged} flagged` : ""}`;
}

/** The flagged cycles with their reasons; a press shows one. */
export class FlaggedCycles {
  readonly root = element("section", { class: "recording_flags" });

  constructor(private readonly go: (from_s: number, to_s: number) => void) {}

  show(cycles: readonly Cycle[]): void {
    const said = cycles.filter((it) => it.flags.length > 0 || it.accepted !== null);
    this.root.replaceChildren(
      element("h2", {}, flaggedInWords(cycles)),
      element("ol", { class: "event_list" }, ...said.map((it) => this.entry(it))),
    );
  }

  private entry(it: Cycle): HTMLElement {
    const kinds = kindsOf(it);
    const accepted = it.accepted === null ? "" : ` (accepted: ${it.accepted})`;
    const press = (): void => this.go(it.from_s, it.to_s);
    return element(
      "li",
      { class: it.good ? "" : "flagged" },
      button(`${it.number}, from ${plain(it.from_s, 4)} s: ${kinds || "good"}${accepted}`, press, { class: "plain" }),
      ...it.flags.map((flag) => element("p", { class: "quiet" }, flag.reason)),
    );
  }
}
