import { ApiError, type Api } from "../api/api";

const smallestPiece = 1 << 14;
const soon_ms = 500;

/** What a file on its way is told to whoever shows it. */
export interface Sending {
  have: number;
  bytes: number;
  waits: string; // why nothing comes at the moment; empty if it does
}

const pause = (ms: number, signal: AbortSignal): Promise<void> =>
  new Promise((go) => {
    const timer = setTimeout(go, ms);
    signal.addEventListener("abort", () => {
      clearTimeout(timer);
      go();
    });
  });

/**
 * Hands a file over in pieces, each as large as the way to the studio lets through in half a second. What the studio has
 * it keeps: whatever breaks off, the next piece begins there. Memory holds one piece.
 */
export class Uploader {
  private size: number;

  constructor(
    private readonly api: Api,
    private readonly largestPiece: number,
  ) {
    this.size = largestPiece;
  }

  /** The id of the upload, once all of it has come. */
  async send(file: File, tell: (now: Sending) => void, signal: AbortSignal): Promise<string> {
    const about = { name: file.name, bytes: file.size, modified: file.lastModified };
    const begin = (): Promise<{ upload: string; have: number }> =>
      this.patiently(() => this.api.post("/api/import/begin", about), file, -1, tell, signal);
    let { upload, have } = await begin();
    while (have < file.size) {
      signal.throwIfAborted();
      const from = have;
      const bytes = await this.read(file, from);
      tell({ have, bytes: file.size, waits: "" });
      try {
        ({ have } = await this.patiently(() => this.sendPiece(upload, from, bytes, signal), file, from, tell, signal));
      } catch (error) {
        if (!(error instanceof ApiError) || error.status !== 409) throw error;
        ({ upload, have } = await begin()); // another tab sends it too, or an answer was lost
      }
    }
    tell({ have, bytes: file.size, waits: "" });
    return upload;
  }

  private async read(file: File, from: number): Promise<ArrayBuffer> {
    try {
      return await file.slice(from, from + this.size).arrayBuffer();
    } catch {
      throw new Error(
        `${file.name}: the browser cannot read it: a folder, a file without the right to read it, or one that has moved`,
      );
    }
  }

  private async sendPiece(
    upload: string,
    at: number,
    bytes: ArrayBuffer,
    signal: AbortSignal,
  ): Promise<{ have: number }> {
    const begun = performance.now();
    const answer = await this.api.postBytes<{ have: number }>("/api/import/piece", { upload, at }, bytes, signal);
    const took = performance.now() - begun;
    if (took < soon_ms) this.size = Math.min(this.largestPiece, 2 * this.size);
    else if (took > 4 * soon_ms) this.size = Math.max(smallestPiece, this.size / 2);
    return answer;
  }

  /** Again and again while the studio is silent or has too much to do; what it refuses is final. */
  private async patiently<Answer>(
    ask: () => Promise<Answer>,
    file: File,
    have: number,
    tell: (now: Sending) => void,
    signal: AbortSignal,
  ): Promise<Answer> {
    for (let tries = 0; ; ++tries) {
      signal.throwIfAborted();
      try {
        return await ask();
      } catch (error) {
        const passes = error instanceof ApiError && [0, 408, 503, 504].includes(error.status);
        if (!passes) throw error;
        this.size = Math.max(smallestPiece, this.size / 2);
        tell({ have: Math.max(0, have), bytes: file.size, waits: "the studio does not answer; it goes on by itself" });
        await pause(Math.min(5000, 250 * 2 ** tries), signal);
      }
    }
  }
}
