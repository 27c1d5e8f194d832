import type { Recording } from "../api/recordings";
import { button, element, labelled, select } from "../ui/dom";
import { swatch } from "../ui/time/time_plot";
import type { OpenRecording } from "../ui/view";
import { atMostDrawn } from "./recording_time";

type Alignment = "start" | "cycle";

interface Choices {
  choose: (ids: readonly string[]) => void;
  align: (at: Alignment) => void;
}

/** Chooses further recordings to be laid over the page's own, aligned at their start or at their first closing. */
export class RecordingOverlay {
  readonly root: HTMLElement;
  private ids: readonly string[] = [];
  private readonly list = element("ul", { class: "overlay_list" });
  private readonly add: HTMLSelectElement;
  private readonly alignment: HTMLSelectElement;

  constructor(
    own: OpenRecording,
    private readonly choices: Choices,
  ) {
    const others = own.workspace.recordings.filter((it) => it.id !== own.id);
    this.add = select(
      [{ value: "", text: "choose a recording" }, ...others.map((it) => ({ value: it.id, text: it.name }))],
      "",
      (id) => this.choose(id),
    );
    this.alignment = select(
      [
        { value: "start", text: "their start" },
        { value: "cycle", text: "their first closing" },
      ],
      "start",
      (at) => choices.align(at as Alignment),
    );
    this.root = element(
      "fieldset",
      { class: "overlay" },
      element("legend", {}, "Laid over it"),
      this.list,
      labelled("Add", this.add),
      labelled("Align at", this.alignment),
    );
  }

  show(over: readonly { recording: Recording; name: string }[], alignment: Alignment): void {
    this.ids = over.map((it) => it.recording.id);
    this.list.replaceChildren(
      ...over.map((it, k) =>
        element(
          "li",
          {},
          swatch(k + 1),
          element("span", { class: "overlay_name", title: it.name }, element("bdi", {}, it.name)),
          button("×", () => this.choices.choose(this.ids.filter((id) => id !== it.recording.id)), {
            class: "small",
            "aria-label": `Take ${it.name} away`,
          }),
        ),
      ),
    );
    this.add.disabled = over.length + 1 >= atMostDrawn;
    this.alignment.value = alignment;
    this.alignment.disabled = over.length === 0;
  }

  private choose(id: string): void {
    this.add.value = "";
    if (id !== "" && !this.ids.includes(id)) this.choices.choose([...this.ids, id]);
  }
}
