import "./popover.css";

import { element } from "./dom";

/** A button that opens what stands below it, over the page: choices that need not be seen all the time. */
export class Popover {
  readonly root: HTMLDetailsElement;
  private readonly label = element("span", {});

  constructor(text: string, content: HTMLElement, gone: AbortSignal) {
    this.label.textContent = text;
    const head = element("summary", { class: "popover_head" }, this.label);
    // It takes the focus where text in it is pressed: else that goes to the page behind, and what is pressed is closed.
    const body = element("div", { class: "popover_body", tabindex: -1 }, content);
    this.root = element("details", { class: "popover" }, head, body);
    const close = (isBack: boolean): void => {
      if (!this.root.open) return;
      this.root.open = false;
      if (isBack) head.focus();
    };
    addEventListener(
      "pointerdown",
      (event) => {
        if (!this.root.contains(event.target as Node)) close(false);
      },
      { signal: gone },
    );
    this.root.addEventListener("focusout", ({ relatedTarget }) => {
      // Afterwards: Chromium does not survive that what has the focus is hidden while it loses it.
      if (relatedTarget instanceof Node && !this.root.contains(relatedTarget)) setTimeout(() => close(false));
    });
    addEventListener("keydown", (event) => event.key === "Escape" && close(true), { signal: gone });
  }

  set text(text: string) {
    if (this.label.textContent !== text) this.label.textContent = text;
  }
}
