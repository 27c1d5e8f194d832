import { isSamePlace, readAddress, withState, writeAddress, type Address } from "./address";

/** "push": a step of its own, that "back" undoes; "replace": the same step, as while somebody drags. */
export type Step = "push" | "replace";

const rest_ms = 250; // between two writes: browsers refuse more than some hundred changes of the address in 30 s

/**
 * The page's place in the address bar. What changes by hand comes in by `set`, what changes by back, forward and links
 * goes out by `moved` (another page or tab) and `onState` (the state of the same).
 */
export class Router {
  private current: Address;
  private written: string;
  private timer = 0;
  private written_ms = -rest_ms;
  private readonly listeners = new Set<() => void>();

  constructor(private readonly moved: (now: Address) => void) {
    this.current = readAddress(location.hash);
    this.written = location.hash;
    addEventListener("popstate", () => this.follow());
    addEventListener("hashchange", () => this.follow());
    addEventListener("pagehide", () => this.flush());
  }

  get address(): Address {
    return this.current;
  }

  /** To another place; "replace" where the one before should not be come back to. */
  go(address: Address, step: Step = "push"): void {
    this.flush();
    const samePlace = isSamePlace(address, this.current);
    this.current = address;
    this.write(step);
    if (samePlace) this.tell();
    else this.moved(address);
  }

  /** Changes the state of what is shown; the listeners are not told, since whoever calls it knows. */
  set(changed: Readonly<Record<string, string | number | null>>, step: Step = "replace"): void {
    const texts = Object.entries(changed).map(([key, value]) => [key, value === null ? null : String(value)] as const);
    const next = withState(this.current, Object.fromEntries(texts));
    if (writeAddress(next) === writeAddress(this.current)) return;
    if (step === "push") this.flush();
    this.current = next;
    const wait_ms = this.written_ms + rest_ms - performance.now();
    if (step === "push" || wait_ms <= 0) this.write(step);
    else this.timer ||= window.setTimeout(() => this.flush(), wait_ms);
  }

  /** Told when back, forward or a link has changed the state of what is shown. */
  onState(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Writes what still waits to be written. */
  flush(): void {
    if (this.timer) this.write("replace");
  }

  private write(step: Step): void {
    clearTimeout(this.timer);
    this.timer = 0;
    this.written_ms = performance.now();
    this.written = writeAddress(this.current);
    if (step === "push") history.pushState(null, "", this.written);
    else history.replaceState(null, "", this.written);
  }

  /** Back, forward, a link, or an address that was typed. */
  private follow(): void {
    if (location.hash === this.written) return;
    clearTimeout(this.timer);
    this.timer = 0;
    this.written = location.hash;
    const before = this.current;
    this.current = readAddress(location.hash);
    if (isSamePlace(before, this.current)) this.tell();
    else this.moved(this.current);
  }

  private tell(): void {
    for (const it of [...this.listeners]) it();
  }
}
