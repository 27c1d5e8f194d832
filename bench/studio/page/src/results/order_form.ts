import type { Axis, Recording } from "../api/recordings";
import type { Workspace, WorkspaceRecording } from "../api/workspace";
import { element, labelled, select } from "../ui/dom";
import type { Context } from "../ui/view";

/** What an order of a recording's results needs first: the recording and its axis. */
export class RecordingChoice {
  readonly root = element("div", { class: "row" });
  recording: WorkspaceRecording | undefined;
  axis = "";
  axes: Axis[] = [];

  constructor(
    private readonly context: Context,
    private readonly recordings: readonly WorkspaceRecording[],
    chosen: string,
    private readonly changed: (axis: Axis | undefined) => void,
  ) {
    this.recording = recordings.find((it) => it.id === chosen) ?? recordings[0];
    void this.take();
  }

  static of(workspace: Workspace): WorkspaceRecording[] {
    return workspace.recordings.filter((it) => !it.partial);
  }

  private async take(): Promise<void> {
    this.axes = [];
    this.axis = "";
    this.fill();
    if (!this.recording) return;
    try {
      const about = await this.context.api.get<Recording>("/api/recording", { id: this.recording.id });
      this.axes = about.axes;
      this.axis = (about.cycles ? about.axes[about.cycles.axis] : about.axes[0])?.name ?? "";
    } catch (error) {
      this.context.complain(error);
    }
    this.fill();
  }

  private fill(): void {
    const files = this.recordings.map((it) => ({ value: it.id, text: it.name }));
    const axes = this.axes.map((it) => ({ value: it.name, text: it.name }));
    this.root.replaceChildren(
      labelled(
        "Recording",
        select(files, this.recording?.id ?? "", (id) => {
          this.recording = this.recordings.find((it) => it.id === id);
          void this.take();
        }),
      ),
      labelled(
        "Axis",
        select(axes.length > 0 ? axes : [{ value: "", text: "the recording's own" }], this.axis, (axis) => {
          this.axis = axis;
          this.changed(this.axes.find((it) => it.name === axis));
        }),
      ),
    );
    this.changed(this.axes.find((it) => it.name === this.axis));
  }
}
