import type { Job, MadeFile } from "../api/jobs";
import { button, element } from "../ui/dom";
import type { Context } from "../ui/view";
import { put, showBar } from "./job_list";
import { jobResult } from "./job_result";
import { inWords, isUnderWay, resultAddress, whenInWords } from "./job_words";

/** One job: how far it is, what it says, what it has made; stopped, asked for again, forgotten. */
export class JobPage {
  readonly root: HTMLElement;
  private job: Job | null = null;
  private loaded = ""; // the state that log and result are of
  private readonly title = element("h2", {});
  private readonly bar = element("progress", { max: 1 });
  private readonly state = element("p", { class: "job_state", role: "status" });
  private readonly when = element("p", { class: "quiet" });
  private readonly stop = button("Stop", () => this.act("/api/jobs/stop"));
  private readonly again = button("Run again", () => this.runAgain());
  private readonly forget = button("Forget", () => this.forgetIt());
  private readonly link = element("a", { class: "go" }, "Open the result");
  private readonly result = element("div", {});
  private readonly log = element("pre", { class: "job_log", tabindex: 0, role: "region", "aria-label": "Log" });

  constructor(
    private readonly context: Context,
    private readonly number: number,
    private readonly changed: () => void,
  ) {
    this.root = element(
      "section",
      { class: "job_page", "aria-label": `Job ${number}` },
      this.title,
      this.bar,
      this.state,
      this.when,
      element("div", { class: "row" }, this.link, this.stop, this.again, this.forget),
      this.result,
      element("h3", {}, "Log"),
      this.log,
    );
    this.root.hidden = true;
  }

  show(jobs: readonly Job[]): void {
    const job = jobs.find((it) => it.job === this.number);
    if (!job) {
      if (this.job === null) this.context.say(`Job ${this.number} is not known any more.`);
      return;
    }
    this.job = job;
    this.root.hidden = false;
    this.root.dataset.state = job.state;
    put(this.title, job.title);
    this.bar.setAttribute("aria-label", job.title);
    showBar(this.bar, job);
    this.bar.hidden = !isUnderWay(job);
    put(this.state, inWords(job));
    this.state.classList.toggle("wrong", job.state === "failed" || job.state === "interrupted" || job.outcome !== "");
    put(this.when, whenInWords(job));
    this.stop.hidden = !isUnderWay(job);
    this.stop.disabled = job.stopping;
    this.again.hidden = isUnderWay(job) || job.again.path === "";
    this.forget.hidden = isUnderWay(job);
    const address = resultAddress(job);
    this.link.hidden = job.state !== "done" || address === `#/work/${job.job}`;
    this.link.href = address;
    void this.load(job);
  }

  private async load(job: Job): Promise<void> {
    const { api, signal } = this.context;
    if (this.loaded === job.state && job.state !== "running") return;
    const first = this.loaded !== job.state;
    this.loaded = job.state;
    try {
      const { text } = await api.get<{ text: string }>("/api/jobs/log", { job: job.job }, signal);
      put(this.log, text || "It has said nothing.");
      if (!first || isUnderWay(job)) return;
      const { files } = await api.get<{ files: MadeFile[] }>("/api/jobs/result", { job: job.job }, signal);
      if (files.length > 0) this.context.lookAtFolder();
      this.result.replaceChildren(jobResult(api, job.job, files, signal));
    } catch (error) {
      if (!signal.aborted) this.context.complain(error);
    }
  }

  private act(path: string): void {
    this.context.api.post(path, { job: this.number }).then(() => this.changed(), this.context.complain);
  }

  private runAgain(): void {
    if (!this.job) return;
    const { path, body } = this.job.again;
    this.context.api
      .post<{ job: number }>(path, body)
      .then(({ job }) => this.context.go("work", String(job)), this.context.complain);
  }

  private forgetIt(): void {
    this.context.api
      .post("/api/jobs/forget", { job: this.number })
      .then(() => this.context.go("work"), this.context.complain);
  }
}
