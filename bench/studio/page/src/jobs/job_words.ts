import type { Job } from "../api/jobs";
import { length } from "../recordings/recording_list";
import { date } from "../ui/words/moments";
import { inPageWords } from "./value_field";

// What a job is said to be, wherever it is shown.

export function isUnderWay(job: Job): boolean {
  return job.state === "waiting" || job.state === "running";
}

export function inWords(job: Job): string {
  switch (job.state) {
    case "waiting":
      return "waits for its turn";
    case "running":
      if (job.stopping) return "is being stopped";
      return job.share >= 0 ? `${Math.round(100 * job.share)} %` : "at work";
    case "done":
      return job.outcome || "done";
    case "stopped":
      return "stopped";
    case "interrupted":
      return "interrupted: the studio ended before it was done";
    case "failed":
      return `failed: ${inPageWords(job.error)}`;
  }
}

/** How long it took; what the clock says is no help where somebody has set it. */
export function whenInWords(job: Job): string {
  const took = job.seconds > 0 ? `, ${length(job.seconds)}` : "";
  const set =
    job.clock_set_s !== 0
      ? `; the machine's clock was set ${job.clock_set_s > 0 ? "forward" : "back"} by ${length(Math.abs(job.clock_set_s))} meanwhile`
      : "";
  return `${date(job.created)}${took}${set}`;
}

const views: Partial<Record<Job["kind"], string>> = {
  fit: "fits",
  chart: "chart",
  choice: "chart",
  stability: "stability",
};

/** Where what it has found is seen. */
export function resultAddress(job: Job): string {
  const view = views[job.kind];
  return view && job.file ? `#/${view}/${job.file}` : `#/work/${job.job}`;
}
