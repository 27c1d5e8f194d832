import { Requests } from "../requests";
import { withLocalTimes } from "../ui/words/moments";
import type { LoopStatus } from "./loop";
import type { TraceView } from "./recordings";

// How the server is asked. What it answers stands beside this, by subject. Every request carries the token in a header
// that no other site can send.

export class ApiError extends Error {
  constructor(
    readonly status: number,
    message: string,
  ) {
    super(message);
  }
}

/** Refused for its token: the studio that runs is not the one that this page is of. 429 is what many refusals end in. */
export function isRefused(error: unknown): boolean {
  return error instanceof ApiError && (error.status === 403 || error.status === 429);
}

type Parameters = Record<string, string | number | readonly number[]>;

export class Api {
  private readonly requests = new Requests();
  private outdated = false; // as the last status says

  constructor(readonly token: string) {}

  /** The studio that runs is another one: nothing is asked of it but its status, and zero force. */
  get isOutdated(): boolean {
    return this.outdated;
  }

  async get<Answer>(path: string, parameters: Parameters = {}, signal?: AbortSignal): Promise<Answer> {
    return this.read(path, parameters, signal, async (answer) => (await answer.json()) as Answer);
  }

  async post<Answer = unknown>(path: string, body: unknown = {}, signal?: AbortSignal): Promise<Answer> {
    const answer = await this.send(path, {
      ...(signal ? { signal } : {}),
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
    });
    return (await answer.json()) as Answer;
  }

  /** A piece of a file; an answer that does not come in 20 s counts as none. */
  async postBytes<Answer>(
    path: string,
    parameters: Parameters,
    bytes: ArrayBuffer,
    signal: AbortSignal,
  ): Promise<Answer> {
    const own = new AbortController();
    const end = (): void => own.abort();
    const patience = setTimeout(end, 20_000);
    signal.addEventListener("abort", end);
    try {
      const headers = { "Content-Type": "application/octet-stream" };
      const answer = await this.send(address(path, parameters), {
        method: "POST",
        headers,
        body: bytes,
        signal: own.signal,
      });
      return (await answer.json()) as Answer;
    } catch (error) {
      if (own.signal.aborted && !signal.aborted) throw silent();
      throw error;
    } finally {
      clearTimeout(patience);
      signal.removeEventListener("abort", end);
    }
  }

  /** A stretch of traces: /api/live/view or /api/recording/view. */
  async view(path: string, parameters: Parameters, signal?: AbortSignal): Promise<TraceView> {
    return this.read(path, parameters, signal, async (answer) => traceView(await answer.arrayBuffer()));
  }

  /** A file, as the server has it. */
  async file(path: string, parameters: Parameters): Promise<{ content: Blob; type: string }> {
    return this.read(path, parameters, undefined, async (answer) => ({
      content: await answer.blob(),
      type: answer.headers.get("Content-Type") ?? "",
    }));
  }

  /** An address for a tab of its own, or to be saved: whoever it is given to can open what is there and nothing else. */
  async opening(path: string, parameters: Parameters): Promise<string> {
    const query = Object.fromEntries(Object.entries(parameters).map(([name, value]) => [name, String(value)]));
    const { key } = await this.post<{ key: string }>("/api/key", { path, query });
    return address(path, {
      ...Object.fromEntries(Object.entries(query).map(([k, v]) => [k, encodeURIComponent(v)])),
      key,
    });
  }

  /** Server-sent events; the browser connects again by itself. */
  stream(path: string, parameters: Parameters = {}): EventSource {
    return new EventSource(address(path, { ...parameters, token: this.token }));
  }

  /** Past what else is being read, so that only a studio that does not answer is late. */
  async loopStatus(signal: AbortSignal): Promise<LoopStatus> {
    try {
      const answer = await this.ask("/api/live/status", { signal });
      this.outdated = false;
      return (await answer.json()) as LoopStatus;
    } catch (error) {
      if (isRefused(error)) this.outdated = true;
      throw error;
    }
  }

  /**
   * Asks for zero force until somebody has heard it: needs nothing that this page knows, not even the token. What else
   * waits for an answer is given up first, since a browser opens only six connections to one server.
   */
  async zeroForce(): Promise<void> {
    this.requests.giveUp();
    for (let tries = 0; ; ++tries) {
      const patience = new AbortController();
      const timer = setTimeout(() => patience.abort(), 1000);
      try {
        await this.ask("/api/live/zero", { method: "POST", keepalive: true, signal: patience.signal });
        return;
      } catch (error) {
        if (tries >= 20 || isRefused(error)) throw error instanceof ApiError ? error : silent();
        await new Promise((go) => setTimeout(go, 100));
      } finally {
        clearTimeout(timer);
      }
    }
  }

  private read<Answer>(
    path: string,
    parameters: Parameters,
    signal: AbortSignal | undefined,
    take: (answer: Response) => Promise<Answer>,
  ): Promise<Answer> {
    return this.requests.take(async (own) => take(await this.send(address(path, parameters), { signal: own })), signal);
  }

  /** All would be refused to a page that is outdated, and refusals are counted. */
  private async send(path: string, options: RequestInit): Promise<Response> {
    if (this.outdated) throw new ApiError(403, "This page is older than the studio that runs: reload it.");
    return this.ask(path, options);
  }

  private async ask(path: string, options: RequestInit): Promise<Response> {
    const headers = { ...(options.headers as Record<string, string>), "X-Kerf-Token": this.token };
    let answer: Response;
    try {
      answer = await fetch(path, { ...options, headers });
    } catch (error) {
      if (error instanceof DOMException && error.name === "AbortError") throw error;
      throw silent();
    }
    if (answer.ok) return answer;
    const text = await answer.text();
    throw new ApiError(answer.status, errorIn(text) ?? `${answer.status} ${text.trim()}`);
  }
}

function silent(): ApiError {
  return new ApiError(0, "The studio does not answer. Is 'kerf studio' still running?");
}

function address(path: string, parameters: Parameters): string {
  const parts = Object.entries(parameters).map(([name, value]) => `${name}=${String(value)}`);
  return parts.length > 0 ? `${path}?${parts.join("&")}` : path;
}

function errorIn(text: string): string | null {
  try {
    const json = JSON.parse(text) as { error?: unknown };
    return typeof json.error === "string" ? withLocalTimes(json.error) : null;
  } catch {
    return null;
  }
}

export function traceView(bytes: ArrayBuffer): TraceView {
  const [columns = 0, count = 0] = new Uint32Array(bytes, 0, 2);
  const [rowsPerColumn = 1, rowsLookedAt = 0, prepared = 1] = new Float64Array(bytes, 8, 3);
  const time = new Float64Array(bytes, 32, columns);
  const traces = [];
  for (let trace = 0, at = 32 + 8 * columns; trace < count; ++trace, at += 8 * columns) {
    traces.push({
      smallest: new Float32Array(bytes, at, columns),
      largest: new Float32Array(bytes, at + 4 * columns, columns),
    });
  }
  return { rowsPerColumn, rowsLookedAt, prepared, time, traces };
}

/** Nobody has answered, in time or at all. */
export function isSilence(error: unknown): boolean {
  return (
    (error instanceof ApiError && error.status === 0) || (error instanceof DOMException && error.name === "AbortError")
  );
}
