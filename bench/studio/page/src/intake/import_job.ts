import { element, button } from "../ui/dom";
import type { Context } from "../ui/view";

const every_ms = 400;

interface JobState {
  job: number;
  state: string;
  share: number;
  error: string;
  title: string;
}

/** An import under way: how far it is, and a way to stop it. */
export class ImportJob {
  readonly root: HTMLElement;
  private readonly bar = element("progress", { max: 1, "aria-label": "The import" });
  private readonly words = element("span", { role: "status" });
  private job = 0;
  private timer = 0;

  constructor(
    private readonly context: Context,
    private readonly ended: (state: string, error: string) => void,
  ) {
    const stop = button("Stop", () => {
      context.api.post("/api/jobs/stop", { job: this.job }).catch((error: unknown) => context.complain(error));
    });
    this.root = element("div", { class: "import_job", hidden: true }, this.bar, this.words, stop);
    context.signal.addEventListener("abort", () => clearTimeout(this.timer));
  }

  get isUnderWay(): boolean {
    return this.job !== 0;
  }

  watch(job: number): void {
    this.job = job;
    this.root.hidden = false;
    this.words.textContent = "The import begins …";
    void this.look();
  }

  private async look(): Promise<void> {
    const { context } = this;
    try {
      const jobs = await context.api.get<JobState[]>("/api/jobs", {}, context.signal);
      const own = jobs.find((it) => it.job === this.job);
      if (own?.state === "waiting" || own?.state === "running") this.show(own);
      else return this.end(own?.state ?? "interrupted", own?.error ?? "");
    } catch {
      if (context.signal.aborted) return; // else the bar says that the studio does not answer, and it is asked again
    }
    this.timer = window.setTimeout(() => void this.look(), every_ms);
  }

  private show(own: JobState): void {
    if (own.state === "running" && own.share >= 0) this.bar.value = own.share;
    else this.bar.removeAttribute("value");
    this.words.textContent =
      own.state === "waiting"
        ? `${own.title}: waits for its turn`
        : `${own.title}: ${Math.max(0, Math.round(100 * own.share))} %`;
  }

  private end(state: string, error: string): void {
    this.job = 0;
    this.root.hidden = true;
    this.ended(state, error);
  }
}
