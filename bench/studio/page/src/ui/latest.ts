/**
 * The one way to take an answer that may come late: of several questions only the last one's answer counts, and none
 * after the page has gone.
 *
 *     private readonly loops = new Latest(context.signal);
 *     const found = await this.loops.ask((signal) => api.get<Loops>(path, wanted, signal));
 *     if (found) this.draw(found);
 */
export class Latest {
  private asked: AbortController | null = null;

  constructor(private readonly gone: AbortSignal) {
    gone.addEventListener("abort", () => this.end());
  }

  /** The answer; undefined where another question or the end has come before it. Errors of the last question alone. */
  async ask<Answer>(question: (signal: AbortSignal) => Promise<Answer>): Promise<Answer | undefined> {
    this.end();
    if (this.gone.aborted) return undefined;
    const own = (this.asked = new AbortController());
    try {
      const answer = await question(own.signal);
      return own.signal.aborted ? undefined : answer;
    } catch (error) {
      if (own.signal.aborted) return undefined;
      throw error;
    }
  }

  /** Whoever has asked is no longer interested. */
  end(): void {
    this.asked?.abort();
    this.asked = null;
  }
}
