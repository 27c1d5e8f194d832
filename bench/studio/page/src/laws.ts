import type { Workspace, WorkspaceLaw } from "./api";

/** The laws that a person picks from: without those of a chart's points, of which there are dozens. */
export function lawsToPick(workspace: Workspace): WorkspaceLaw[] {
  return workspace.laws.filter((it) => it.error === "" && !/(^|\/)points\//.test(it.name));
}
