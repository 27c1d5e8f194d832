/** One line for the person at the page. It has a row of its own below the page, so that it covers nothing of it. */
export class Notice {
  private readonly strip = byId("notice_strip");
  private readonly line = byId("notice");

  constructor() {
    byId("notice_close").addEventListener("click", () => this.put("", false));
  }

  say(text: string): void {
    this.put(text, false);
  }

  complain(error: unknown): void {
    if (error instanceof DOMException && error.name === "AbortError") return;
    this.put(error instanceof Error ? error.message : String(error), true);
  }

  private put(text: string, isWrong: boolean): void {
    this.strip.hidden = text === "";
    this.line.textContent = text;
    this.line.classList.toggle("wrong", isWrong);
  }
}

export function byId(id: string): HTMLElement {
  const node = document.getElementById(id);
  if (!node) throw new Error(`no element ${id}`);
  return node;
}
