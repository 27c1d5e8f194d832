import type { WorkspaceRecording } from "../api/workspace";

/** Whoever recorded it died, or was killed, before it was closed. */
export function isLeftOpen(it: WorkspaceRecording): boolean {
  return it.partial && it.written !== true;
}

/** The form that closes it. */
export function repairAddress(it: WorkspaceRecording): string {
  return `#/work/repair?recording=${encodeURIComponent(it.name)}`;
}

/** What its file has for a status, in words: one that was never closed still says that it is being recorded. */
export function statusInWords(status: string, entry: WorkspaceRecording | undefined): string {
  if (status === "complete") return "";
  if (!entry?.partial) return status;
  return isLeftOpen(entry) ? "ended without being closed" : "being recorded";
}
