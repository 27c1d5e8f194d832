// Files of other programs on their way into the folder; what `kerf import` makes of them.

/** What an import file says beside its map; what is left out is as the program has it. */
export interface MappingOptions {
  sheet?: string;
  stretch?: number;
  rate?: number; // [Hz]
  resample?: number; // [Hz]
  velocity_window?: number; // [s]
  origin?: number[]; // [m]
  point?: number[]; // [m]
  sensor_rotation?: number[]; // [deg]
  strict?: boolean;
}

export interface Mapping {
  map: string; // as --map has it
  options: MappingOptions;
}

export interface PreviewColumn {
  number: number; // from 1
  heading: string;
  name: string; // the heading without its unit
  unit: string; // as the file says it
  unknown_unit: string; // what it says in place of one that is known: "counts", "dyn"
  stamps: boolean; // moments, not numbers
}

export type LineKind = "remark" | "names" | "units" | "data" | "no_data" | "misplaced" | "empty";

export interface PreviewLine {
  number: number;
  kind: LineKind;
  fields: string[];
}

export interface MappedColumn {
  channel: string; // "force_measured", "position", "orientation.1", ...
  column: number; // from 1
  unit: string;
  unit_from_file: boolean;
  si: string;
}

/** What would come of a file by a mapping, by its first million bytes. */
export interface Preview {
  columns: PreviewColumn[];
  lines: PreviewLine[];
  irregular: PreviewLine[]; // further lines that an import leaves out
  layout: {
    separator: string;
    decimal: string;
    header_line: number;
    units_line: number;
    preamble_lines: number;
  };
  suggested: { map: string; has_time: boolean };
  mapped: MappedColumn[];
  units: Record<string, string[]>; // to choose from, by channel; "own" of a channel of one's own
  problem: string; // why nothing would come of it; empty if something would
  warnings: string[];
  notes: string[];
  rows: number;
  seconds: number | null;
  is_whole: boolean;
}

/** What `kerf import --json` says, as far as the page shows it. */
export interface ImportedAbout {
  samples: number;
  duration_s: number;
  rate_hz: number;
  warnings: string[];
  bad_lines: number;
  bad_line_numbers: number[];
  misplaced_lines: number;
  misplaced_line_numbers: number[];
}

export type ImportResult =
  | { state: "waiting" }
  | { state: "failed"; error: string }
  | { state: "done"; error: string; recording: string; name: string; about: ImportedAbout; gone?: boolean };

export interface WaitingUpload {
  upload: string;
  name: string;
  bytes: number;
  have: number;
  result: ImportResult;
}

export interface IntakeOverview {
  uploads: WaitingUpload[];
  mappings: { id: string; name: string }[];
  largest: number; // bytes of a file
  piece: number; // bytes of a request
}
