import type { Api } from "../api/api";
import type { Recording, RecordingInspection } from "../api/recordings";
import type { Workspace } from "../api/workspace";
import type { Address } from "../shell/address";
import type { Command } from "../shell/keys/commands";
import type { Step } from "../shell/router";

/** Where a page is: "#/fits/1f3a" is { view: "fits", id: "1f3a" }. */
export type Place = Address;

/**
 * What of a page stands in its address, so that a link, reload, back and forward bring it back: short texts and
 * numbers by key. The tabs of a recording share one state: what one tab selects the others show; recording/keys.ts
 * lists them.
 */
export interface State {
  get: (key: string) => string | null;
  /** A number, or null where there is none. */
  number: (key: string) => number | null;
  /** null takes a key out. "push" for a step that "back" undoes (a choice), "replace" (the default) for a drag. */
  set: (values: Readonly<Record<string, string | number | null>>, step?: Step) => void;
  /** Calls when back, forward or a link has changed it, never for what `set` did; ends with the page or tab. */
  onChange: (listener: () => void) => void;
}

/** What a page or a tab is given. */
export interface Context {
  readonly api: Api;
  readonly place: Place;
  readonly state: State;
  /** Aborted when the page or tab goes: give it to whatever may answer late. */
  readonly signal: AbortSignal;
  /** To another place; "replace" where nobody should come back to this one. */
  go: (view: string, id?: string, tab?: string, state?: Readonly<Record<string, string>>, step?: Step) => void;
  /** One line for the person at the page; an empty one takes it away. */
  say: (text: string) => void;
  /** What did not work, in a line that stays until the next. */
  complain: (error: unknown) => void;
  /** Puts the focus on the page's h1, where it has changed. */
  focusHead: () => void;
  /** What is in the folder: told now, if it is known, and whenever it has changed; ends with the page or tab. */
  onFolder: (listener: (workspace: Workspace) => void) => void;
  /** What is in the folder now; aborted with the page or tab. */
  folder: () => Promise<Workspace>;
  /** Somebody has written a file: the list need not wait until it looks again. */
  lookAtFolder: () => void;
  /** Offers commands in the palette and by their keys, until the page or tab goes or what it gives back is called. */
  offer: (...commands: Command[]) => () => void;
}

/** What a page is given beside. */
export interface PageContext extends Context {
  /** Calls when the address has another tab of the same page; `place` says which. */
  onTab: (listener: () => void) => void;
}

/** A page of the studio. mount() fills the root and gives back what ends it: timers, streams, listeners. */
export interface View {
  readonly name: string;
  readonly title: string;
  mount: (root: HTMLElement, context: PageContext) => () => void;
}

/** The recording that a page of tabs is about. */
export interface OpenRecording {
  readonly id: string;
  readonly name: string; // path within the workspace
  readonly about: Recording;
  readonly workspace: Workspace; // as it was when the recording was read
  /** What it is worth; asked for once, and shared by the tabs. */
  inspection: () => Promise<RecordingInspection>;
  /**
   * Before the page itself writes the file, and what is called when that has ended: what is here is then of the new file
   * without a tab beginning again, and nobody is told that it has changed. `read` is called once it is.
   */
  writing: () => (written: boolean, read?: () => void) => void;
  /** Reads it anew, after it has been changed: all tabs begin again, with the same state. */
  reload: () => void;
}

/** A way to see a recording: a line in recording/registry.ts. */
export interface RecordingTab {
  readonly name: string; // in the address
  readonly title: string;
  mount: (root: HTMLElement, context: Context, recording: OpenRecording) => () => void;
}
