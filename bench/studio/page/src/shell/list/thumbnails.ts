import type { Api } from "../../api/api";
import type { Thumbnail } from "../../api/workspace";
import { element } from "../../ui/dom";
import { onColours } from "../../ui/palette";
import type { Entry } from "./entries";

export const width = 64;
export const height = 28;
const mostKept = 600;

/** Small pictures of recordings, asked for when they come into sight and kept while the page is there. */
export class Thumbnails {
  private readonly kept = new Map<string, Thumbnail | null>(); // null: there is none
  private readonly wanted = new Map<
    string,
    { entry: Entry; canvas: HTMLCanvasElement; told: (it: Thumbnail) => void }
  >();
  private readonly drawn = new Map<HTMLCanvasElement, Thumbnail>();
  private busy = false;

  constructor(private readonly api: Api) {
    onColours(() => {
      for (const [canvas, picture] of this.drawn) draw(canvas, picture);
    });
  }

  /** A canvas that gets its picture when it is there; `told` when it is. */
  of(entry: Entry, told: (it: Thumbnail) => void): HTMLCanvasElement {
    const canvas = element("canvas", { class: "thumbnail", "aria-hidden": "true" });
    const known = this.kept.get(keyOf(entry));
    if (known) this.put(canvas, known, told);
    else if (known === undefined) {
      this.wanted.set(keyOf(entry), { entry, canvas, told });
      void this.work();
    }
    return canvas;
  }

  private put(canvas: HTMLCanvasElement, picture: Thumbnail, told: (it: Thumbnail) => void): void {
    this.drawn.set(canvas, picture);
    requestAnimationFrame(() => {
      for (const it of [...this.drawn.keys()]) if (!it.isConnected) this.drawn.delete(it);
      draw(canvas, picture);
    });
    told(picture);
  }

  /** One at a time, so that what a person asks for is not behind them; those that went out of sight are not asked for. */
  private async work(): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    await new Promise((go) => setTimeout(go, 30)); // until the rows are in the page
    for (const [key, { entry, canvas, told }] of this.wanted) {
      this.wanted.delete(key);
      if (!canvas.isConnected) continue;
      const picture = await this.fetch(entry);
      this.kept.set(key, picture);
      for (const oldest of this.kept.keys()) {
        if (this.kept.size <= mostKept) break;
        this.kept.delete(oldest);
      }
      if (picture) this.put(canvas, picture, told);
    }
    this.busy = false;
  }

  private async fetch(entry: Entry): Promise<Thumbnail | null> {
    if (entry.marks.includes("unreadable")) return null;
    try {
      return await this.api.get<Thumbnail | null>("/api/recording/thumbnail", { id: entry.id });
    } catch {
      return null; // the bar says that the studio does not answer
    }
  }
}

function keyOf(entry: Entry): string {
  return `${entry.id} ${entry.modified} ${entry.bytes}`;
}

/** The extremes of each column, from the smallest to the largest of all. */
function draw(canvas: HTMLCanvasElement, { low, high }: Thumbnail): void {
  const scale = Math.max(1, Math.round(devicePixelRatio));
  canvas.width = width * scale;
  canvas.height = height * scale;
  const pen = canvas.getContext("2d");
  if (!pen || low.length === 0) return;
  pen.fillStyle = getComputedStyle(canvas).color;
  const step = canvas.width / low.length;
  const y = (value: number): number => (1 - value / 100) * (canvas.height - 2 * scale) + scale;
  low.forEach((own, k) => {
    if (own < 0) return; // nothing is known there
    // Columns meet, as the rows between them do.
    const before = high[k - 1] ?? own;
    const bottom = before < 0 ? own : Math.min(own, before);
    const top = Math.max(high[k] ?? own, low[k - 1] ?? own);
    pen.fillRect(
      Math.floor(k * step),
      y(top) - scale / 2,
      Math.ceil(step),
      Math.max(scale, y(bottom) - y(top) + scale),
    );
  });
}
