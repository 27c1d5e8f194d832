import type { ChartPoint } from "../api/results";
import type { Workspace, WorkspaceFile, WorkspaceLaw, WorkspaceRecording } from "../api/workspace";

/** "day/cut.fit" of "day/cut.fit/fit.json". */
export function folderOf(name: string): string {
  const end = name.lastIndexOf("/");
  return end < 0 ? "" : name.slice(0, end);
}

/** What a result is called on a page: its folder, or its file where it stands in the workspace itself. */
export function resultName(file: WorkspaceFile): string {
  return folderOf(file.name) || file.name;
}

/** The law file of that name in the folder of a result. */
export function lawBeside(workspace: Workspace, result: WorkspaceFile, name: string): WorkspaceLaw | undefined {
  const folder = folderOf(result.name);
  const path = folder ? `${folder}/${name}` : name;
  return workspace.laws.find((it) => it.name === path);
}

/**
 * The recordings that a result of that name may be of, likeliest first: results know their recording's stem and its UUID,
 * which copies share.
 */
export function recordingsFor(workspace: Workspace, stem: string, uuid?: string): WorkspaceRecording[] {
  const whole = workspace.recordings.filter((it) => !it.partial);
  const rank = (it: WorkspaceRecording): number => {
    const isNamed = it.name === `${stem}.h5` || it.name.endsWith(`/${stem}.h5`);
    if (uuid && it.uuid === uuid) return isNamed ? 0 : 1;
    return isNamed ? 2 : 3;
  };
  return whole.sort((one, other) => rank(one) - rank(other)); // which keeps the order of equals
}

/** Times of a file's name as the server gave them, newest last: "cut", "cut-2", "cut-10". */
export function byName(one: { name: string }, other: { name: string }): number {
  return one.name.localeCompare(other.name, "en", { numeric: true });
}

/** What nobody judged is not stable, and not unstable either. */
export function stableWord(stable: boolean | null): string {
  if (stable === null) return "not judged";
  return stable ? "yes" : "no";
}

/** "no: its force is not finite". */
export function stabilityInWords(point: ChartPoint): string {
  const why = point.stable === null ? point.why_not_judged : point.why_not_stable;
  return why ? `${stableWord(point.stable)}: ${why}` : stableWord(point.stable);
}
