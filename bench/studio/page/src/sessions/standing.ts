import type { WorkspaceSession } from "../api/workspace";
import { counted } from "../ui/numbers";

/** How far a session is, in a few words. */
export function whereItStands(session: WorkspaceSession): string {
  if (session.error) return session.error;
  if (session.finished) return "finished";
  const done = session.answered > 0 ? `${counted(session.answered, "trial")} done` : "";
  if (session.running) return ["running", done].filter(Boolean).join(", ");
  return done || "not begun";
}
