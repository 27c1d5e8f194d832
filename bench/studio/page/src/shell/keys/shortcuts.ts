import { isTyping } from "../../ui/keys";
import { singleKeysOn } from "../../ui/single_keys";
import type { Command, Commands } from "./commands";

const patience_ms = 1200; // between two keys of "g r"

/** Runs commands by their keys. Keys of a plot or field that has the focus, and those of the browser, stay theirs. */
export class Shortcuts {
  private begun = ""; // of a sequence
  private timer = 0;

  constructor(private readonly commands: Commands) {
    addEventListener("keydown", (event) => this.key(event));
  }

  private key(event: KeyboardEvent): void {
    if (event.defaultPrevented || event.repeat || event.isComposing) return;
    const pressed = inWords(event);
    if (pressed === "") return;
    const isSingle = !event.ctrlKey && !event.altKey && !event.metaKey;
    if (isSingle && (!singleKeysOn() || isTyping(event))) return;
    const whole = this.begun ? `${this.begun} ${pressed}` : pressed;
    this.begun = "";
    clearTimeout(this.timer);
    const all = this.commands.all;
    const command = newest(all.filter((it) => it.keys === whole));
    if (command) {
      event.preventDefault();
      command.run();
    } else if (all.some((it) => it.keys?.startsWith(`${whole} `))) {
      this.begun = whole;
      this.timer = window.setTimeout(() => (this.begun = ""), patience_ms);
    }
  }
}

/** What a tab offers comes before what the shell does. */
function newest(all: readonly Command[]): Command | undefined {
  return all[all.length - 1];
}

/** "Ctrl+K", "Ctrl+Alt+1", "?", "g"; empty for AltGr, which types, and for Ctrl and Shift alone. */
function inWords(event: KeyboardEvent): string {
  if (event.getModifierState("AltGraph") || /^(Control|Shift|Alt|Meta)$/.test(event.key)) return "";
  const digit = /^Digit([0-9])$/.exec(event.code)?.[1];
  const modifiers = [event.ctrlKey || event.metaKey ? "Ctrl" : "", event.altKey ? "Alt" : ""].filter(Boolean);
  if (modifiers.length === 0) return event.key.length === 1 || event.shiftKey ? event.key : "";
  if (event.shiftKey) modifiers.push("Shift");
  return [...modifiers, digit ?? (event.key.length === 1 ? event.key.toUpperCase() : event.key)].join("+");
}
