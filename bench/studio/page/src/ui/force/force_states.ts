import type { LoopStatus } from "../../api/loop";
import { shortName } from "../../laws";

/** What the bar says of a state, and the one thing that a person may want to do about it: an order to the studio. */
interface Look {
  readonly words: (status: LoopStatus) => string;
  readonly act?: { readonly text: string; readonly order: string };
}

/** The states of the server's live_status.h, a line for each; its colour is in force_bar.css. */
const looks = {
  idle: { words: () => "No loop is running" },
  starting: { words: () => "The device is being opened" },
  free: { words: () => "Running without force" },
  rendered: { words: (it: LoopStatus) => `Force on: ${shortName(it.law)}` },
  zero: {
    words: (it: LoopStatus) => `Zero force is held${it.running || it.session ? "" : ", and no loop is running"}`,
    act: { text: "Let force back", order: "/api/live/resume" },
  },
  held: {
    words: (it: LoopStatus) => `Zero force is held: ${it.force_reason}. See where the tool is`,
    act: { text: "It is there: confirm", order: "/api/live/confirm" },
  },
  lost: {
    words: (it: LoopStatus) => `Ended by a fault: ${it.force_reason}`,
    act: { text: "Dismiss", order: "/api/live/dismiss" },
  },
  session: { words: () => "Session running" },
} satisfies Record<string, Look>;

export type ForceState = keyof typeof looks;
export const forceStates: Readonly<Record<ForceState, Look>> = looks;
