import "./force_bar.css";

import { isRefused, isSilence, type Api } from "../../api/api";
import type { LoopStatus } from "../../api/loop";
import { forceStates, type ForceState } from "./force_states";
import { OtherTabs } from "./other_tabs";

/** What the server says, and what only a page can know: it asked for zero force, was not heard, or gets no status. */
type Shown = ForceState | "asked" | "unheard" | "silent" | "outdated" | "refused";
interface Act {
  readonly text: string;
  readonly press: () => Promise<unknown>;
}

const patience_ms = 2500;
const look_ms = 300;
const outdated_ms = 3000; // as rarely as does for telling that no studio runs any more
const calm_ms = 700; // a second click of a double one, or a second thought, comes before

/** Says what there is of force in the hand, on every page, and keeps the button for zero force at work. */
export class ForceBar {
  private readonly words: HTMLElement;
  private readonly act: HTMLButtonElement;
  private readonly zero: HTMLButtonElement;
  private readonly tabs: OtherTabs;
  private state: Shown = "idle";
  private asking: AbortController | null = null;
  private press: (() => Promise<unknown>) | null = null;
  private calm = 0;
  private unheard = 0; // requests for zero force that nobody has answered yet
  /** What became of the last one, as long as no status tells. */
  private last: "none" | "heard" | "missed" = "none";
  private looked = 0; // when the status was asked for
  private isDown = false; // Escape, and the page knows

  constructor(
    private readonly api: Api,
    private readonly root: HTMLElement,
    private readonly complain: (error: unknown) => void,
  ) {
    this.words = root.querySelector("p")!;
    const [act, zero] = root.querySelectorAll("button");
    this.act = act!;
    this.zero = zero!;
    const strange: readonly Shown[] = ["silent", "outdated", "refused", "unheard", "session"];
    this.tabs = new OtherTabs(api.token, () => !strange.includes(this.state));
    this.listen();
    void this.look();
    setInterval(() => {
      const wait = this.state === "outdated" ? outdated_ms : 0;
      if (!this.asking && performance.now() - this.looked >= wait) void this.look();
    }, look_ms);
  }

  private listen(): void {
    // As soon as it is pressed, not when it is let go; a keyboard presses it by click.
    this.zero.addEventListener("pointerdown", () => this.release());
    this.zero.addEventListener("click", (event) => {
      if (event.detail === 0) this.release();
    });
    this.act.addEventListener("click", () => {
      this.press?.()
        .then(() => this.look())
        .catch((error: unknown) => this.complain(error));
    });
    // Before any page or dialog can keep the key for itself. An open list of the browser's own swallows the press, but
    // neither its repetition nor that the key is let go.
    const escape = (isDown: boolean) => (event: KeyboardEvent) => {
      if (event.key !== "Escape") return;
      if (!this.isDown) this.release();
      this.isDown = isDown;
    };
    addEventListener("keydown", escape(true), { capture: true });
    addEventListener("keyup", escape(false), { capture: true });
    addEventListener("blur", () => (this.isDown = false));
  }

  /** Words are read out when they change. */
  private show(state: Shown, words: string, act?: Act): void {
    this.state = state;
    this.root.dataset.state = state;
    if (this.words.textContent !== words) this.words.textContent = words;
    this.words.title = words; // where they are cut
    this.press = act?.press ?? null;
    const text = act?.text ?? "";
    if (this.act.textContent === text) return;
    if (text === "" && document.activeElement === this.act) this.zero.focus();
    this.act.textContent = text;
    this.act.hidden = text === "";
    this.act.disabled = true;
    clearTimeout(this.calm);
    this.calm = window.setTimeout(() => (this.act.disabled = false), calm_ms);
  }

  private showStatus(status: LoopStatus): void {
    this.last = "none";
    const { words, act } = forceStates[status.force];
    const order = act && { text: act.text, press: () => this.api.post(act.order) };
    this.show(status.force, words(status) + (status.recording ? ", recording" : ""), order);
  }

  private showFailure(error: unknown): void {
    if (isRefused(error)) {
      const before = { none: "", heard: "Zero force was heard. ", missed: "Zero force was refused. " }[this.last];
      const words = `${before}This page is older than the studio that runs: reload it`;
      this.show("outdated", words, { text: "Reload", press: () => this.reload() });
    } else if (this.last === "missed") {
      this.show("unheard", "Zero force was not heard: press again, or let go and switch the device off");
    } else if (isSilence(error)) {
      this.show("silent", "No answer from the studio: what the device does is not known");
    } else {
      this.show("refused", `The studio does not say: ${error instanceof Error ? error.message : String(error)}`);
    }
  }

  private async look(): Promise<void> {
    if (this.unheard > 0) return;
    this.asking?.abort();
    this.looked = performance.now();
    const asked = (this.asking = new AbortController());
    const timer = setTimeout(() => asked.abort(), patience_ms);
    try {
      const status = await this.api.loopStatus(asked.signal);
      if (this.asking === asked) this.showStatus(status);
    } catch (error) {
      if (this.asking === asked) this.showFailure(error);
    } finally {
      clearTimeout(timer);
      if (this.asking === asked) this.asking = null;
    }
  }

  private release(): void {
    this.asking = null; // what is asked for now would tell of a time before
    this.zero.classList.add("pressed");
    ++this.unheard;
    this.show("asked", "Zero force asked for");
    this.api
      .zeroForce()
      .then(
        () => (this.last = "heard"),
        (error: unknown) => {
          this.last = "missed";
          this.showFailure(error);
          this.complain(error);
        },
      )
      .finally(() => {
        if (--this.unheard > 0) return;
        this.zero.classList.remove("pressed");
        if (this.last === "heard") void this.look();
      });
  }

  /** The address of this tab has the old token. */
  private async reload(): Promise<void> {
    const token = await this.tabs.ask();
    if (token === "")
      throw new Error(
        "No other tab knows the studio that runs: open the address that it shows. Zero force works here.",
      );
    location.assign(`/?token=${token}${location.hash}`);
  }
}
