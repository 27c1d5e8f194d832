import type { Draft } from "./cycle_draft";

/** What was changed and not saved, of each recording: it outlives tabs, reloads and a studio that is started anew. */
export interface KeptDraft {
  uuid: string;
  version: string; // of the recording's cycles when it was begun
  base: Draft;
  draft: Draft;
}

const keyOf = (id: string): string => `kerf-cycles-${id}`;

export function keepDraft(id: string, kept: KeptDraft | null): void {
  try {
    if (kept) sessionStorage.setItem(keyOf(id), JSON.stringify(kept));
    else sessionStorage.removeItem(keyOf(id));
  } catch {
    // a browser that keeps nothing: the draft lives as long as the tab is open
  }
}

export function keptDraft(id: string): KeptDraft | null {
  try {
    const kept = JSON.parse(sessionStorage.getItem(keyOf(id)) ?? "null") as KeptDraft | null;
    return kept && Array.isArray(kept.draft.phases) && Array.isArray(kept.base.phases) ? kept : null;
  } catch {
    return null;
  }
}

const authorKey = "kerf-author";

export function keptAuthor(): string {
  try {
    return localStorage.getItem(authorKey) ?? "";
  } catch {
    return "";
  }
}

export function keepAuthor(name: string): void {
  try {
    localStorage.setItem(authorKey, name);
  } catch {
    // as above
  }
}
