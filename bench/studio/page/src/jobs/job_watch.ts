import type { Api } from "../api/api";
import type { Job } from "../api/jobs";
import { isUnderWay } from "./job_words";

const busy_ms = 500;
const idle_ms = 2000;

/** Asks for the jobs again and again until the page goes: more often while one is under way. */
export class JobWatch {
  private timer = 0;
  private asking = false;

  constructor(
    private readonly api: Api,
    private readonly signal: AbortSignal,
    private readonly told: (jobs: Job[]) => void,
  ) {
    signal.addEventListener("abort", () => clearTimeout(this.timer));
    void this.look();
  }

  /** Now, as after an order. */
  async look(): Promise<void> {
    if (this.asking || this.isOver()) return;
    this.asking = true;
    clearTimeout(this.timer);
    let busy = false;
    try {
      const jobs = await this.api.get<Job[]>("/api/jobs", {}, this.signal);
      busy = jobs.some(isUnderWay);
      if (!this.isOver()) this.told(jobs);
    } catch {
      // the bar says that the studio does not answer
    }
    this.asking = false;
    if (!this.isOver()) this.timer = window.setTimeout(() => void this.look(), busy ? busy_ms : idle_ms);
  }

  private isOver(): boolean {
    return this.signal.aborted;
  }
}
