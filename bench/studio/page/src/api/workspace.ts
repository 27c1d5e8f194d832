import type { Axis } from "./recordings";

// What is in the folder.

export interface WorkspaceRecording {
  id: string;
  name: string; // path within the workspace
  bytes: number;
  modified: string; // ISO 8601
  partial: boolean; // not closed
  written?: boolean; // not closed, since somebody is writing it; else who wrote it died
  seconds?: number; // where the server knows it without opening the file
  uuid?: string; // of the same
  damaged?: boolean; // HDF5 can make nothing of it
}

export interface WorkspaceLaw {
  id: string;
  name: string;
  model: string;
  axis: string;
  position_unit: string;
  force_unit: string;
  breakpoints: boolean; // knots that the segment editor moves
  axes: Axis[]; // that it acts on
  error: string; // why it cannot be read; empty if it can
}

export interface WorkspaceSession {
  id: string;
  name: string;
  subject: string; // a code
  key: string; // "key file" or "passphrase"
  finished: boolean;
  answered: number;
  running: boolean; // by whichever process
  apparatus: ApparatusItem[]; // what is to be confirmed before a run
  error: string;
}

/** What an experimenter confirms of the set-up: "headphones", "closed, over both ears". */
export interface ApparatusItem {
  name: string;
  what: string;
}

export interface WorkspaceFile {
  id: string;
  name: string;
  kind: "fit" | "chart" | "choice" | "stability" | "suite" | "scene" | "protocol" | "study" | "device" | "sweep";
  modified: string; // ISO 8601
  of?: string[]; // of a result: the UUIDs of its recordings, where it says them
}

export interface Workspace {
  folder: string;
  version: string;
  device: string;
  state: string; // what is in the folder as a number of its own: asked with `unless`, nothing is told anew
  unlooked: number; // recordings that have not been looked into yet, of which only name, size and time are known
  recordings: WorkspaceRecording[];
  laws: WorkspaceLaw[];
  sessions: WorkspaceSession[];
  files: WorkspaceFile[];
}

/** A recording in small: the extremes of one signal, 0 to 100 of its range, -1 where nothing is known. */
export interface Thumbnail {
  signal: string;
  low: number[];
  high: number[];
  cycles: number; // -1: it is not segmented
  flagged: number; // cycles that the file says are not good
  status: string;
}
