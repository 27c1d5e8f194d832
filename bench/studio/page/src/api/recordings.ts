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
  gaps: [number, number][];
  gaps_in_all: number;
  cycles: { axis: number; closing_direction: number; contact_position: number; spans: CycleSpan[] } | null;
}

export interface Loops {
  axis: string;
  position_unit: string;
  force_unit: string;
  cycles_in_all: number;
  segmented_here: boolean;
  reason?: string; // why there are no cycles
  loops: { cycle: number; position: number[]; force: (number | null)[] }[];
  average: { position: number[]; closing: (number | null)[]; opening: (number | null)[] };
}

/** Columns of smallest and largest values; bytes_of() in the server's trace_view.h. */
export interface TraceView {
  rowsPerColumn: number;
  time: Float64Array;
  traces: { smallest: Float32Array; largest: Float32Array }[];
}
