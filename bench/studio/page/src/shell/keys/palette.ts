import "./palette.css";

import { element } from "../../ui/dom";
import type { Command, Commands } from "./commands";
import { keysInWords } from "./help";

const mostShown = 60;

/** Everything that can be done now, and every place that there is, found by a few letters of its name. */
export class Palette {
  private readonly input = element("input", {
    type: "text",
    role: "combobox",
    "aria-expanded": "true",
    "aria-controls": "palette_list",
    "aria-autocomplete": "list",
    "aria-label": "Command or place",
    placeholder: "Command, recording, study or page",
    autocomplete: "off",
    spellcheck: "false",
    input: () => this.find(),
    keydown: (event: KeyboardEvent) => this.key(event),
  });
  private readonly list = element("ul", { id: "palette_list", role: "listbox", "aria-label": "What is found" });
  private readonly dialog: HTMLDialogElement;
  private found: readonly Command[] = [];
  private at = 0;
  private before: Element | null = null;

  constructor(
    private readonly commands: Commands,
    /** Recordings and other files, which are too many to be commands of their own all the time. */
    private readonly places: () => readonly Command[],
  ) {
    this.dialog = element("dialog", { id: "palette", "aria-label": "Commands" }, this.input, this.list);
    document.body.append(this.dialog);
    addEventListener("pointerdown", (event) => {
      if (this.dialog.open && !this.dialog.contains(event.target as Node)) this.close(false);
    });
    addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.dialog.open) this.close(true);
    });
  }

  toggle(): void {
    if (this.dialog.open) return this.close(true);
    this.before = document.activeElement;
    this.input.value = "";
    this.dialog.show(); // not modal: zero force stays within reach
    this.find();
    this.input.focus();
  }

  private close(isBack: boolean): void {
    this.dialog.close();
    if (isBack && this.before instanceof HTMLElement) this.before.focus();
  }

  private find(): void {
    const words = this.input.value.trim().toLowerCase();
    const all = words === "" ? this.commands.all : [...this.commands.all, ...this.places()];
    this.found = all
      .map((it) => ({ it, rank: rankOf(`${it.group ?? ""} ${it.title}`.toLowerCase(), it.title.toLowerCase(), words) }))
      .filter(({ rank }) => rank < Infinity)
      .sort((a, b) => a.rank - b.rank)
      .slice(0, mostShown)
      .map(({ it }) => it);
    this.at = 0;
    this.list.replaceChildren(...this.found.map((it, k) => this.line(it, k)));
    if (this.found.length === 0)
      this.list.append(element("li", { class: "nothing", role: "option" }, "Nothing has such a name"));
    this.mark();
  }

  private line(it: Command, k: number): HTMLElement {
    return element(
      "li",
      { role: "option", id: `palette_${k}`, click: () => this.run(k) },
      element("span", { class: "palette_group" }, it.group ?? ""),
      element("span", { class: "palette_title" }, it.title),
      it.keys === undefined ? null : element("kbd", {}, keysInWords(it.keys)),
    );
  }

  private mark(): void {
    [...this.list.children].forEach((it, k) => it.setAttribute("aria-selected", String(k === this.at)));
    if (this.found.length === 0) return this.input.removeAttribute("aria-activedescendant");
    this.input.setAttribute("aria-activedescendant", `palette_${this.at}`);
    this.list.children[this.at]?.scrollIntoView({ block: "nearest" });
  }

  private key(event: KeyboardEvent): void {
    const count = this.found.length;
    const by = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key];
    if (by !== undefined && count > 0) {
      const next = this.at + by;
      this.at = Math.abs(by) === 1 ? (next + count) % count : Math.min(count - 1, Math.max(0, next));
      this.mark();
    } else if (event.key === "Enter") {
      this.run(this.at);
    } else if (event.key === "Tab") {
      this.close(true);
    } else {
      return;
    }
    event.preventDefault();
  }

  private run(k: number): void {
    const command = this.found[k];
    if (!command) return;
    this.close(true);
    command.run();
  }
}

/** The smaller, the better; infinite where a word is not there, not even by its letters in their order. */
function rankOf(text: string, title: string, words: string): number {
  let rank = 0;
  for (const word of words.split(/\s+/)) {
    if (title.startsWith(word)) continue;
    const at = text.indexOf(word);
    if (at === 0 || text[at - 1] === " " || text[at - 1] === "/") rank += 1;
    else if (at > 0) rank += 2;
    else if (isScattered(title, word)) rank += 6;
    else return Infinity;
  }
  return rank;
}

function isScattered(text: string, letters: string): boolean {
  let at = 0;
  for (const letter of letters) {
    at = text.indexOf(letter, at) + 1;
    if (at === 0) return false;
  }
  return letters.length > 1;
}
