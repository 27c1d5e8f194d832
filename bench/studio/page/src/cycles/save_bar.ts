import { button, element, labelled } from "../ui/dom";
import type { CycleDesk } from "./cycle_desk";
import { keepAuthor, keptAuthor } from "./kept_drafts";

/** Steps back and forth, who edits, and what stands in the way of saving. */
export class SaveBar {
  readonly root: HTMLElement;
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;
  private readonly save: HTMLButtonElement;
  private readonly author: HTMLInputElement;
  private readonly words = element("span", { class: "quiet", role: "status" });
  private readonly trouble = element("p", { class: "cycle_trouble", role: "alert", hidden: true });

  constructor(private readonly desk: CycleDesk) {
    this.undo = button("Undo", () => desk.undo(), { title: "Ctrl+Z" });
    this.redo = button("Redo", () => desk.redo(), { title: "Ctrl+Shift+Z" });
    this.author = element("input", {
      maxlength: 60,
      spellcheck: "false",
      input: () => keepAuthor(this.author.value.trim()),
    });
    this.author.value = keptAuthor();
    this.save = button("Save", () => void desk.save(this.author.value.trim()), { class: "firm" });
    this.root = element(
      "div",
      { class: "save_bar" },
      element("div", { class: "row" }, this.undo, this.redo, this.save, this.words),
      labelled("Edited by", this.author),
      this.trouble,
    );
  }

  show(): void {
    const { desk } = this;
    const { view, trouble } = desk;
    if (this.author.value === "" && view?.author && document.activeElement !== this.author)
      this.author.value = view.author;
    const locked = view?.locked !== "";
    this.undo.disabled = !desk.canUndo;
    this.redo.disabled = !desk.canRedo;
    // Not while a look is under way: a press would be lost where one begins between its down and its up.
    this.save.disabled = locked || !desk.isChanged || desk.isSaving || view.phases.length === 0;
    this.save.textContent = desk.draft?.settings ? "Save these cycles" : "Save";
    const state = desk.isStored ? (desk.isChanged ? "not saved" : "as saved") : "not in the recording yet";
    this.words.textContent = desk.isSaving ? "is saved …" : desk.isBusy ? "…" : state;
    this.trouble.hidden = !trouble;
    const text = trouble?.text ?? "";
    if (this.trouble.dataset.text === text) return;
    this.trouble.dataset.text = text;
    this.trouble.replaceChildren(
      element("span", {}, text),
      ...(trouble?.canMerge
        ? [
            button("Load them, mine on top", () => void desk.reload(true)),
            button("Load them without mine", () => void desk.reload(false)),
          ]
        : []),
      ...(trouble?.isOther ? [button("Read that one, without what was changed here", () => desk.leave())] : []),
    );
  }
}
