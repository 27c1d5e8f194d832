import { keep, kept } from "../editor/kept";
import type { Draft } from "./cycle_draft";

/** What was changed and not saved, of each recording. */
export interface KeptDraft {
  uuid: string;
  version: string; // of the recording's cycles when it was begun
  base: Draft;
  draft: Draft;
}

const keyOf = (id: string): string => `kerf-cycles-${id}`;

export function keepDraft(id: string, draft: KeptDraft | null): void {
  keep(keyOf(id), draft);
}

export function keptDraft(id: string): KeptDraft | null {
  const found = kept(keyOf(id)) as Partial<KeptDraft> | null;
  return Array.isArray(found?.draft?.phases) && Array.isArray(found.base?.phases) ? (found as KeptDraft) : null;
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
    // a browser that keeps nothing
  }
}
