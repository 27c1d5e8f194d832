import type { Job } from "../api/jobs";
import { inWords, resultAddress } from "../jobs/job_words";
import { button, element } from "../ui/dom";
import type { Context } from "../ui/view";

const every_ms = 500;

/** One job: its title, how far it is, and a button to stop it. Rebuilt by nobody, so that focus stays. */
class JobLine {
  readonly root: HTMLLIElement;
  private readonly bar = element("progress", { max: 1 });
  private readonly words = element("span", { class: "state" });
  private readonly stop: HTMLButtonElement;

  constructor(job: Job, stop: () => void) {
    this.stop = button("Stop", stop, { "aria-label": `Stop: ${job.title}` });
    this.bar.setAttribute("aria-label", job.title);
    this.root = element("li", {}, element("span", { class: "title" }, job.title), this.bar, this.words, this.stop);
  }

  show(job: Job): void {
    const ended = job.state !== "waiting" && job.state !== "running";
    if (job.state === "running" && job.share < 0) this.bar.removeAttribute("value");
    else this.bar.value = job.state === "done" ? 1 : Math.max(0, job.share);
    if (job.state === "done" && job.file) {
      if (!this.words.querySelector("a"))
        this.words.replaceChildren(element("a", { href: resultAddress(job) }, "Open the result"));
    } else {
      this.words.textContent = inWords(job);
    }
    this.words.classList.toggle("wrong", job.state === "failed");
    this.stop.disabled = ended;
  }
}

/** The jobs that a page ordered or that are under way, with their progress. */
export class JobList {
  readonly root: HTMLElement;
  private readonly list = element("ul", { class: "jobs", "aria-label": "Work under way" });
  private readonly empty = element("p", { class: "quiet" }, "No work is under way.");
  private readonly lines = new Map<number, JobLine>();
  private readonly awaited = new Map<number, (file: string) => void>();
  private readonly timer: number;
  private ended = false;

  constructor(
    private readonly context: Context,
    private readonly kinds: readonly Job["kind"][],
  ) {
    this.root = element("section", { class: "card work", "aria-label": "Work" }, this.empty, this.list);
    this.timer = window.setInterval(() => void this.look(), every_ms);
    void this.look();
  }

  end(): void {
    this.ended = true;
    clearInterval(this.timer);
  }

  /** Orders a job; `done` is given the id of its result. */
  async order(path: string, body: unknown, done: (file: string) => void): Promise<void> {
    try {
      const { job } = await this.context.api.post<{ job: number }>(path, body);
      this.awaited.set(job, done);
      await this.look();
    } catch (error) {
      this.context.complain(error);
    }
  }

  private async look(): Promise<void> {
    let jobs: Job[];
    try {
      jobs = await this.context.api.get<Job[]>("/api/jobs");
    } catch {
      return; // the bar says that the studio does not answer
    }
    if (this.ended) return;
    for (const job of jobs) {
      if (!this.kinds.includes(job.kind)) continue;
      const under_way = job.state === "waiting" || job.state === "running";
      if (under_way || this.awaited.has(job.job)) this.line(job);
      this.lines.get(job.job)?.show(job);
      if (!under_way) this.finish(job);
    }
    this.empty.hidden = this.lines.size > 0;
  }

  private line(job: Job): void {
    if (this.lines.has(job.job)) return;
    const line = new JobLine(job, () => {
      this.context.api.post("/api/jobs/stop", { job: job.job }).then(() => this.look(), this.context.complain);
    });
    this.lines.set(job.job, line);
    this.list.prepend(line.root);
  }

  private finish(job: Job): void {
    const done = this.awaited.get(job.job);
    if (!done) return;
    this.awaited.delete(job.job);
    if (job.state === "done") done(job.file);
    else if (job.state === "failed") this.context.complain(new Error(`${job.title}: ${job.error}`));
  }
}
