import type { FindSettings } from "../api/cycles";
import type { Axis } from "../api/recordings";
import { element, labelled, select } from "../ui/dom";

/** How cycles are found; each change is tried at once. */
export class CycleSettings {
  readonly root: HTMLDetailsElement;
  private readonly told = element("span", { class: "quiet" });
  private readonly slider: HTMLInputElement;
  private readonly fields: Record<"prominence" | "corner_hz" | "dwell", HTMLInputElement>;
  private readonly closing: HTMLSelectElement;
  private readonly axis: HTMLSelectElement;

  constructor(
    axes: readonly Axis[],
    private readonly changed: (settings: FindSettings, axis: number) => void,
  ) {
    const number = (least: number, most: number, step: number, change: () => void): HTMLInputElement =>
      element("input", { type: "number", min: least, max: most, step, input: change });
    const tell = (): void => this.tell();
    this.fields = {
      prominence: number(1, 99, 1, () => {
        this.slider.value = this.fields.prominence.value;
        tell();
      }),
      corner_hz: number(0.1, 1000, 0.1, tell),
      dwell: number(0.1, 49, 0.1, tell),
    };
    this.slider = element("input", {
      type: "range",
      min: 1,
      max: 99,
      "aria-label": "Share of the range that a stroke covers, in percent",
      input: () => {
        this.fields.prominence.value = this.slider.value;
        tell();
      },
    });
    this.closing = select(
      [
        { value: "", text: "the one that costs more work" },
        { value: "increasing", text: "increasing" },
        { value: "decreasing", text: "decreasing" },
      ],
      "",
      tell,
    );
    this.axis = select(
      axes.map((it, k) => ({ value: String(k), text: it.name })),
      "0",
      tell,
    );
    this.root = element(
      "details",
      { class: "cycle_settings" },
      element("summary", {}, "How cycles are found", this.told),
      element(
        "div",
        { class: "stroke" },
        labelled("A stroke covers [% of the range]", this.fields.prominence),
        this.slider,
      ),
      labelled("Low-pass [Hz]", this.fields.corner_hz),
      labelled("Turning round [% of a stroke]", this.fields.dwell),
      labelled("Closing is", this.closing),
      axes.length > 1 ? labelled("Axis", this.axis) : null,
    );
  }

  /** What is there, unless somebody is typing. */
  show(settings: FindSettings, axis: number, locked: boolean): void {
    for (const node of this.root.querySelectorAll<HTMLInputElement | HTMLSelectElement>("input, select"))
      node.disabled = locked;
    if (this.root.contains(document.activeElement)) return;
    const percent = (share: number): string => String(Number((100 * share).toFixed(1)));
    this.fields.prominence.value = this.slider.value = percent(settings.prominence);
    this.fields.corner_hz.value = String(settings.corner_hz);
    this.fields.dwell.value = percent(settings.dwell);
    this.closing.value = settings.closing;
    this.axis.value = String(axis);
    this.told.textContent = `: ${this.fields.prominence.value} %, ${settings.corner_hz} Hz`;
  }

  /** For cycles that are not as somebody wants them yet. */
  unfold(): void {
    this.root.open = true;
  }

  private tell(): void {
    const [prominence, corner_hz, dwell] = [this.fields.prominence, this.fields.corner_hz, this.fields.dwell];
    if (![prominence, corner_hz, dwell].every((it) => it.value !== "" && it.validity.valid)) return; // it is being typed
    this.changed(
      {
        prominence: Number(prominence.value) / 100,
        corner_hz: Number(corner_hz.value),
        dwell: Number(dwell.value) / 100,
        closing: this.closing.value as FindSettings["closing"],
      },
      Number(this.axis.value),
    );
  }
}
