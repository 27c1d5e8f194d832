import type { Api, LoopStatus } from "../api";

/** What the loop does, in three words, on every page. */
export function inWords(status: LoopStatus): string {
  if (status.session) return "Session running";
  if (status.starting) return "Opening the device";
  if (!status.running) return status.ended ? "Loop ended" : "Loop not running";
  if (status.released) return "Zero force";
  return status.law ? `Rendering ${status.law.replace(/\.law\.toml$/, "")}` : "Running free";
}

const patience_ms = 2500;

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
  let asking: AbortController | null = null;
  let unheard = 0; // requests for zero force that nobody has answered yet

  const say = (text: string, state: string): void => {
    if (words.textContent !== text) words.textContent = text; // it is read out when it changes
    words.dataset.state = state;
  };

  const look = async (): Promise<void> => {
    if (unheard > 0) return;
    asking?.abort();
    const asked = (asking = new AbortController());
    const timer = setTimeout(() => asked.abort(), patience_ms);
    try {
      const status = await api.get<LoopStatus>("/api/live/status", {}, asked.signal);
      if (unheard > 0) return;
      const recording = status.recording ? ", recording" : "";
      say(inWords(status) + recording, status.released ? "released" : status.running ? "running" : "idle");
    } catch {
      if (unheard === 0 && asking === asked) say("No answer from the studio", "lost");
    } finally {
      clearTimeout(timer);
      if (asking === asked) asking = null;
    }
  };

  const release = (): void => {
    zero.classList.add("pressed");
    ++unheard;
    say("Zero force asked for", "unheard");
    api
      .zeroForce()
      .catch((error: unknown) => {
        say("Zero force was not heard: press again, or let go and switch the device off", "unheard");
        complain(error);
      })
      .finally(() => {
        if (--unheard > 0) return;
        zero.classList.remove("pressed");
        if (words.textContent === "Zero force asked for") void look();
      });
  };

  // As soon as it is pressed, not when it is let go; a keyboard presses it by click.
  zero.addEventListener("pointerdown", release);
  zero.addEventListener("click", (event) => {
    if (event.detail === 0) release();
  });
  zero.title = "Escape, from anywhere";
  // Before any page or dialog can keep the key for itself.
  addEventListener("keydown", (event) => event.key === "Escape" && !event.repeat && release(), { capture: true });
  void look();
  setInterval(() => {
    if (!asking) void look();
  }, 1000);
}
