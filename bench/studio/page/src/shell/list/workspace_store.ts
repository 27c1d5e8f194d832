import type { Api } from "../../api/api";
import type { Workspace } from "../../api/workspace";

const every_ms = 4000;

/** What is in the folder, looked at again as long as the page is seen. */
export class WorkspaceStore {
  current: Workspace | null = null;
  private state = ""; // of the folder, as the server names it
  private asking = false;
  private readonly listeners = new Set<(workspace: Workspace) => void>();

  constructor(private readonly api: Api) {
    setInterval(() => {
      if (!document.hidden) void this.look();
    }, every_ms);
    addEventListener("focus", () => void this.look());
    void this.look();
  }

  /** Told now, if it is known, and whenever it has changed. */
  onChange(listener: (workspace: Workspace) => void): () => void {
    this.listeners.add(listener);
    if (this.current) listener(this.current);
    return () => this.listeners.delete(listener);
  }

  /** Looks again: the server says in a few bytes that nothing has changed. */
  async look(): Promise<void> {
    if (this.asking) return;
    this.asking = true;
    try {
      const found = await this.api.get<Workspace | { unchanged: true }>("/api/workspace", { unless: this.state });
      if ("unchanged" in found) return;
      this.current = found;
      this.state = found.state;
      for (const it of [...this.listeners]) it(found);
    } catch {
      // the bar says that the studio does not answer
    } finally {
      this.asking = false;
    }
  }
}
