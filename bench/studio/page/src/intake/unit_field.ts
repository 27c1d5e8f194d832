import type { PreviewColumn } from "../api/intake";
import { element, setOptions } from "../ui/dom";

const another = "another";

/** The unit of a column: one of those that its channel may have, the file's, or any other that is typed. */
export class UnitField {
  readonly root: HTMLElement;
  private readonly list: HTMLSelectElement;
  private readonly text: HTMLInputElement;

  constructor(
    private readonly column: PreviewColumn,
    changed: (unit: string) => void,
  ) {
    const label = `Unit of column ${column.number}, ${column.name || `column ${column.number}`}`;
    this.list = element("select", {
      class: "unit",
      "aria-label": label,
      change: () => {
        const types = this.list.value === another;
        this.text.hidden = !types;
        if (types)
          this.text.select(); // what is typed takes its place
        else changed(this.list.value);
      },
    });
    this.text = element("input", {
      class: "unit",
      "aria-label": `${label}, as text`,
      placeholder: "0.01 N",
      maxlength: 40,
      spellcheck: "false",
      hidden: true,
      input: () => changed(this.text.value.trim()),
    });
    this.root = element("span", { class: "unit_field" }, this.list, this.text);
  }

  /** The unit that is chosen (empty: the file's), and those to choose from; what somebody types stays theirs. */
  show(unit: string, units: readonly string[], { disabled = false, needsFrame = false } = {}): void {
    this.list.disabled = this.text.disabled = disabled;
    if (document.activeElement === this.text) return;
    const own = needsFrame && this.column.unit ? ["", "sensor", "world"] : [""];
    const offered = [...own, ...units];
    const isToBeTyped = unit.includes("?"); // how many counts are one, which nobody here can know
    const values = [...offered, ...(offered.includes(unit) || isToBeTyped ? [] : [unit]), another];
    const asInFile = `${this.column.unit}, as the file says`;
    const words: Record<string, string> = {
      "": needsFrame ? "– unit and frame –" : this.column.unit ? asInFile : "– unit –",
      sensor: `${asInFile}, sensor`,
      world: `${asInFile}, world`,
      [another]: "another …",
    };
    setOptions(
      this.list,
      values.map((it) => ({ value: it, text: words[it] ?? it })),
      isToBeTyped ? another : unit,
    );
    this.text.hidden = !isToBeTyped;
    this.text.value = unit;
  }
}
