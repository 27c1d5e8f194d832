import { element } from "../../ui/dom";

const margin = 8; // rows beyond what is seen, so that a turn of the wheel finds them there

/**
 * A list of any length: only the rows that are seen exist. Arrow keys, Page, Home and End go from row to row, as in a
 * list of files; a screen reader is told which of how many each is.
 */
export class VirtualList<Item> {
  readonly root: HTMLElement;
  private readonly space = element("div", { class: "rows" });
  private items: readonly Item[] = [];
  private readonly drawn = new Map<number, { frame: HTMLElement; row: HTMLElement }>();
  private current = 0; // that Tab comes to
  private readonly observer: ResizeObserver;

  constructor(
    label: string,
    private readonly height: number, // of a row [px]
    private readonly make: (item: Item) => HTMLElement,
    private readonly isSame: (one: Item, other: Item) => boolean,
  ) {
    this.space.setAttribute("role", "list");
    this.space.setAttribute("aria-label", label);
    this.root = element(
      "div",
      { class: "virtual_list", scroll: () => this.draw(), keydown: (event: KeyboardEvent) => this.key(event) },
      this.space,
    );
    this.observer = new ResizeObserver(() => this.draw());
    this.observer.observe(this.root);
  }

  end(): void {
    this.observer.disconnect();
  }

  /** Shows these; rows whose item has not changed stay as they are, with their focus. */
  show(items: readonly Item[]): void {
    const before = this.items;
    this.items = items;
    this.current = Math.min(this.current, Math.max(0, items.length - 1));
    for (const [at, { frame }] of [...this.drawn]) {
      const [was, is] = [before[at], items[at]];
      frame.setAttribute("aria-setsize", String(items.length));
      if (was !== undefined && is !== undefined && this.isSame(was, is)) continue;
      frame.remove();
      this.drawn.delete(at);
    }
    this.space.style.height = `${items.length * this.height}px`;
    this.draw();
  }

  /** The row that Tab comes to, and into sight if asked. */
  point(at: number, isSeen = false): void {
    if (at < 0 || at >= this.items.length) return;
    this.drawn.get(this.current)?.row.setAttribute("tabindex", "-1");
    this.current = at;
    if (isSeen) {
      const top = at * this.height;
      const { scrollTop, clientHeight } = this.root;
      if (top < scrollTop) this.root.scrollTop = top;
      else if (top + this.height > scrollTop + clientHeight) this.root.scrollTop = top + this.height - clientHeight;
    }
    this.draw();
    this.drawn.get(at)?.row.setAttribute("tabindex", "0");
  }

  focus(): void {
    this.point(this.current, true);
    this.drawn.get(this.current)?.row.focus({ preventScroll: true });
  }

  /** Each row that is there, to be marked. */
  rows(): Iterable<readonly [Item, HTMLElement]> {
    return [...this.drawn].map(([at, { row }]) => [this.items[at]!, row] as const);
  }

  private draw(): void {
    const first = Math.max(0, Math.floor(this.root.scrollTop / this.height) - margin);
    const seen = Math.ceil(this.root.clientHeight / this.height) + 2 * margin;
    const end = Math.min(this.items.length, first + seen);
    for (const [at, { frame, row }] of [...this.drawn]) {
      if ((at >= first && at < end) || row === document.activeElement) continue;
      frame.remove();
      this.drawn.delete(at);
    }
    for (let at = first; at < end; ++at) if (!this.drawn.has(at)) this.add(at);
  }

  private add(at: number): void {
    const row = this.make(this.items[at]!);
    row.tabIndex = at === this.current ? 0 : -1;
    const place = { role: "listitem", "aria-posinset": at + 1, "aria-setsize": this.items.length };
    const frame = element("div", { class: "row_frame", ...place }, row);
    frame.style.top = `${at * this.height}px`;
    this.drawn.set(at, { frame, row });
    // In their order, which is that of a screen reader.
    const after = Math.min(...[...this.drawn.keys()].filter((it) => it > at));
    this.space.insertBefore(frame, this.drawn.get(after)?.frame ?? null);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    const page = Math.max(1, Math.floor(this.root.clientHeight / this.height) - 1);
    const last = this.items.length - 1;
    const to = {
      ArrowDown: this.current + 1,
      ArrowUp: this.current - 1,
      PageDown: this.current + page,
      PageUp: this.current - page,
      Home: 0,
      End: last,
    }[event.key];
    if (to === undefined || last < 0) return;
    event.preventDefault();
    this.point(Math.min(Math.max(0, to), last), true);
    this.drawn.get(this.current)?.row.focus({ preventScroll: true });
  }
}
