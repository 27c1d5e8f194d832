// Work that takes a while, and verbs of the program as forms.

export interface Job {
  job: number;
  kind: "fit" | "chart" | "choice" | "stability" | "verb" | "unknown";
  title: string;
  state: "waiting" | "running" | "done" | "failed" | "stopped" | "interrupted"; // the last: the studio ended meanwhile
  share: number; // 0 to 1; -1 where it is not known
  error: string;
  file: string; // id of the result in the workspace; empty if there is none with a page of its own
  outcome: string; // what it found, in a word: "did not pass"
  outputs: string[]; // names in the workspace
  created: string; // ISO 8601
  seconds: number; // that it has run
  clock_set_s: number; // by how much the machine's clock was set meanwhile
  again: { path: string; body: unknown }; // what asks for it again; an empty path: nothing does
  stopping: boolean;
  not_kept: string; // why it will not outlive the studio; else empty
}

export type ValueKind = "flag" | "number" | "choice" | "text" | "laws" | "device" | "file" | "folder" | "output";

/** What a form asks for. */
export interface VerbValue {
  name: string; // "--filter", "RECORDING"
  label: string;
  kind: ValueKind;
  words: string[]; // choices; endings of a file's name
  standard: string;
  required: boolean;
  repeated: boolean;
}

/** A verb of the program, as its own --help describes it. */
export interface VerbForm {
  verb: string; // "session simulate"
  title: string;
  group: string;
  description: string;
  more: string;
  fixed: string[];
  values: VerbValue[];
}

/** What a job has made. */
export interface MadeFile {
  name: string;
  what: "picture" | "page" | "table" | "text" | "other";
  bytes: number;
  id: string; // in the workspace; empty: not one of its kinds
  kind: string;
}

export interface OfferedNames {
  files: string[];
  folders: string[];
}

/** A file that was deleted and can be had back. */
export interface Trashed {
  key: string;
  name: string;
  time: string; // ISO 8601
  bytes: number;
}
