/** Something that can be done now, by the palette or by a key. */
export interface Command {
  readonly title: string; // "Fit laws to this recording"
  readonly group?: string; // "Recording"; what the palette and the help put it under
  /** As people write it: "f", "Ctrl+K", "Shift+ArrowLeft", "g r" (one after the other). */
  readonly keys?: string;
  readonly run: () => void;
}

/** The commands of the shell, of the page and of the tab that are there. */
export class Commands {
  private readonly offered = new Set<readonly Command[]>();

  get all(): Command[] {
    return [...this.offered].flat();
  }

  /** Gives back what takes them away again. */
  offer(commands: readonly Command[]): () => void {
    this.offered.add(commands);
    return () => this.offered.delete(commands);
  }
}
