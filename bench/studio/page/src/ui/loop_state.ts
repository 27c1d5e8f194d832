import type { Api, LoopStatus } from "../api";

/** What the loop does, in three words, on every page. */
export function inWords(status: LoopStatus): string {
  if (status.session) return "Session running";
  if (!status.running) return status.ended ? "Loop ended" : "Loop not running";
  if (status.released) return "Zero force";
  return status.law ? `Rendering ${status.law}` : "Running free";
}

/**
 * Keeps the state of the loop in the bar, and the button for zero force at work: on a click, and by Escape from
 * anywhere. It needs nothing that this page knows, so that it works when the page is stale.
 */
export function loopState(
  api: Api,
  words: HTMLElement,
  zero: HTMLButtonElement,
  complain: (error: unknown) => void,
): void {
  const look = async (): Promise<void> => {
    try {
      const status = await api.get<LoopStatus>("/api/live/status");
      words.textContent = inWords(status) + (status.recording ? `, recording ${status.recording.name}` : "");
      words.dataset["state"] = status.released ? "released" : status.running ? "running" : "idle";
    } catch {
      words.textContent = "No answer from the studio";
      words.dataset["state"] = "lost";
    }
  };
  const release = (): void => {
    zero.classList.add("pressed");
    api.zeroForce().then(look, complain).finally(() => zero.classList.remove("pressed"));
  };
  // As soon as it is pressed, not when it is let go; a keyboard presses it by click.
  zero.addEventListener("pointerdown", release);
  zero.addEventListener("click", (event) => {
    if (event.detail === 0) release();
  });
  zero.title = "Escape, from anywhere";
  addEventListener("keydown", (event) => {
    if (event.key === "Escape" && !document.querySelector("dialog[open]")) release();
  });
  void look();
  setInterval(() => void look(), 1000);
}
