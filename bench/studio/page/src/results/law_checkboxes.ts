import type { Axis } from "../api/recordings";
import type { FittedLaw } from "../api/results";
import { button, element } from "../ui/dom";

/** Which laws to fit: those whose units fit the axis. */
export class LawCheckboxes {
  readonly root = element("fieldset", { class: "laws" });
  private readonly boxes = new Map<string, HTMLInputElement>();

  constructor(private readonly laws: readonly FittedLaw[]) {}

  show(axis: Axis | undefined): void {
    const fitting = this.laws.filter(
      (it) =>
        !axis ||
        ((!it.position_unit || it.position_unit === axis.position_unit) &&
          (!it.force_unit || it.force_unit === axis.force_unit)),
    );
    this.boxes.clear();
    const all = (checked: boolean) => (): void => this.boxes.forEach((box) => (box.checked = checked));
    this.root.replaceChildren(
      element("legend", {}, "Laws to fit"),
      ...fitting.map((law) => {
        const box = element("input", { type: "checkbox", checked: law.usual });
        this.boxes.set(law.model, box);
        return element("label", { class: "tick", title: law.equation }, box, element("span", {}, law.model));
      }),
      element("div", { class: "row" }, button("All", all(true)), button("None", all(false))),
    );
  }

  chosen(): string[] {
    return [...this.boxes].filter(([, box]) => box.checked).map(([model]) => model);
  }
}
