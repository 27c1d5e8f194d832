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
}
