import type { Api } from "../api/api";
import type { Recording } from "../api/recordings";
import type { Workspace } from "../api/workspace";
import { button, element, labelled, select } from "../ui/dom";
import { swatch } from "../ui/time/time_plot";
import { atMostDrawn, type Drawn } from "./recording_time";

/** Further recordings laid over the page's own, aligned at their start or at their first closing. */
export class RecordingOverlay {
  readonly root: HTMLElement;
  private readonly over: { recording: Recording; name: string }[] = [];
  private readonly list = element("ul", { class: "overlay_list" });
  private readonly add: HTMLSelectElement;
  private readonly alignment: HTMLSelectElement;

  constructor(
    private readonly api: Api,
    private readonly own: Recording,
    private readonly ownName: string,
    workspace: Workspace,
    private readonly changed: () => void,
    private readonly complain: (error: unknown) => void,
  ) {
    const others = workspace.recordings.filter((it) => it.id !== own.id);
    this.add = select(
      [{ value: "", text: "choose a recording" }, ...others.map((it) => ({ value: it.id, text: it.name }))],
      "",
      (id) => void this.choose(id, others.find((it) => it.id === id)?.name ?? id),
    );
    this.alignment = select(
      [
        { value: "start", text: "their start" },
        { value: "cycle", text: "their first closing" },
      ],
      "start",
      () => this.changed(),
    );
    this.root = element(
      "fieldset",
      { class: "overlay" },
      element("legend", {}, "Laid over it"),
      this.list,
      labelled("Add", this.add),
      labelled("Align at", this.alignment),
    );
    this.show();
  }

  get drawn(): Drawn[] {
    const origin = this.origin(this.own);
    return [
      { recording: this.own, name: this.ownName, shift_s: 0 },
      ...this.over.map((it) => ({ ...it, shift_s: origin - this.origin(it.recording) })),
    ];
  }

  private origin(recording: Recording): number {
    const closing = recording.cycles?.spans.find((it) => it.phase === "closing");
    return this.alignment.value === "cycle" && closing ? closing.from_s : recording.from_s;
  }

  private async choose(id: string, name: string): Promise<void> {
    this.add.value = "";
    if (id === "" || this.over.some((it) => it.recording.id === id)) return;
    try {
      const recording = await this.api.get<Recording>("/api/recording", { id });
      this.over.push({ recording, name });
      this.show();
      this.changed();
    } catch (error) {
      this.complain(error);
    }
  }

  private show(): void {
    const drop = (k: number): void => {
      this.over.splice(k, 1);
      this.show();
      this.changed();
    };
    this.list.replaceChildren(
      ...this.over.map((it, k) =>
        element(
          "li",
          {},
          swatch(k + 1),
          element("span", { class: "overlay_name", title: it.name }, it.name),
          button("×", () => drop(k), { class: "small", "aria-label": `Take ${it.name} away` }),
        ),
      ),
    );
    this.add.disabled = this.over.length + 1 >= atMostDrawn;
    this.alignment.disabled = this.over.length === 0;
  }
}
