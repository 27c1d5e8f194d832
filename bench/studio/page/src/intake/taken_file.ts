import type { ImportResult } from "../api/intake";

export type FileState = "sending" | "stopped" | "ready" | "refused" | "importing" | "done" | "failed";

/** A file that is taken in, from its drop to its recording. */
export interface TakenFile {
  readonly key: number;
  readonly name: string;
  readonly bytes: number;
  file: File | null; // null: the page was loaded anew since, and the rest of it has to be dropped again
  upload: string; // its id; empty until it has begun
  have: number;
  state: FileState;
  said: string; // what there is to say of it, in one line
  recording: string; // the name that its recording is to have
  result: (ImportResult & { state: "done" }) | null;
  sending: AbortController;
}

let made = 0;

export function takenFile(name: string, bytes: number, file: File | null): TakenFile {
  return {
    key: ++made,
    name,
    bytes,
    file,
    upload: "",
    have: 0,
    state: "sending",
    said: "",
    recording: "",
    result: null,
    sending: new AbortController(),
  };
}

/** "3.2 MB" */
export function size(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  const steps = ["kB", "MB", "GB", "TB"] as const;
  const power = Math.min(steps.length, Math.floor(Math.log10(bytes) / 3));
  const value = bytes / 1000 ** power;
  return `${value.toLocaleString("en-GB", { maximumSignificantDigits: 3, useGrouping: false })} ${steps[power - 1]}`;
}
