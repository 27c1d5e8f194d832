import type { CycleView, JudgedCycle, Remark } from "../api/cycles";
import { kindsOf } from "../recordings/cycle_flags";
import { button, element } from "../ui/dom";
import { counted, plain } from "../ui/numbers";
import { spanOf, type Draft } from "./cycle_draft";

const mostCycles = 500;

interface Hands {
  choose: (cycle: number) => void;
  /** The next press on the plots is where a cycle is split; or no longer. */
  split: () => void;
  merge: () => void;
  remark: (cycle: number, remark: Remark | null) => void;
}

/** The cycles one by one: a press shows one, and leaves it out or takes it back. */
export class CycleTable {
  readonly root: HTMLElement;
  private readonly head = element("h2", {});
  private readonly list = element("ol", { class: "cycle_list" });
  private readonly reason: HTMLInputElement;
  private readonly split: HTMLButtonElement;
  private readonly merge: HTMLButtonElement;
  private lines = new Map<number, HTMLLIElement>();
  private drawn = "";

  constructor(private readonly hands: Hands) {
    this.reason = element("input", {
      maxlength: 200,
      placeholder: "left out by hand",
      "aria-label": "Why a cycle is left out or taken",
    });
    this.split = button("Split …", () => hands.split(), {
      title: "Where you press in the plots. Key s: at the cursor",
    });
    this.merge = button("Merge with the next", () => hands.merge(), { title: "The chosen cycle. Key m" });
    this.root = element(
      "section",
      { class: "cycle_table", "aria-label": "Cycles" },
      this.head,
      element("div", { class: "row" }, this.split, this.merge),
      element("label", { class: "field" }, element("span", {}, "Reason for the next one"), this.reason),
      this.list,
    );
  }

  /** Which of the deeds on whole cycles there are. */
  offer(canSplit: boolean, splits: boolean, canMerge: boolean): void {
    this.split.disabled = !canSplit;
    this.split.setAttribute("aria-pressed", String(splits));
    this.merge.disabled = !canMerge;
  }

  show(view: CycleView | null, draft: Draft | null, chosen: number, locked: boolean): void {
    const cycles = view?.cycles ?? [];
    const bad = cycles.filter((it) => !it.good).length;
    this.head.textContent =
      cycles.length === 0 ? "No cycles" : `${counted(cycles.length, "cycle")}, ${bad === 0 ? "none" : bad} left out`;
    const shown = cycles.slice(0, mostCycles);
    const now = JSON.stringify([shown, draft?.said, locked, draft?.phases.length]);
    if (now !== this.drawn && draft) {
      this.drawn = now;
      const focused = this.focused();
      this.lines = new Map(shown.map((it) => [it.number, this.line(it, draft, locked)]));
      this.list.replaceChildren(...this.lines.values());
      this.focusAgain(focused);
    }
    for (const [number, line] of this.lines) {
      line.classList.toggle("chosen", number === chosen);
      line.querySelector("button")?.setAttribute("aria-pressed", String(number === chosen));
    }
  }

  /** What is said of a cycle changes with the answer; whoever works with the keys stays where they were. */
  private focused(): [number, number] | null {
    for (const [number, line] of this.lines) {
      const at = [...line.querySelectorAll("button")].indexOf(document.activeElement as HTMLButtonElement);
      if (at >= 0) return [number, at];
    }
    return null;
  }

  private focusAgain(at: [number, number] | null): void {
    if (at) [...(this.lines.get(at[0])?.querySelectorAll("button") ?? [])][at[1]]?.focus();
  }

  private line(it: JudgedCycle, draft: Draft, locked: boolean): HTMLLIElement {
    const span = spanOf(draft, it.number);
    const byHand = draft.said.find((remark) => remark.cycle === it.number);
    const why = it.accepted === null ? it.flags.map((flag) => flag.reason).join("; ") : `taken: ${it.accepted}`;
    const at = span ? `${plain(span.from_s, 5)} s` : "";
    return element(
      "li",
      { class: it.good ? "" : "flagged" },
      button(`${it.number}`, () => this.hands.choose(it.number), {
        class: "cycle_number",
        "aria-label": `Show cycle ${it.number}`,
      }),
      element("span", { class: "cycle_at" }, at),
      element("span", { class: "cycle_kinds" }, it.accepted !== null ? "taken" : kindsOf(it)),
      this.deed(it, byHand, locked),
      why ? element("p", { class: "quiet" }, why) : null,
    );
  }

  private deed(it: JudgedCycle, byHand: Remark | undefined, locked: boolean): HTMLButtonElement {
    const { number } = it;
    if (byHand) {
      const text = byHand.kind === "by_hand" ? "Restore" : "As found";
      return button(text, () => this.hands.remark(number, null), {
        disabled: locked,
        "aria-label": `${text} cycle ${number}`,
      });
    }
    if (!it.good) {
      const take = (): void =>
        this.hands.remark(number, { cycle: number, kind: "accepted", reason: this.why("taken by hand") });
      return button("Take", take, { disabled: locked, "aria-label": `Take cycle ${number} all the same` });
    }
    const drop = (): void =>
      this.hands.remark(number, { cycle: number, kind: "by_hand", reason: this.why("left out by hand") });
    return button("Leave out", drop, { disabled: locked, "aria-label": `Leave out cycle ${number}` });
  }

  private why(otherwise: string): string {
    return this.reason.value.trim() || otherwise;
  }
}
