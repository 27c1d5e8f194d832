import { element } from "../../ui/dom";
import type { RecordingTab } from "../../ui/view";
import { factsOf } from "../facts";

/** What is known of the recording. */
export const reportTab: RecordingTab = {
  name: "report",
  title: "Report",
  mount(root, _context, recording) {
    root.append(
      element("div", { class: "scrolling" }, element("h2", {}, "About the recording"), factsOf(recording.about)),
    );
    return () => {};
  },
};
