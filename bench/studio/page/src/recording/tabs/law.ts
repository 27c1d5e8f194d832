import { element } from "../../ui/dom";
import type { RecordingTab } from "../../ui/view";
import { editorOf } from "../../views/editor";

/** A law of segments, drawn over the averaged cycle. */
export const lawTab: RecordingTab = {
  name: "law",
  title: "Law",
  mount(root, context, recording) {
    const frame = element("div", { class: "editor" });
    root.append(frame);
    return editorOf(frame, context, recording);
  },
};
