import type { MappingOptions } from "../api/intake";
import { element, labelled } from "../ui/dom";

type NumberOption = "rate" | "resample" | "velocity_window" | "stretch";

const numbers: readonly (readonly [NumberOption, string])[] = [
  ["rate", "Rate, without a time column [Hz]"],
  ["resample", "Resample to [Hz]"],
  ["velocity_window", "Window of the velocity [s]"],
  ["stretch", "Stretch, where the clock starts anew"],
];
const points = ["origin", "point", "sensor_rotation"] as const;
const pointLabels = {
  origin: "Origin x, y, z [m]",
  point: "Point of the torques x, y, z [m]",
  sensor_rotation: "Rotation of the sensor x, y, z [deg]",
} as const;

/** What an import file says beside its map. */
export class OptionsForm {
  readonly root: HTMLElement;
  private readonly fields = new Map<string, HTMLInputElement>();
  private readonly strict: HTMLInputElement;
  private readonly details: HTMLDetailsElement;

  constructor(changed: () => void) {
    const field = (key: string, attributes: Record<string, string | number>): HTMLInputElement => {
      const node = element("input", { ...attributes, input: changed });
      this.fields.set(key, node);
      return node;
    };
    this.strict = element("input", { type: "checkbox", change: changed });
    const [rate, ...others] = numbers;
    this.details = element(
      "details",
      {},
      element("summary", {}, "More"),
      element(
        "div",
        { class: "row" },
        ...others.map(([key, text]) => labelled(text, field(key, { type: "number", min: 0, step: "any" }))),
        labelled("Sheet of a workbook", field("sheet", { type: "text", maxlength: 200 })),
        ...points.map((key) => labelled(pointLabels[key], field(key, { type: "text", placeholder: "0, 0, 0" }))),
        element("label", { class: "tick" }, this.strict, "Refuse a file with lines that are no data"),
      ),
    );
    this.root = element(
      "div",
      { class: "import_options" },
      labelled(rate![1], field(rate![0], { type: "number", min: 0, step: "any" })),
      this.details,
    );
  }

  get value(): MappingOptions {
    const options: MappingOptions = {};
    for (const [key] of numbers) {
      const value = Number(this.fields.get(key)!.value);
      if (value > 0) options[key] = value;
    }
    const sheet = this.fields.get("sheet")!.value;
    if (sheet) options.sheet = sheet;
    for (const key of points) {
      const text = this.fields.get(key)!.value.trim();
      if (text) options[key] = text.split(/[\s,;]+/).map(Number);
    }
    if (this.strict.checked) options.strict = true;
    return options;
  }

  set value(options: MappingOptions) {
    for (const [key] of numbers) this.fields.get(key)!.value = options[key] === undefined ? "" : String(options[key]);
    for (const key of points) this.fields.get(key)!.value = options[key]?.join(", ") ?? "";
    this.fields.get("sheet")!.value = options.sheet ?? "";
    this.strict.checked = options.strict ?? false;
    if (Object.keys(options).some((key) => key !== "rate")) this.details.open = true;
  }
}
