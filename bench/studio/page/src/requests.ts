/**
 * Which reading requests are under way: at most three at once, so that of the six connections that a browser opens
 * to a server there is always one for zero force; and all can be given up.
 */
export class Requests {
  private readonly underWay = new Set<AbortController>();
  private readonly waiting = new Set<() => void>();

  /** Runs one in its turn, up to the end of its answer; the caller's signal or giveUp() ends it before. */
  async take<Answer>(run: (signal: AbortSignal) => Promise<Answer>, signal?: AbortSignal): Promise<Answer> {
    const own = new AbortController();
    const end = (): void => own.abort();
    if (signal?.aborted) end();
    signal?.addEventListener("abort", end);
    try {
      while (this.underWay.size >= 3 && !own.signal.aborted) await this.turn(own.signal);
      this.underWay.add(own);
      return await run(own.signal);
    } finally {
      this.underWay.delete(own);
      signal?.removeEventListener("abort", end);
      this.wakeNext();
    }
  }

  giveUp(): void {
    for (const it of [...this.underWay]) it.abort();
  }

  private turn(signal: AbortSignal): Promise<void> {
    return new Promise((go) => {
      const wake = (): void => {
        this.waiting.delete(wake);
        go();
      };
      this.waiting.add(wake);
      signal.addEventListener("abort", wake);
    });
  }

  private wakeNext(): void {
    for (const wake of this.waiting) return wake();
  }
}
