import type { ForceState } from "../ui/force/force_states";
import type { Axis, KerfEvent } from "./recordings";

// The running loop.

export interface Percentiles {
  p50: number;
  p99: number;
  p999: number;
  max: number;
}

export interface LoopStatus {
  running: boolean;
  starting?: boolean; // its device is being opened
  run?: number; // how many loops there were, this one included
  device: string;
  axes: Axis[];
  rate_hz: number;
  law: string; // empty: nothing is rendered
  released: boolean; // zero force was asked for
  blending: boolean;
  recording: { name: string; rows: number; seconds: number } | null;
  warning?: string; // what is to be known of the device of this loop; else empty
  recording_failure: string;
  ticks: number;
  missed: number;
  rows_lost: number;
  wake_s: Percentiles; // of the last ten seconds
  cycle_s: Percentiles;
  whole_wake_s: Percentiles; // since the loop began
  whole_cycle_s: Percentiles;
  ended: string; // the fault that ended the loop, until dismissed; else empty
  force: ForceState;
  force_reason: string; // why, where a person has to know
  session: boolean; // a session is running: nothing of the loop is shown
}

export interface LiveFrame {
  run?: number; // of which loop
  from: number; // tick of the first column
  ticks: number; // in a column
  period_s: number;
  smallest: (number | null)[][]; // [trace][column]
  largest: (number | null)[][];
  events: KerfEvent[];
}
