import type { Recording } from "../api/recordings";
import { whyNotOver } from "../recordings/laid_over";
import { RecordingOverlay } from "../recordings/recording_overlay";
import type { Drawn } from "../recordings/recording_time";
import { Latest } from "../ui/latest";
import { Popover } from "../ui/popover";
import type { Context, OpenRecording } from "../ui/view";
import { stateKeys } from "./keys";

type Alignment = "start" | "cycle";

/** The recordings laid over the page's own, as the address has them. */
export class Overlay {
  readonly popover: Popover;
  private readonly panel: RecordingOverlay;
  private readonly known = new Map<string, Recording>();
  private readonly refused = new Set<string>(); // that cannot be laid over this one, and are not in the address
  private readonly latest: Latest;
  private over: { recording: Recording; name: string }[] = [];
  private ids: readonly string[] = [];

  constructor(
    private readonly context: Context,
    private readonly recording: OpenRecording,
    private readonly changed: () => void,
  ) {
    this.latest = new Latest(context.signal);
    this.panel = new RecordingOverlay(recording, {
      choose: (ids) => this.take(ids),
      align: (at) => {
        context.state.set({ [stateKeys.align]: at === "start" ? null : at }, "push");
        changed();
      },
    });
    this.popover = new Popover("Laid over", this.panel.root, context.signal);
    this.panel.show([], this.alignment);
  }

  /** What the address says; the page's own recording is drawn at once, the others when they are there. */
  async follow(): Promise<void> {
    const ids = (this.context.state.get(stateKeys.over) ?? "")
      .split(",")
      .filter((it) => it && it !== this.recording.id);
    this.ids = ids;
    const found = await this.latest
      .ask(() => Promise.all(ids.map((id) => this.fetch(id))))
      .catch((error: unknown) => {
        this.context.complain(error);
        return undefined;
      });
    if (!found) return;
    this.over = found.filter((it) => it !== null);
    if (ids.some((it) => this.refused.has(it)))
      this.context.state.set({ [stateKeys.over]: ids.filter((it) => !this.refused.has(it)).join(",") || null });
    this.panel.show(this.over, this.alignment);
    this.popover.text = this.over.length > 0 ? `Laid over ${this.over.length}` : "Laid over";
    this.changed();
  }

  get drawn(): Drawn[] {
    const { about, name } = this.recording;
    const origin = this.origin(about);
    return [
      { recording: about, name, shift_s: 0 },
      ...this.over.map((it) => ({ ...it, shift_s: origin - this.origin(it.recording) })),
    ];
  }

  private get alignment(): Alignment {
    return this.context.state.get(stateKeys.align) === "cycle" ? "cycle" : "start";
  }

  private take(ids: readonly string[]): void {
    this.context.state.set({ [stateKeys.over]: ids.join(",") || null }, "push");
    void this.follow();
  }

  /** One that is gone is left out, and said. */
  private async fetch(id: string): Promise<{ recording: Recording; name: string } | null> {
    const name = this.recording.workspace.recordings.find((it) => it.id === id)?.name ?? id;
    try {
      const recording = this.known.get(id) ?? (await this.context.api.get<Recording>("/api/recording", { id }));
      this.known.set(id, recording);
      const why = whyNotOver(this.recording.about, recording);
      if (why) this.context.say(`${name} cannot be laid over it: ${why}.`);
      if (why) this.refused.add(id);
      return why ? null : { recording, name };
    } catch (error) {
      if (this.ids.includes(id)) this.context.complain(error);
      return null;
    }
  }

  private origin(recording: Recording): number {
    const closing = recording.cycles?.spans.find((it) => it.phase === "closing");
    return this.alignment === "cycle" && closing ? closing.from_s : recording.from_s;
  }
}
