import type { LoopStatus } from "../../api/loop";
import { button, element } from "../../ui/dom";
import type { Context } from "../../ui/view";
import type { Drawing } from "../drawing";

const least_ms = 250; // between two laws that are sent while drawing

/** Renders the law on the running device: once, or along with every change. */
export class FeelPanel {
  readonly root: HTMLElement;
  private readonly follow: HTMLButtonElement;
  private waiting = 0;
  private sent = -Infinity;
  private felt: unknown = null;

  constructor(
    private readonly context: Context,
    private readonly drawing: Drawing,
    private readonly axis: number,
  ) {
    const now = button("Feel it now", () => void this.feel(true));
    this.follow = button("Feel while drawing", () => this.set(!this.isFollowing), { "aria-pressed": "false" });
    this.root = element("div", { class: "feel" }, now, this.follow);
  }

  end(): void {
    clearTimeout(this.waiting);
  }

  /** After a change; the last one is always sent. */
  changed(): void {
    if (!this.isFollowing || this.waiting || this.felt === this.drawing.knots) return;
    const wait = Math.max(0, this.sent + least_ms - performance.now());
    this.waiting = window.setTimeout(() => {
      this.waiting = 0;
      void this.feel(false);
    }, wait);
  }

  private get isFollowing(): boolean {
    return this.follow.getAttribute("aria-pressed") === "true";
  }
  private set(on: boolean): void {
    this.follow.setAttribute("aria-pressed", String(on));
    this.felt = null; // another law may have been rendered meanwhile
    if (on) this.changed();
  }

  private async tell(): Promise<void> {
    const { released } = await this.context.api.get<LoopStatus>("/api/live/status");
    this.context.say(
      released
        ? "Zero force stays on: let the force back in the bar to feel the drawn law."
        : "The device renders the drawn law now.",
    );
  }

  private async feel(says: boolean): Promise<void> {
    const { knots } = this.drawing;
    this.sent = performance.now();
    this.felt = knots;
    try {
      await this.context.api.post("/api/editor/feel", {
        recording: this.drawing.curve.recording,
        axis: this.axis,
        knots,
      });
      if (says) await this.tell();
    } catch (error) {
      this.felt = null;
      this.set(false);
      this.context.complain(error);
    }
  }
}
