// Sweeps that kerf sweep merge put together; null: not known.

export interface SweepColumn {
  name: string;
  unit: string;
  what: string;
  input: boolean;
  texts: string[]; // of an input whose values are listed: all of them
  values: (number | null)[]; // where they are numbers
}
export interface SweepTable {
  name: string;
  computed: number; // cells
  failed: number;
  missing: number;
  columns: SweepColumn[];
}
export interface Sweep {
  verb: string;
  what: string;
  software: string;
  cells: number;
  tables: SweepTable[];
}
export interface Counts {
  computed: number;
  known: number; // of these
  failed: number;
  missing: number;
}
export interface SweepAxis {
  column: string;
  unit: string;
  names: string[]; // of the values; empty: stretches
  values: (number | null)[];
  edges: (number | null)[];
  logarithmic: boolean;
}
/** What is known of every part; the first axis changes fastest. */
export interface SweepAnswer {
  unit: string;
  all: Counts;
  axes: SweepAxis[];
  value: (number | null)[];
  computed: number[];
  known: number[];
  failed: number[];
  missing: number[];
}
/** Cells taken by chance; of a listed column the places of their values in its list. */
export interface SweepSample {
  of: number;
  state: ("" | "failed" | "missing")[];
  columns: string[];
  values: (number | null)[][];
}
/** Texts, or a range whose ends may be open. */
export type SweepFilter = string[] | [number | null, number | null];
export interface SweepQuestion {
  table: string;
  by: string[];
  of?: string;
  statistic?: string;
  share?: string;
  where: Record<string, SweepFilter>;
}
