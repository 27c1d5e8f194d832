import { Requests } from "./requests";
import type { Figure } from "./ui/figure_description";
import type { ForceState } from "./ui/force/force_states";

// What the server answers. Every request carries the token in a header that no other site can send.

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

// Workspace

export interface WorkspaceRecording {
  id: string;
  name: string; // path within the workspace
  bytes: number;
  modified: string; // ISO 8601
  partial: boolean; // not closed: being written, or left by a crash
  seconds?: number; // where the server knows it without opening the file
}
export interface WorkspaceLaw {
  id: string;
  name: string;
  model: string;
  axis: string;
  position_unit: string;
  force_unit: string;
  breakpoints: boolean; // knots that the segment editor moves
  axes: Axis[]; // that it acts on
  error: string; // why it cannot be read; empty if it can
}
export interface WorkspaceSession {
  id: string;
  name: string;
  subject: string; // a code
  key: string; // "key file" or "passphrase"
  finished: boolean;
  answered: number;
  error: string;
}
export interface WorkspaceFile {
  id: string;
  name: string;
  kind: "fit" | "chart" | "choice" | "stability" | "suite" | "scene" | "protocol";
}
export interface Workspace {
  folder: string;
  version: string;
  device: string;
  recordings: WorkspaceRecording[];
  laws: WorkspaceLaw[];
  sessions: WorkspaceSession[];
  files: WorkspaceFile[];
}

// The running loop

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

// Recordings

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

// Segment editor: penetration is position along the closing, from first contact; forces resist closing.

export interface EditorCurve {
  recording: string;
  axis: string;
  position_unit: string;
  force_unit: string;
  cycles: number;
  segmented_here: boolean;
  contact_position: number;
  closing_direction: number;
  penetration: number[];
  closing: (number | null)[];
  opening: (number | null)[];
  jnd: { weber_fraction: number; threshold_n: number };
}
export interface Knots {
  penetration: number[];
  closing: number[];
  opening: number[]; // empty: one branch
}
export interface LawError {
  rmse_n: number;
  worst_n: number;
  worst_penetration: number;
  worst_branch: "closing" | "opening";
  jnd_n: number; // at the root mean square force
  rmse_jnd: number;
  worst_jnd: number; // largest error in JNDs of the force there
}
export interface DrawnLaw {
  name: string; // of the file, without .law.toml
  recording: string; // id
  axis: number;
  knots: Knots;
  replace: boolean;
}

// Work that takes a while: fits, charts, choices, stability maps

export interface Job {
  job: number;
  kind: "fit" | "chart" | "choice" | "stability";
  title: string;
  state: "waiting" | "running" | "done" | "failed" | "stopped";
  share: number; // 0 to 1; -1 where it is not known
  error: string;
  file: string; // id of the result in the workspace; empty if there is none yet
}

/** A law that can be fitted; empty units: any axis. */
export interface FittedLaw {
  model: string;
  equation: string;
  position_unit: string;
  force_unit: string;
  usual: boolean; // fitted where none is named
}

// What the program's own verbs write; null: not finite.

