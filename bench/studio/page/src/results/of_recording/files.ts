import type { Workspace, WorkspaceFile, WorkspaceRecording } from "../../api/workspace";
import { byName, folderOf, resultName } from "../names";

/** What the studio calls the results of a recording of this name: result_stem() in result_folder.h. */
export function stemOf(name: string): string {
  const file = (name.split("/").pop() ?? "").replace(/\.h5$/, "").slice(0, 60);
  const plain = file.replace(/[^A-Za-z0-9_.]+/g, "-").replace(/^[^A-Za-z0-9]+|[^A-Za-z0-9]+$/g, "");
  return plain || "result";
}

/** The results of a recording among the files, newest last; those of its own folder alone where there are any. */
export function resultsOf(
  workspace: Workspace,
  recording: string,
  kinds: readonly WorkspaceFile["kind"][],
): WorkspaceFile[] {
  const stem = stemOf(recording);
  const stems = stemsOf(workspace);
  const is = (it: WorkspaceFile): boolean => kinds.includes(it.kind) && stemOfResult(it, stems) === stem;
  const all = workspace.files.filter(is).sort(byAge);
  const near = all.filter((it) => folderOf(resultName(it)) === folderOf(recording));
  return near.length > 0 ? near : all;
}

/** The recording that a result is of, where the folder has one of its name. */
export function recordingOf(workspace: Workspace, result: WorkspaceFile): WorkspaceRecording | undefined {
  const stem = stemOfResult(result, stemsOf(workspace));
  const all = workspace.recordings.filter((it) => !it.partial && stemOf(it.name) === stem);
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

/** As the server names them: "cut.fit", "cut-2.fit", "cut-10.fit". */
function byAge(one: WorkspaceFile, other: WorkspaceFile): number {
  const stem = (it: WorkspaceFile): { name: string } => ({ name: resultName(it).replace(/\.[a-z]+$/, "") });
  return byName(stem(one), stem(other)) || byName(one, other);
}

export function newest<Result>(files: readonly Result[]): Result | undefined {
  return files[files.length - 1];
}
