// Recordings, and what is worth knowing of each.

export interface Axis {
  name: string;
  position_unit: string;
  force_unit: string;
}

export interface Trace {
  name: string;
  unit: string;
  group: "position" | "velocity" | "force" | "timing" | "channel";
}

export interface KerfEvent {
  time_s: number;
  kind: string;
  text: string;
}

export interface CycleSpan {
  cycle: number;
  phase: "opening" | "open_to_close" | "closing" | "close_to_open";
  from_s: number;
  to_s: number;
}

export interface Recording {
  id: string;
  rows: number;
  seconds: number;
  from_s: number;
  period_s: number;
  status: string;
  device: string;
  software: string;
  created: string;
  history: string;
  source: string;
  axes: Axis[];
  traces: Trace[];
  events: KerfEvent[];
  events_in_all: number;
  gaps: [number, number][] | null; // null: its rows are still being gone through
  gaps_in_all: number | null;
  prepared: number; // how much of that is done; 1: all
  cycles: {
    axis: number;
    closing_direction: number;
    contact_position: number;
    spans: CycleSpan[];
    flags: StoredFlag[] | null; // null: nobody has looked
  } | null;
}

export interface Loops {
  axis: string;
  position_unit: string;
  force_unit: string;
  cycles_in_all: number;
  averaged: number; // of them in the averages: those that are not left out
  segmented_here: boolean;
  reason?: string; // why there are no cycles
  loops: { cycle: number; rows: number; position: number[]; force: (number | null)[] }[];
  average: { position: number[]; closing: (number | null)[]; opening: (number | null)[] };
  whole?: { position: number[]; force: (number | null)[] }; // where there are no cycles: all rows
}

/** Columns of smallest and largest values; bytes_of() in the server's trace_view.h. */
export interface TraceView {
  rowsPerColumn: number;
  rowsLookedAt: number; // of each column, where these are the extremes of some rows; 0: of all
  prepared: number; // below 1 it is worth asking again
  time: Float64Array;
  traces: { smallest: Float32Array; largest: Float32Array }[];
}

/** What is wrong with a cycle; "accepted": it is good whatever else is said of it. */
export interface StoredFlag {
  cycle: number;
  kind: string;
  reason: string;
}
/** The end of a signal's range. */
interface SignalEnd {
  value: number | null;
  rows: number;
  clipped: boolean | null;
}
export interface InspectedSignal {
  unit: string;
  not_finite: number;
  quantum: number | null;
  noise: number | null;
  noise_idle?: number | null; // this and what may be missing: of forces
  noise_contact?: number | null;
  drift?: { over_all: number | null } | null;
  dead_zone?: boolean | null;
  zeros: { rows: number; nearest: number | null };
  least: SignalEnd;
  most: SignalEnd;
  outliers: number | null;
}
export interface InspectedCycle {
  number: number;
  begin_s: number;
  duration_s: number;
  wait_s: number;
  closing_s: number;
  hold_s: number;
  opening_s: number | null;
  peak: number | null;
  work: number | null;
  clipped_rows: number;
  good: boolean;
  accepted: string | null;
  flags: { kind: string; reason: string }[];
}
/** What `kerf inspect --json` says; null: not known. */
export interface Inspection {
  axis: string;
  rows: number;
  sampling: {
    duration_s: number | null;
    period_s: number | null;
    true_rate_hz: number | null;
    jitter_s: number | null;
    shortest_step_s: number | null;
    longest_step_s: number | null;
    resolution_s: number | null;
    gaps: number;
    repeated: number;
    backward: number;
    not_finite: number;
  };
  signals: Record<string, InspectedSignal>;
  contact: { felt: number; least: number; rows: number; stretches: unknown[] } | null;
  lag: { seconds: number; correlation: number; correlation_now: number } | null;
  cycles: {
    stored: boolean;
    good: string;
    force_unit: string; // of peaks
    work_unit: string; // "N·rad" of a force over an angle, which is no energy
    list: InspectedCycle[];
  } | null;
  warnings: string[];
}
export interface ClippedRun {
  signal: string;
  unit: string;
  value: number;
  rows: number;
  from_s: number;
  to_s: number;
}
export interface RecordingInspection {
  inspection: Inspection | null;
  why_none: string;
  clipped: ClippedRun[] | null;
}
