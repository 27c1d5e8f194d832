import type { Recording } from "../api/recordings";
import { button, element } from "../ui/dom";

const shownAtOnce = 200;

/** The events of a recording; a press goes to one. */
export function eventList(recording: Recording, go: (time_s: number) => void): HTMLElement {
  const shown = recording.events.slice(0, shownAtOnce);
  const more = recording.events_in_all - shown.length;
  return element(
    "section",
    { class: "recording_events" },
    element("h2", {}, `Events (${recording.events_in_all.toLocaleString("en-GB")})`),
    element(
      "ol",
      { class: "event_list" },
      ...shown.map((it) =>
        element(
          "li",
          {},
          button(`${it.time_s.toFixed(3)} s ${it.kind}${it.text ? `: ${it.text}` : ""}`, () => go(it.time_s), {
            class: "plain",
          }),
        ),
      ),
      more > 0 ? element("li", {}, `and ${more.toLocaleString("en-GB")} more`) : null,
    ),
  );
}
