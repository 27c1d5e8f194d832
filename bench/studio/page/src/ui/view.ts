import type { Api } from "../api/api";

/** Where a page is: "#/editor/1f3a" is { view: "editor", id: "1f3a" }. */
export interface Place {
  readonly view: string;
  readonly id: string;
}

/** What a page is given. */
export interface Context {
  readonly api: Api;
  readonly place: Place;
  go: (view: string, id?: string) => void;
  /** One line for the person at the page; an empty one takes it away. */
  say: (text: string) => void;
  /** What did not work, in a line that stays until the next. */
  complain: (error: unknown) => void;
  /** Puts the focus on the page's h1, where it has changed. */
  focusHead: () => void;
}

/** A page of the studio. mount() fills the root and gives back what ends it: timers, streams, listeners. */
export interface View {
  readonly name: string;
  readonly title: string;
  mount: (root: HTMLElement, context: Context) => () => void;
}
