import type { Api } from "../api/api";
import type { LiveFrame, LoopStatus } from "../api/loop";
import type { KerfEvent } from "../api/recordings";
import { ApiError } from "../api/api";

export interface LiveListener {
  frame: (frame: LiveFrame) => void;
  status: (status: LoopStatus) => void;
  /** Nothing has come for so long; 0: all is well. */
  stale: (seconds: number) => void;
  /** A session is running: nothing of the loop is shown. */
  session: (line: string) => void;
}

const sessionLine = "A session is running; nothing of the loop is shown.";

/** The stream of the running loop. It is opened again by itself until closed, whatever becomes of the server. */
export class LiveStream {
  private source: EventSource | null = null;
  private ticks = 1;
  private heard = performance.now();
  private opened = 0;
  private asking = false;
  private closed = false;
  private readonly timer = window.setInterval(() => this.watch(), 500);
  private readonly seen = (): void => this.onVisible();

  constructor(
    private readonly api: Api,
    private readonly listener: LiveListener,
  ) {
    document.addEventListener("visibilitychange", this.seen);
  }

  close(): void {
    this.closed = true;
    clearInterval(this.timer);
    document.removeEventListener("visibilitychange", this.seen);
    this.source?.close();
  }

  open(ticks: number): void {
    this.ticks = ticks;
    this.opened = performance.now();
    this.source?.close();
    if (document.hidden) return;
    const source = (this.source = this.api.stream("/api/live/stream", { ticks }));
    source.addEventListener("frame", (event) => {
      this.alive();
      this.listener.frame(JSON.parse((event as MessageEvent<string>).data) as LiveFrame);
    });
    source.addEventListener("status", (event) => {
      this.alive();
      const status = JSON.parse((event as MessageEvent<string>).data) as LoopStatus;
      if (status.session) this.listener.session(sessionLine);
      else this.listener.status(status);
    });
    source.addEventListener("error", () => void this.ask());
  }

  private alive(): void {
    this.heard = performance.now();
    this.listener.stale(0);
  }

  /** A hidden page needs no stream, and a browser has few connections. */
  private onVisible(): void {
    if (document.hidden) this.source?.close();
    else this.open(this.ticks);
  }

  private watch(): void {
    if (document.hidden) return;
    const now = performance.now();
    const silent = (now - this.heard) / 1000;
    if (silent < 1) return;
    if (silent >= 2) this.listener.stale(Math.floor(silent));
    void this.ask();
    if (this.api.isOutdated)
      this.source?.close(); // which the browser would open again
    else if (silent >= 2 && now - this.opened > 3000) this.open(this.ticks);
  }

  /** Why the stream is silent: no loop runs, a session forbids it, or the server is away. */
  private async ask(): Promise<void> {
    if (this.asking) return;
    this.asking = true;
    const patience = new AbortController();
    const timer = setTimeout(() => patience.abort(), 2000);
    try {
      const status = await this.api.get<LoopStatus>("/api/live/status", {}, patience.signal);
      if (this.closed) return;
      if (status.session) this.listener.session(sessionLine);
      else this.listener.status(status);
      if (!status.running) this.alive(); // nothing is missed
    } catch (error) {
      if (error instanceof ApiError && error.status === 409) this.listener.session(error.message);
    } finally {
      clearTimeout(timer);
      this.asking = false;
    }
  }
}

/** The last events, newest last. */
export class LastEvents {
  readonly events: KerfEvent[] = [];

  /** A stream that is opened again may tell what is known. */
  add(events: readonly KerfEvent[]): boolean {
    const known = (it: KerfEvent): boolean =>
      this.events.some((other) => other.time_s === it.time_s && other.text === it.text);
    const fresh = events.filter((it) => !known(it));
    if (fresh.length === 0) return false;
    this.events.push(...fresh);
    if (this.events.length > 200) this.events.splice(0, this.events.length - 200);
    return true;
  }

  clear(): void {
    this.events.length = 0;
  }
}
