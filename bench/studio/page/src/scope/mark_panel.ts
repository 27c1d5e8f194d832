import type { LoopStatus } from "../api/loop";
import { element } from "../ui/dom";
import type { Context } from "../ui/view";

/** Marks a moment of the running loop by a few words, which a recording that is under way keeps. */
export class MarkPanel {
  readonly root: HTMLElement;
  private readonly text = element("input", {
    type: "text",
    maxlength: 150,
    autocomplete: "off",
    "aria-label": "Marker",
    placeholder: "marker",
  });
  private readonly press = element("button", { type: "submit", disabled: true }, "Mark");

  constructor(private readonly context: Context) {
    this.root = element(
      "form",
      {
        class: "mark",
        submit: (event: Event) => {
          event.preventDefault();
          this.mark();
        },
      },
      this.text,
      this.press,
    );
  }

  show(status: LoopStatus): void {
    this.press.disabled = !status.running;
  }

  mark(): void {
    if (this.press.disabled) return;
    const text = this.text.value.trim() || "mark";
    this.context.api.post("/api/live/mark", { text }).catch(this.context.complain);
  }
}
