import type { Api } from "../../api/api";
import type { Workspace } from "../../api/workspace";

const every_ms = 4000;

/** What is in the folder, looked at again as long as the page is seen. */
export class WorkspaceStore {
  current: Workspace | null = null;
  private state = ""; // of the folder, as the server names it
  private looking: Promise<Workspace> | null = null;
  private next: Promise<Workspace> | null = null; // which begins when that has ended
  private readonly listeners = new Set<(workspace: Workspace) => void>();

  constructor(private readonly api: Api) {
    setInterval(() => {
      if (!document.hidden) this.look();
    }, every_ms);
    addEventListener("focus", () => this.look());
    this.look();
  }

  /** Told now, if it is known, and whenever it has changed. */
  onChange(listener: (workspace: Workspace) => void): () => void {
    this.listeners.add(listener);
    if (this.current) listener(this.current);
    return () => this.listeners.delete(listener);
  }

  /** Looks again; that the studio does not answer is for the bar to say. */
  look(): void {
    this.now().catch(() => {});
  }

  /** What is there now, not before this is called; the server says in a few bytes that nothing has changed. */
  async now(signal?: AbortSignal): Promise<Workspace> {
    this.next ??= (this.looking ?? Promise.resolve())
      .catch(() => {})
      .then(() => {
        this.looking = this.ask().finally(() => (this.looking = null));
        this.next = null;
        return this.looking;
      });
    const found = await this.next;
    signal?.throwIfAborted();
    return found;
  }

  private async ask(): Promise<Workspace> {
    const found = await this.api.get<Workspace | { unchanged: true }>("/api/workspace", { unless: this.state });
    if (!this.current || !("unchanged" in found)) {
      this.current = found as Workspace;
      this.state = this.current.state;
      for (const it of [...this.listeners]) it(this.current);
    }
    return this.current;
  }
}
