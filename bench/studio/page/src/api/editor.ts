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
