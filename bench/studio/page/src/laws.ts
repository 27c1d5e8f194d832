import type { Axis } from "./api/recordings";
import type { Workspace, WorkspaceLaw } from "./api/workspace";

/** The laws that a person picks from: without those of a chart's points, of which there are dozens. */
export function lawsToPick(workspace: Workspace): WorkspaceLaw[] {
  return workspace.laws.filter((it) => it.error === "" && !/(^|\/)points\//.test(it.name));
}

/** A law as people call it: its file's name without the ending. */
export function shortName(law: string): string {
  return law.replace(/\.law\.toml$/, "");
}

/** What of a law a device with these axes has not, as the server judges it too: "x in m, N"; empty if it suits. */
export function lackingFor(law: WorkspaceLaw, axes: readonly Axis[]): string {
  const isThere = (wanted: Axis): boolean =>
    axes.some(
      (it) =>
        it.name === wanted.name && it.position_unit === wanted.position_unit && it.force_unit === wanted.force_unit,
    );
  return law.axes
    .filter((it) => !isThere(it))
    .map((it) => `${it.name} in ${it.position_unit}, ${it.force_unit}`)
    .join("; ");
}
