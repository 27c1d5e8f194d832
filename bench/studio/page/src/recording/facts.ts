import type { Recording } from "../api/recordings";
import { date, length } from "../recordings/recording_list";
import { element } from "../ui/dom";
import { withUnit } from "../ui/numbers";

/** What its file says of a recording, in words. */
export function factsOf(recording: Recording): HTMLElement {
  const fact = (name: string, text: string): HTMLElement | null =>
    text ? element("div", {}, element("dt", {}, name), element("dd", { title: text }, text)) : null;
  const gaps = recording.gaps_in_all;
  return element(
    "dl",
    { class: "facts" },
    fact("Device", recording.device),
    fact("Length", length(recording.seconds)),
    fact("Rows", `${recording.rows.toLocaleString("en-GB")} every ${withUnit(recording.period_s, "s")}`),
    fact("Status", recording.status),
    fact("Recorded", date(recording.created)),
    fact("Gaps", gaps > 0 ? gaps.toLocaleString("en-GB") : "none"),
    fact("By", recording.software),
    fact("From", recording.source),
    fact("History", recording.history),
  );
}