export interface Estimate {
  value: number;
  std_error: number | null;
  unit: string;
  [interval: string]: number | string | null | [number | null, number | null]; // "ci95"
}
export interface LawFit {
  model: string;
  options: Record<string, boolean | number | string>;
  law_files: string[];
  parameters: Record<string, Estimate>;
  free_parameters: number;
  rmse: number;
  max_abs: number;
  r2: number;
  bic: number;
  cv_rmse: number | null;
  cv_rmse_rendered?: number | null; // missing in files of earlier versions
  blame?: string; // what is to blame for its error, where it is not within the JND
  jnd_fraction: number;
  correlation: { parameters: string[]; matrix: (number | null)[][] };
  converged: boolean;
  message: string;
  warnings: string[];
}
export interface FitFile {
  recordings: { name: string; axis: string; samples: number; left_out: number }[];
  samples: number;
  settings: { folds: number; confidence: number };
  line_rmse: number;
  jnd: number;
  fits: LawFit[];
  refused: { model: string; why: string }[];
  choice: { model: string; why: string; within_jnd?: boolean | null }; // null: nothing was held out
  force_unit?: string; // missing in files of earlier versions
  warnings: string[];
}
export interface ChartPoint {
  law: string;
  fidelity: string;
  law_file: string; // within the chart's folder
  parameters: number;
  rate_hz: number;
  p50_ns: number | null;
  p999_ns: number | null;
  cold_p50_ns: number | null;
  cold_p99_ns?: number | null; // missing in files of earlier versions
  cold_p999_ns: number | null;
  cold_ticks?: number; // missing in files of earlier versions, whose cold_p999_ns is the largest of 128
  error_n: number | null;
  error_jnd: number | null;
  jnd_fraction?: number | null; // missing in files of earlier versions, as the next
  within_jnd?: boolean;
  worst_n: number | null;
  axis: string;
  stable: boolean | null; // null: nobody judged it
  why_not_stable: string;
  why_not_judged?: string; // missing in files of earlier versions
  on_front: boolean;
  on_cold_front?: boolean; // missing in files of earlier versions
}
export interface ChartFile {
  source: string;
  reference: string;
  rate_hz: number;
  jnd_n: number | null;
  compared_in: "N" | "JND";
  points: ChartPoint[];
  notes: string[];
  figure: Figure;
}
export interface ChoiceCandidate {
  law: string;
  model: string;
  parameters: number;
  converged: boolean;
  held_out: number | null;
  held_out_fitted?: number | null; // missing in files of earlier versions
  held_out_jnd: number | null;
  within_jnd: boolean;
  tick_us: number;
  stable: boolean | null; // null: nobody judged it
  why_not_judged?: string; // missing in files of earlier versions
  passed_over: string; // empty: it was taken
}
export interface ChoiceFile {
  name: string;
  axis: string;
  device: string | null;
  jnd: number;
  held_out_by: string;
  choice: {
    law: string | null;
    serves: boolean;
    in_doubt?: boolean;
    as_good: string | null;
    why: string;
    blame?: string | null;
  };
  force_unit?: string; // missing in files of earlier versions
  effects: { effect: string; verdict: string; why: string }[];
  candidates: ChoiceCandidate[];
  warnings: string[];
}
interface StabilityOf {
  on: {
    device: string;
    axis: string;
    grip: string;
    rate_hz: number;
  };
  in_words: string[];
  figure?: Figure; // missing where there are no cells
}
export interface WallStability extends StabilityOf {
  study: "wall";
  cells: { K: number; B: number; stable: boolean; theory: boolean }[];
}
export interface LawStability extends StabilityOf {
  study: "law";
  law: string;
  law_file?: string;
  range: { depth_m: number; speed_m_s: number };
  passive: boolean;
  cells: { depth_m: number; rate_hz: number; stable: boolean; theory: boolean }[];
}
export type StabilityFile = WallStability | LawStability;

/** A law file, and what a tool feels that goes in and out at a constant speed. */
export interface LawView {
  name: string;
  model: string;
  axis: string;
  position_unit: string;
  force_unit: string;
  equation: string;
  options: Record<string, boolean | number | string>;
  parameters: { name: string; value: number; unit: string; std_error: number | null; meaning: string }[];
  toml: string;
  curve: { penetration: number[]; closing: number[]; opening: number[]; speed: number; range: string };
}
/** Law less measured force. */
export interface Residuals {
  axis: string;
  position_unit: string;
  force_unit: string;
  rows: number;
  rmse: number;
  worst: number;
  jnd_n: number;
  time_s: number[];
  smallest: number[];
  largest: number[];
  penetration: number[];
  mean: (number | null)[];
  low: (number | null)[];
  high: (number | null)[];
  loop: {
    measured_closing: (number | null)[];
    measured_opening: (number | null)[];
    law_closing: (number | null)[];
    law_opening: (number | null)[];
  };
}

// Sessions

export interface SessionState {
  running: boolean;
  name: string;
  subject_url: string;
  answered: number;
  at_most: number;
  adaptive: boolean;
  stage: string;
  ended: string;
  warnings: string[];
}

export class ApiError extends Error {
  constructor(
    readonly status: number,
    message: string,
  ) {
    super(message);
  }
}

