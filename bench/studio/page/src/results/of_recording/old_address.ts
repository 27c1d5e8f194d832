import type { Workspace, WorkspaceFile } from "../../api/workspace";
import { stateKeys } from "../../recording/keys";
import type { Context } from "../../ui/view";
import { recordingOf } from "./files";

/** Leads `#/fits/ID` and `#/chart/ID`, of a recording or of a result, to the tab of the recording; false: there is none. */
export function leadToTab(
  context: Context,
  workspace: Workspace,
  tab: "fits" | "chart",
  files: readonly WorkspaceFile[],
): boolean {
  const { id } = context.place;
  const file = files.find((it) => it.id === id);
  const recording = file ? recordingOf(workspace, file) : workspace.recordings.find((it) => it.id === id);
  if (!recording) return false;
  context.go(
    "recording",
    recording.id,
    tab,
    file ? { [tab === "fits" ? stateKeys.fit : stateKeys.chart]: id } : {},
    "replace",
  );
  return true;
}
