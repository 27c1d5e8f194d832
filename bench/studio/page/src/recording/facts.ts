import type { Recording } from "../api/recordings";
import type { WorkspaceRecording } from "../api/workspace";
import { statusInWords } from "../recordings/left_open";
import { length } from "../recordings/recording_list";
import { date } from "../ui/words/moments";
import { element } from "../ui/dom";
import { withUnit } from "../ui/numbers";

/** "sim:scissors · 20 s · 20,000 rows at 1 kHz", and what is the matter with it. */
export function factsInShort(recording: Recording, entry?: WorkspaceRecording): string {
  const gaps = recording.gaps_in_all;
  return [
    recording.device,
    length(recording.seconds),
    `${recording.rows.toLocaleString("en-GB")} rows`,
    statusInWords(recording.status, entry),
    gaps ? `${gaps.toLocaleString("en-GB")} gaps` : "",
  ]
    .filter(Boolean)
    .join(" · ");
}

/** What its file says of a recording, in words. */
export function factsOf(recording: Recording, entry?: WorkspaceRecording): HTMLElement {
  const fact = (name: string, text: string): HTMLElement | null =>
    text ? element("div", {}, element("dt", {}, name), element("dd", { title: text }, text)) : null;
  const gaps = recording.gaps_in_all;
  return element(
    "dl",
    { class: "facts" },
    fact("Device", recording.device),
    fact("Length", length(recording.seconds)),
    fact("Rows", `${recording.rows.toLocaleString("en-GB")}, usually every ${withUnit(recording.period_s, "s")}`),
    fact("Status", statusInWords(recording.status, entry) || recording.status),
    fact(recording.source ? "Imported" : "Recorded", date(recording.created)), // the file has no other time
    fact("Gaps", gaps === null ? "not yet known" : gaps > 0 ? gaps.toLocaleString("en-GB") : "none"),
    fact("By", recording.software),
    fact("From", recording.source),
    fact("History", recording.history),
  );
}
