// Cycles of a recording, found and mended.

export const phaseNumbers = { opening: 1, open_to_close: 2, closing: 3, close_to_open: 4 } as const;

/** [cycle, phase, first row, row after the last, time of the one, time of the other] */
export type PhaseRows = [number, number, number, number, number, number];

export interface FindSettings {
  prominence: number; // share of the range that a stroke covers
  corner_hz: number;
  dwell: number; // share of a stroke that counts as turning round
  closing: "" | "increasing" | "decreasing";
}

export interface Remark {
  cycle: number;
  kind: "by_hand" | "accepted";
  reason: string;
}

/** One cycle made two at a row, or a cycle and the next one made one. */
export type CycleStep = { kind: "split"; cycle: number; row: number } | { kind: "merge"; cycle: number };

export interface JudgedCycle {
  number: number;
  good: boolean;
  accepted: string | null;
  flags: { kind: string; reason: string }[];
  peak: number | null;
  work: number | null;
}

/** cycle_view() of the server. */
export interface CycleView {
  version: string;
  uuid: string; // of the recording
  author: string; // who has started the studio
  stored: boolean; // they are those in the file
  locked: string; // why they cannot be kept in it
  axis: number;
  rows: number;
  settings: FindSettings;
  closing_direction: number;
  contact_position: number | null;
  why_none: string;
  phases: PhaseRows[];
  cycles: JudgedCycle[];
  said: Remark[];
  average: { position: number[]; closing: (number | null)[]; opening: (number | null)[] } | null;
  loop: { cycle: number; position: number[]; force: (number | null)[] } | null;
  edits: { time: string; author: string; what: string }[];
}

/** Whether a fit is of cycles that the recording has no more; null: not known. */
export interface FitOfCycles {
  earlier: boolean | null;
  why: string;
}
