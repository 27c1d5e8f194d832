// Studies: drawers of files, as kerf study has run them; null: not known.

export interface StudyEntry {
  id: string;
  name: string; // the folder that it lies in
  error: string; // why it cannot be read; empty if it can, and then there is all below
  state: "not run" | "run" | "changed";
  changes: string[]; // since the run, a sentence each
  run_at: string; // ISO 8601; empty: it was not run
  software: string;
  recordings: number;
  blanks: number; // of these
  files: number; // in the drawer
  tissues: string[];
  speeds: string[];
  specimens: string[];
  counted: number | null; // recordings in what is said of their tissue and speed
  failed: number | null;
  doubted: number | null;
}
export interface Conclusion {
  says: "yes" | "partly" | "no" | "unknown";
  sentence: string;
}
export interface DrawerRecording {
  name: string;
  id: string | null; // in the workspace
  file: string; // below the drawer
  tissue: string;
  speed: string;
  specimen: string | null;
  blank: boolean;
  counts: boolean | null;
  failure: string | null;
  doubts: string[];
  accepted: string | null; // why it counts all the same
  warnings: string[];
  cycles: number | null;
  good_cycles: number | null;
  flagged: { cycle: number; reason: string }[] | null;
  law: string | null;
  held_out_jnd: number | null;
  not_fitted: string | null;
}
type Interval = [number | null, number | null] | null;
export interface GroupEstimate {
  recordings: number;
  specimens: number | null;
  mean: number | null;
  ci95: Interval;
  between_specimens: { value: number } | null;
  between_recordings: { value: number } | null;
}
export interface StudiedGroup {
  tissue: string;
  speed: string;
  recordings: string[]; // that count
  left_out: number;
  serves: string | null;
  laws: {
    law: string;
    free_parameters: number;
    serves: number;
    held_out_jnd: GroupEstimate;
    on_others_jnd: GroupEstimate;
  }[];
  quantities: { name: string; unit: string; logarithm: boolean; estimate: GroupEstimate }[];
}
export interface StudiedComparison {
  quantity: string;
  first: string;
  second: string;
  verdict: string;
  logarithm: boolean; // of ratios
  first_units: number;
  second_units: number;
  difference: number | null;
  ci95: Interval;
  hedges_g: number | null;
  p: number | null;
  p_holm: number | null;
}
export interface Study extends StudyEntry {
  laws: string[];
  all_cycles: boolean;
  closing: string;
  map: string;
  report: boolean;
  tables: string[];
  law: string | null; // that serves most
  conclusions: Conclusion[];
  drawer: DrawerRecording[];
  ignored: { file: string; why: string }[];
  groups: StudiedGroup[];
  comparisons: StudiedComparison[];
}
