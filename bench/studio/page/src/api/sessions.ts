// Sessions.

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
  has_key_file: boolean; // the studio was started with --key-file
  quality: SessionQuality | null; // of the session that runs or ran last
  notes: SessionNote[];
}

/** What the experimenter wrote: public, with its time. */
export interface SessionNote {
  time: string; // ISO 8601, UTC
  text: string;
}

/** How trials went: sums over all of them, of no sample, slot, level or answer. */
export interface SessionQuality {
  given: number; // practice and void ones included
  practice: number;
  counted: number;
  void: number;
  left_out: number;
  reasons: Record<string, number>; // of void trials
  unknown: number; // without a trace
  unfelt: number;
  faulty: number;
  late_ticks: number;
  limited_ticks: number;
  contact_share: number | null; // of the time in which a slot played; null: not told yet
  catch: { right: number; trials: number } | null; // of a finished session
  median_response_s: number | null;
  slowest_response_s: number | null;
}

/** What a session's file says with its key, and still tells nothing of the samples. */
export interface SessionLook {
  subject: string;
  finished: boolean;
  planned: number;
  quality: SessionQuality;
  notes: SessionNote[];
}
