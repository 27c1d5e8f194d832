import type { Figure } from "../ui/figure_description";

// What fits, charts, choices and stability maps come to; and laws.

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
  cv_rmse_rendered?: number | null; // missing in files of earlier versions, as the next
  cv_std_error?: number | null;
  test_rmse?: number | null; // of what no fit has seen
  test_rmse_rendered?: number | null;
  blame?: string; // what is to blame for its error, where it is not within the JND
  jnd_fraction: number;
  free_fraction?: number; // missing in files of earlier versions: of the rows before the tissue, those felt there
  undetermined_arms?: number;
  correlation: { parameters: string[]; matrix: (number | null)[][] };
  converged: boolean;
  message: string;
  warnings: string[];
}

export interface FitFile {
  recordings: { name: string; uuid?: string; axis: string; samples: number; left_out: number }[];
  samples: number;
  settings: { folds: number; confidence: number };
  line_rmse: number;
  line_cv_rmse?: number | null; // missing in files of earlier versions
  floor?: { position: number | null; velocity: number | null; noise: number }; // what nothing errs by less than
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
  recording?: string | null; // its UUID
  reference: string;
  rate_hz: number;
  jnd_n: number | null;
  force_unit?: string; // of errors and JND; missing in files of earlier versions
  compared_in: string; // "JND" where several axes are judged
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

export interface PlaneStability extends StabilityOf {
  study: "plane";
  cells: { viscous: number; coulomb: number; behaviour: string; region: string }[];
}

/** What has a picture and no cells. */
export interface CurveStability extends StabilityOf {
  study: "several" | "z_width" | "controllers";
}

export type StabilityFile = WallStability | LawStability | PlaneStability | CurveStability;

/** What was found of a device, unknown where it is null. */
export interface DeviceNumber {
  name: string;
  value: number | null;
  lower: number | null;
  upper: number | null;
  unit: string;
}

/** Whatever a result describes so is drawn. */
export interface DescribedChart {
  name: string;
  figure: Figure;
}

export interface DeviceAxis {
  name: string;
  problem: string;
  fits?: boolean | null; // missing, as what follows, where nothing was found; null: nobody can tell
  verdict?: string;
  why_not?: string[];
  numbers?: DeviceNumber[]; // missing in files of earlier versions, as the next
  charts?: DescribedChart[];
  z_width?: { in_words: string[] } | null; // null: it was not searched
}

export interface DeviceFile {
  device: string;
  model: string;
  held: boolean;
  axes: DeviceAxis[];
  charts?: DescribedChart[]; // of the whole device
}

/** A law file, and what a tool feels that goes in and out at a constant speed. */
export interface LawView {
  name: string;
  model: string;
  axis: string;
  position_unit: string;
  force_unit: string;
  equation: string;
  contact: { position: number; direction: number };
  options: Record<string, boolean | number | string>;
  parameters: { name: string; value: number; unit: string; std_error: number | null; meaning: string }[];
  toml: string;
  curve: { penetration: number[]; closing: number[]; opening: number[]; speed: number; range: string };
}

/** Measured less law, of the rows that the law is judged by; null in a column without one. */
export interface Residuals {
  axis: string;
  position_unit: string;
  force_unit: string;
  rows: number;
  rmse: number;
  worst: number;
  jnd_n: number;
  time_s: number[];
  smallest: (number | null)[];
  largest: (number | null)[];
  penetration: number[];
  mean: (number | null)[];
  low: (number | null)[];
  high: (number | null)[];
  over_time: {
    measured_smallest: (number | null)[];
    measured_largest: (number | null)[];
    not_judged_smallest: (number | null)[]; // measured in the other rows
    not_judged_largest: (number | null)[];
    law_smallest: (number | null)[];
    law_largest: (number | null)[];
  };
  /** Where its error lies, the largest share of the squared error first. */
  places: { from_s: number; to_s: number; cycle?: number; phase?: string; rmse: number; share: number }[];
  /** Half the width of the interval of the law's force; not there where a fit does not tell it. */
  interval?: { confidence: number; closing: (number | null)[]; opening: (number | null)[] };
  loop: {
    measured_closing: (number | null)[];
    measured_opening: (number | null)[];
    law_closing: (number | null)[];
    law_opening: (number | null)[];
  };
}
