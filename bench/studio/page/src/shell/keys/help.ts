import { button, element } from "../../ui/dom";
import { singleKeysOn, switchSingleKeys } from "../../ui/single_keys";
import type { Commands } from "./commands";

/** Keys that belong to what has the focus: no command has them. */
const keysOfParts: readonly (readonly [string, string])[] = [
  ["Escape", "zero force, from anywhere"],
  ["Space", "scope: pause, go on"],
  ["← → ↑ ↓", "plot: move the cursor, from line to line"],
  ["[ ]", "loops: the cycle before, after"],
  ["Shift + arrows, Page up, Page down", "plot: move along"],
  ["+ −", "plot: show less, more; wheel, two fingers or dragging too"],
  ["0", "plot: show all; a double click too"],
  ["f", "plot: the whole window, and back"],
  ["Home, End", "plot: the cursor to the left end, right end"],
  ["↑ ↓, Enter", "list: from line to line, open"],
];

/** The keys that work now, in a dialog that leaves the bar with its zero force within reach. */
export class Help {
  private readonly list = element("div", { class: "key_lists" });
  private readonly close = button("Close", () => this.toggle());
  private readonly dialog: HTMLDialogElement;

  constructor(
    private readonly opener: HTMLElement,
    private readonly commands: Commands,
  ) {
    const single = element("input", {
      type: "checkbox",
      checked: singleKeysOn(),
      change: () => switchSingleKeys(single.checked),
    });
    this.dialog = element(
      "dialog",
      { id: "help", "aria-labelledby": "help_head" },
      element("div", { class: "dialog_head" }, element("h2", { id: "help_head" }, "Keys"), this.close),
      this.list,
      element(
        "p",
        { class: "quiet" },
        "Keys of a plot work while it has the focus. What a screen reader keeps for itself goes past this page.",
      ),
      element("label", { class: "tick" }, single, "Keys without Ctrl or Alt work outside of plots"),
    );
    document.body.append(this.dialog);
    opener.setAttribute("aria-expanded", "false");
    opener.setAttribute("aria-controls", "help");
    opener.addEventListener("click", () => this.toggle());
    addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.dialog.open) this.toggle();
    });
  }

  toggle(): void {
    if (this.dialog.open) {
      this.dialog.close();
      this.opener.focus();
    } else {
      this.fill();
      this.dialog.show();
      this.close.focus();
    }
    this.opener.setAttribute("aria-expanded", String(this.dialog.open));
  }

  private fill(): void {
    const groups = new Map<string, (readonly [string, string])[]>();
    for (const { keys, title, group = "Everywhere" } of this.commands.all) {
      if (keys === undefined) continue;
      groups.set(group, [...(groups.get(group) ?? []), [keys, title]]);
    }
    groups.set("Where the focus is", [...keysOfParts]);
    this.list.replaceChildren(
      ...[...groups].map(([group, keys]) =>
        element(
          "section",
          {},
          element("h3", {}, group),
          element(
            "dl",
            {},
            ...keys.map(([key, what]) =>
              element("div", {}, element("dt", {}, keysInWords(key)), element("dd", {}, what)),
            ),
          ),
        ),
      ),
    );
  }
}

/** "Ctrl+Alt+1" as "Ctrl + Alt + 1", "g r" as "g, then r". */
export function keysInWords(keys: string): string {
  return keys.replace(/(?<=.)\+(?=.)/g, " + ").replace(/^(\w) (\w)$/, "$1, then $2");
}
