import type { Axis } from "../../api/recordings";
import { labelled, select } from "../../ui/dom";
import type { OpenRecording } from "../../ui/view";

/** The axis that laws are fitted along: that of the cycles, until another is picked. */
export class AxisChoice {
  /** None where there is nothing to choose. */
  readonly root: HTMLElement | null;
  axis: Axis | undefined;

  constructor({ about }: OpenRecording, changed: (axis: Axis | undefined) => void) {
    this.axis = about.axes[about.cycles?.axis ?? 0];
    const which = select(
      about.axes.map((it) => ({ value: it.name, text: it.name })),
      this.axis?.name ?? "",
      (name) => changed((this.axis = about.axes.find((it) => it.name === name))),
    );
    this.root = about.axes.length > 1 ? labelled("Axis", which) : null;
    changed(this.axis);
  }

  get name(): string {
    return this.axis?.name ?? "";
  }
}
