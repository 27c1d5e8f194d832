// Protocols of experiments, NAME.protocol.toml.

export interface ProtocolText {
  name: string; // path within the workspace
  text: string;
}

/** What a protocol comes to, or why it is none. */
export type ProtocolCheck = { problem: string } & Partial<{
  design: string;
  samples: { name: string; law: string }[];
  trials: number; // of a subject, practice and catch trials included
  practice: number;
  adaptive: boolean;
  device: string; // empty: whoever runs it says which
  question: string;
  has_motion: boolean; // what it can be rehearsed along
}>;
