import { button, element } from "./dom";
import { isTyping } from "./keys";

const setting = "kerf single keys";

/** Single keys (?, Space) can be switched off, for those whose speech or reader sends letters. */
export function singleKeysOn(): boolean {
  return localStorage.getItem(setting) !== "off";
}

const keys: readonly (readonly [string, string])[] = [
  ["Escape", "zero force, from anywhere"],
  ["Ctrl + Alt + 1 to 9", "the pages, in the order of the bar"],
  ["?", "this help"],
  ["Space", "scope: pause, go on"],
  ["← →", "plot: move the cursor; loops: the cycle before, after"],
  ["Shift + ← →, Page up, Page down", "plot: move along"],
  ["+ −", "plot: show less, more; wheel, two fingers or dragging too"],
  ["0", "plot: show all; a double click too"],
  ["Home, End", "plot: the cursor to the left end, right end"],
];

/** The help in a dialog that leaves the bar with its zero force within reach. Gives back what opens and closes it. */
export function help(opener: HTMLButtonElement): () => void {
  const single = element("input", {
    type: "checkbox",
    checked: singleKeysOn(),
    change: () => localStorage.setItem(setting, single.checked ? "on" : "off"),
  });
  const close = button("Close", () => toggle());
  const head = element("h2", { id: "help_head" }, "Keys");
  const dialog = element(
    "dialog",
    { id: "help", "aria-labelledby": "help_head" },
    head,
    element(
      "dl",
      {},
      ...keys.map(([key, what]) => element("div", {}, element("dt", {}, key), element("dd", {}, what))),
    ),
    element(
      "p",
      {},
      "Keys of a plot work while it has the focus. What a screen reader keeps for itself goes past this page.",
    ),
    element("label", { class: "single_keys" }, single, "Single keys (? and Space) work outside of plots"),
    close,
  );
  document.body.append(dialog);
  const toggle = (): void => {
    if (dialog.open) {
      dialog.close();
      opener.focus();
    } else {
      dialog.show();
      close.focus();
    }
    opener.setAttribute("aria-expanded", String(dialog.open));
  };
  opener.setAttribute("aria-expanded", "false");
  opener.setAttribute("aria-controls", "help");
  opener.addEventListener("click", toggle);
  addEventListener("keydown", (event) => {
    if (event.key === "Escape" && dialog.open) toggle();
    if (event.key === "?" && singleKeysOn() && !event.ctrlKey && !event.altKey && !event.metaKey && !isTyping(event))
      toggle();
  });
  return toggle;
}

/** Ctrl + Alt + a digit, which neither browsers nor screen readers of the desktop use; not AltGr, which types. */
export function pageKeys(go: (page: number) => void): void {
  addEventListener("keydown", (event) => {
    if (!event.ctrlKey || !event.altKey || event.shiftKey || event.metaKey || event.getModifierState("AltGraph"))
      return;
    const digit = /^Digit([1-9])$/.exec(event.code)?.[1];
    if (digit === undefined) return;
    event.preventDefault();
    go(Number(digit) - 1);
  });
}
