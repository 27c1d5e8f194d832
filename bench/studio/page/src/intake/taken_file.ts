import type { ImportResult, Mapping } from "../api/intake";

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
  mapping: Mapping | null; // as a person has made or confirmed it; null: nobody has
  problem: string; // why nothing would come of it as it is mapped; empty: it would, or nobody has looked yet
  columns: string; // what they are called, as one text; empty: not looked at yet
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
    mapping: null,
    problem: "",
    columns: "",
    result: null,
    sending: new AbortController(),
  };
}
