import type { SessionQuality } from "../api/sessions";
import { plain } from "../ui/numbers";

/** One thing that is told of a session's trials. */
export interface QualityRow {
  head: string; // with its unit
  text: (quality: SessionQuality) => string;
}

const reasons: Record<string, string> = {
  fault: "fault",
  "soft-start": "soft start",
  "limited-ticks": "limited ticks",
  "missed-deadlines": "missed deadlines",
  unexplored: "not felt as asked",
  slipped: "taken back",
};

function whyVoid(quality: SessionQuality): string {
  const found = Object.entries(quality.reasons)
    .filter(([, count]) => count > 0)
    .map(([reason, count]) => `${reasons[reason] ?? reason} ${count}`);
  return found.length > 0 ? `${quality.void} (${found.join(", ")})` : String(quality.void);
}

function seconds(value: number | null): string {
  return value === null ? "–" : value.toFixed(1);
}

/** In the order in which an experimenter asks: is it going on, does it count, was it felt, was the loop sound? */
export const qualityRows: readonly QualityRow[] = [
  { head: "Trials answered", text: (it) => `${it.given}${it.practice > 0 ? ` (${it.practice} practice)` : ""}` },
  { head: "Trials that count", text: (it) => String(it.counted) },
  { head: "Void trials", text: (it) => `${whyVoid(it)}${it.left_out > 0 ? `, ${it.left_out} left out` : ""}` },
  { head: "Trials not felt in every slot", text: (it) => String(it.unfelt) },
  {
    head: "In contact [% of playing time]",
    text: (it) => (it.contact_share === null ? "–" : plain(100 * it.contact_share, 2)),
  },
  { head: "Trials with a fault", text: (it) => String(it.faulty) },
  { head: "Missed deadlines [ticks]", text: (it) => String(it.late_ticks) },
  { head: "At the device's limits [ticks]", text: (it) => String(it.limited_ticks) },
  { head: "Response time, median [s]", text: (it) => seconds(it.median_response_s) },
  { head: "Response time, longest [s]", text: (it) => seconds(it.slowest_response_s) },
  {
    head: "Catch trials right",
    text: (it) => (it.catch === null ? "–" : `${it.catch.right} of ${it.catch.trials}`),
  },
];
