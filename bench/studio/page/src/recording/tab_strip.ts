import { button, element } from "../ui/dom";
import type { RecordingTab } from "../ui/view";

/** The tabs across a recording's page; arrow keys go from one to the next, as the ARIA practices have them. */
export class TabStrip {
  readonly root: HTMLElement;
  private readonly buttons: readonly HTMLButtonElement[];

  constructor(
    private readonly tabs: readonly RecordingTab[],
    private readonly go: (name: string) => void,
  ) {
    this.buttons = tabs.map((it, k) =>
      button(it.title, () => go(it.name), {
        role: "tab",
        id: `tab_${it.name}`,
        "aria-controls": "tab_panel",
        title: `${it.title}: key ${k + 1}`,
      }),
    );
    this.root = element(
      "div",
      { class: "tabs", role: "tablist", "aria-label": "Ways to see it", keydown: (it: KeyboardEvent) => this.key(it) },
      ...this.buttons,
    );
  }

  mark(name: string): void {
    this.tabs.forEach((it, k) => {
      const press = this.buttons[k]!;
      press.setAttribute("aria-selected", String(it.name === name));
      press.tabIndex = it.name === name ? 0 : -1;
    });
  }

  private key(event: KeyboardEvent): void {
    const at = this.buttons.findIndex((it) => it === document.activeElement);
    const count = this.buttons.length;
    const to = { ArrowLeft: at + count - 1, ArrowRight: at + 1, Home: 0, End: count - 1 }[event.key];
    if (at < 0 || to === undefined) return;
    event.preventDefault();
    const next = to % count;
    this.buttons[next]!.focus();
    this.go(this.tabs[next]!.name);
  }
}