type Parameters = Record<string, string | number | readonly number[]>;

export class Api {
  private readonly requests = new Requests();

  constructor(readonly token: string) {}

  async get<Answer>(path: string, parameters: Parameters = {}, signal?: AbortSignal): Promise<Answer> {
    return this.read(path, parameters, signal, async (answer) => (await answer.json()) as Answer);
  }

  async post<Answer = unknown>(path: string, body: unknown = {}): Promise<Answer> {
    const answer = await this.send(path, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
    });
    return (await answer.json()) as Answer;
  }

  /** A stretch of traces: /api/live/view or /api/recording/view. */
  async view(path: string, parameters: Parameters, signal?: AbortSignal): Promise<TraceView> {
    return this.read(path, parameters, signal, async (answer) => traceView(await answer.arrayBuffer()));
  }

  /** Server-sent events; the browser connects again by itself. */
  stream(path: string, parameters: Parameters = {}): EventSource {
    return new EventSource(address(path, { ...parameters, token: this.token }));
  }

  /** Past what else is being read, so that only a studio that does not answer is late. */
  async loopStatus(signal: AbortSignal): Promise<LoopStatus> {
    return (await (await this.send("/api/live/status", { signal })).json()) as LoopStatus;
  }

  /**
   * Asks for zero force until somebody has heard it: needs nothing that this page knows, not even the token. What else
   * waits for an answer is given up first, since a browser opens only six connections to one server.
   */
  async zeroForce(): Promise<void> {
    this.requests.giveUp();
    for (let tries = 0; ; ++tries) {
      const patience = new AbortController();
      const timer = setTimeout(() => patience.abort(), 1000);
      try {
        await this.send("/api/live/zero", { method: "POST", keepalive: true, signal: patience.signal });
        return;
      } catch (error) {
        if (tries >= 20 || (error instanceof ApiError && error.status === 403))
          throw error instanceof ApiError ? error : silent();
        await new Promise((go) => setTimeout(go, 100));
      } finally {
        clearTimeout(timer);
      }
    }
  }

  private read<Answer>(
    path: string,
    parameters: Parameters,
    signal: AbortSignal | undefined,
    take: (answer: Response) => Promise<Answer>,
  ): Promise<Answer> {
    return this.requests.take(async (own) => take(await this.send(address(path, parameters), { signal: own })), signal);
  }

  private async send(path: string, options: RequestInit): Promise<Response> {
    const headers = { ...(options.headers as Record<string, string>), "X-Kerf-Token": this.token };
    let answer: Response;
    try {
      answer = await fetch(path, { ...options, headers });
    } catch (error) {
      if (error instanceof DOMException && error.name === "AbortError") throw error;
      throw silent();
    }
    if (answer.ok) return answer;
    const text = await answer.text();
    throw new ApiError(answer.status, errorIn(text) ?? `${answer.status} ${text.trim()}`);
  }
}

function silent(): ApiError {
  return new ApiError(0, "The studio does not answer. Is 'kerf studio' still running?");
}

function address(path: string, parameters: Parameters): string {
  const parts = Object.entries(parameters).map(([name, value]) => `${name}=${String(value)}`);
  return parts.length > 0 ? `${path}?${parts.join("&")}` : path;
}

function errorIn(text: string): string | null {
  try {
    const json = JSON.parse(text) as { error?: unknown };
    return typeof json.error === "string" ? json.error : null;
  } catch {
    return null;
  }
}

export function traceView(bytes: ArrayBuffer): TraceView {
  const [columns = 0, count = 0] = new Uint32Array(bytes, 0, 2);
  const rowsPerColumn = new Float64Array(bytes, 8, 1)[0] ?? 1;
  const time = new Float64Array(bytes, 16, columns);
  const traces = [];
  for (let trace = 0, at = 16 + 8 * columns; trace < count; ++trace, at += 8 * columns) {
    traces.push({
      smallest: new Float32Array(bytes, at, columns),
      largest: new Float32Array(bytes, at + 4 * columns, columns),
    });
  }
  return { rowsPerColumn, time, traces };
}
