import type { Workspace, WorkspaceFile, WorkspaceRecording } from "../../api/workspace";
import { byName, folderOf, resultName } from "../names";

/** What the studio calls the results of a recording of this name: result_stem() in result_folder.h. */
export function stemOf(name: string): string {
  const file = (name.split("/").pop() ?? "").replace(/\.h5$/, "").slice(0, 60);
  const plain = file.replace(/[^A-Za-z0-9_.]+/g, "-").replace(/^[^A-Za-z0-9]+|[^A-Za-z0-9]+$/g, "");
  return plain || "result";
}

/**
 * The results of a recording among the files, newest last. A result says by UUID what it is of; one that does not goes
 * by its name, and of these the ones of the recording's own folder alone where there are any.
 */
export function resultsOf(
  workspace: Workspace,
  recording: { id: string; name: string },
  kinds: readonly WorkspaceFile["kind"][],
): WorkspaceFile[] {
  const uuid = workspace.recordings.find((it) => it.id === recording.id)?.uuid;
  const stem = stemOf(recording.name);
  const stems = stemsOf(workspace);
  const all = workspace.files.filter((it) => kinds.includes(it.kind));
  const byUuid = all.filter((it) => uuid && it.of?.includes(uuid));
  const byName = all.filter((it) => !(uuid && it.of?.length) && stemOfResult(it, stems) === stem);
  const near = byName.filter((it) => folderOf(resultName(it)) === folderOf(recording.name));
  return [...byUuid, ...(near.length > 0 ? near : byName)].sort(byAge);
}

/** The recording that a result is of: by its UUID, else where the folder has one of its name. */
export function recordingOf(workspace: Workspace, result: WorkspaceFile): WorkspaceRecording | undefined {
  const stem = stemOfResult(result, stemsOf(workspace));
  const closed = workspace.recordings.filter((it) => !it.partial);
  const known = closed.filter((it) => it.uuid && result.of?.includes(it.uuid));
  const all = known.length > 0 ? known : closed.filter((it) => stemOf(it.name) === stem);
  return all.find((it) => folderOf(it.name) === folderOf(resultName(result))) ?? all[0];
}

/** Of all recordings of the folder. */
export function stemsOf(workspace: Workspace): Set<string> {
  return new Set(workspace.recordings.map((it) => stemOf(it.name)));
}

/** "cut" of "cut.fit" and of its second, "cut-2.fit"; "cut-2" where a recording is called that. */
export function stemOfResult(result: WorkspaceFile, stems: ReadonlySet<string>): string {
  const whole = (resultName(result).split("/").pop() ?? "").replace(/\.[a-z]+$/, "");
  return stems.has(whole) ? whole : whole.replace(/-\d+$/, "");
}

/** By their times, and of one time as the server names them: "cut.fit", "cut-2.fit", "cut-10.fit". */
export function byAge(one: WorkspaceFile, other: WorkspaceFile): number {
  const stem = (it: WorkspaceFile): { name: string } => ({ name: resultName(it).replace(/\.[a-z]+$/, "") });
  if (one.modified !== other.modified) return one.modified < other.modified ? -1 : 1;
  return byName(stem(one), stem(other)) || byName(one, other);
}

export function newest<Result>(files: readonly Result[]): Result | undefined {
  return files[files.length - 1];
}
