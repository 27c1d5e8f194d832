import type { Job } from "../api/jobs";
import { element } from "../ui/dom";
import { inWords, isUnderWay, whenInWords } from "./job_words";

/** Every job that is known, newest first. A line stays the element that it is, so that the focus stays on it. */
export class JobList {
  readonly root: HTMLElement;
  private readonly list = element("ul", { class: "job_list" });
  private readonly empty = element("p", { class: "quiet" }, "Nothing was asked for yet.");
  private readonly notKept = element("p", { class: "wrong", role: "status" });
  private readonly lines = new Map<number, JobLine>();

  constructor() {
    this.root = element(
      "section",
      { class: "job_panel", "aria-label": "Jobs" },
      element("h2", {}, "Jobs"),
      this.notKept,
      this.empty,
      this.list,
    );
  }

  show(jobs: readonly Job[], current: number): void {
    const known = new Set(jobs.map((it) => it.job));
    for (const [number, line] of this.lines) {
      if (known.has(number)) continue;
      line.root.remove();
      this.lines.delete(number);
    }
    for (const [index, job] of jobs.entries()) {
      let line = this.lines.get(job.job);
      if (!line) this.lines.set(job.job, (line = new JobLine(job)));
      if (this.list.children[index] !== line.root) this.list.insertBefore(line.root, this.list.children[index] ?? null);
      line.show(job, job.job === current);
    }
    this.empty.hidden = jobs.length > 0;
    const why = jobs[0]?.not_kept ?? "";
    const text = why ? `The list will be lost with the studio: ${why}` : "";
    if (this.notKept.textContent !== text) this.notKept.textContent = text;
    this.notKept.hidden = text === "";
  }
}

class JobLine {
  readonly root: HTMLLIElement;
  private readonly link: HTMLAnchorElement;
  private readonly bar = element("progress", { max: 1 });
  private readonly state = element("span", { class: "job_state" });
  private readonly when = element("span", { class: "quiet" });

  constructor(job: Job) {
    this.link = element("a", { href: `#/work/${job.job}` }, job.title);
    this.bar.setAttribute("aria-label", job.title);
    this.root = element("li", {}, this.link, this.bar, this.state, this.when);
  }

  show(job: Job, current: boolean): void {
    showBar(this.bar, job);
    this.bar.hidden = !isUnderWay(job);
    put(this.state, inWords(job));
    put(this.when, whenInWords(job));
    this.root.className = `is_${job.state === "done" && job.outcome ? "doubtful" : job.state}`;
    if (current) this.link.setAttribute("aria-current", "page");
    else this.link.removeAttribute("aria-current");
  }
}

export function showBar(bar: HTMLProgressElement, job: Job): void {
  if (job.state === "running" && job.share < 0) bar.removeAttribute("value");
  else bar.value = job.state === "done" ? 1 : Math.max(0, job.share);
}

export function put(node: HTMLElement, text: string): void {
  if (node.textContent !== text) node.textContent = text;
}
