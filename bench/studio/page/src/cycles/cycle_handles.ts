import type { Api } from "../api/api";
import { element } from "../ui/dom";
import type { TimeRange } from "../ui/time/time_range";
import { boundariesOf, type Boundary, type Draft } from "./cycle_draft";

interface Hands {
  /** The boundary is held at a time; nothing is changed yet. */
  held: (at: Boundary, time_s: number) => void;
  move: (at: Boundary, row: number, time_s: number, tag: string) => void;
  complain: (error: unknown) => void;
}

/** The boundaries of one cycle over the time plots: dragged by the pointer, nudged by the arrow keys. */
export class CycleHandles {
  readonly root = element("div", { class: "cycle_handles", role: "group", "aria-label": "Boundaries of the cycle" });
  private handles: HTMLElement[] = [];
  private boundaries: Boundary[] = [];
  private period_s = 0;
  private frame = 0;

  constructor(
    private readonly api: Api,
    private readonly id: string,
    private readonly range: TimeRange,
    private readonly plots: HTMLElement, // whose .time_over has the width of the plots
    private readonly hands: Hands,
  ) {}

  show(draft: Draft | null, cycle: number, rows: number, period_s: number, locked: boolean): void {
    this.period_s = period_s;
    this.boundaries = draft && !locked ? boundariesOf(draft, cycle, rows) : [];
    while (this.handles.length > this.boundaries.length) this.handles.pop()?.remove();
    while (this.handles.length < this.boundaries.length) {
      const k = this.handles.length;
      const handle = this.handle(k);
      this.handles.push(handle);
      this.root.append(handle);
    }
    this.place();
  }

  /** Puts them where their times are, once the plots are drawn. */
  place(): void {
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame(() => this.placeNow());
  }

  private placeNow(): void {
    const over = this.plots.querySelector<HTMLElement>(".time_over");
    if (!over) return;
    const [outer, inner] = [this.root.getBoundingClientRect(), over.getBoundingClientRect()];
    const { from, to, span } = this.range;
    this.boundaries.forEach((at, k) => {
      const handle = this.handles[k]!;
      if (handle.classList.contains("is_held")) return;
      handle.hidden = at.time_s < from || at.time_s > to;
      handle.style.left = `${inner.left - outer.left + ((at.time_s - from) / span) * inner.width}px`;
      const text = `cycle ${at.cycle}: ${at.text} at ${at.time_s.toFixed(4)} s`;
      handle.setAttribute("aria-label", `Boundary: ${at.text}`);
      handle.setAttribute("aria-valuemin", String(at.least));
      handle.setAttribute("aria-valuemax", String(at.most));
      handle.setAttribute("aria-valuenow", String(at.row));
      handle.setAttribute("aria-valuetext", text);
      handle.title = `${text}. Drag it, or nudge it by the arrow keys (Shift: ten rows).`;
    });
  }

  private handle(k: number): HTMLElement {
    const node = element("div", {
      class: "cycle_handle",
      role: "slider",
      tabindex: 0,
      "aria-orientation": "horizontal",
    });
    node.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      event.preventDefault();
      event.stopPropagation();
      node.focus();
      node.setPointerCapture(event.pointerId);
      node.classList.add("is_held");
    });
    node.addEventListener("pointermove", (event) => {
      const at = this.boundaries[k];
      if (!node.classList.contains("is_held") || !at) return;
      const over = this.plots.querySelector<HTMLElement>(".time_over")!.getBoundingClientRect();
      const share = Math.min(1, Math.max(0, (event.clientX - over.left) / over.width));
      node.style.left = `${over.left - this.root.getBoundingClientRect().left + share * over.width}px`;
      this.hands.held(at, this.range.from + share * this.range.span);
      node.dataset.time = String(this.range.from + share * this.range.span);
    });
    const release = (event: PointerEvent): void => {
      if (!node.classList.contains("is_held")) return;
      node.classList.remove("is_held");
      const [at, time] = [this.boundaries[k], Number(node.dataset.time ?? NaN)];
      delete node.dataset.time;
      if (event.type === "pointerup" && at && Number.isFinite(time)) void this.drop(at, time);
      else this.place();
    };
    node.addEventListener("pointerup", release);
    node.addEventListener("pointercancel", release);
    node.addEventListener("keydown", (event) => this.key(event, k));
    return node;
  }

  private async drop(at: Boundary, time_s: number): Promise<void> {
    try {
      const found = await this.api.get<{ row: number; time_s: number }>("/api/cycles/row", {
        id: this.id,
        time: time_s,
      });
      this.hands.move(at, found.row, found.time_s, "");
    } catch (error) {
      this.hands.complain(error);
      this.place();
    }
  }

  private key(event: KeyboardEvent, k: number): void {
    const at = this.boundaries[k];
    const way = event.key === "ArrowLeft" ? -1 : event.key === "ArrowRight" ? 1 : 0;
    if (!at || way === 0 || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    const by = way * (event.shiftKey ? 10 : 1);
    const row = Math.min(at.most, Math.max(at.least, at.row + by));
    if (row !== at.row) this.hands.move(at, row, at.time_s + (row - at.row) * this.period_s, `nudge ${k}`);
  }
}
