import { InspectionPanel } from "../../recordings/inspection_panel";
import { element } from "../../ui/dom";
import type { RecordingTab } from "../../ui/view";
import { stateKeys } from "../keys";

/** Each cycle with its numbers and flags, and what the recording is worth. */
export const cyclesTab: RecordingTab = {
  name: "cycles",
  title: "Cycles",
  mount(root, context, recording) {
    const worth = new InspectionPanel((from_s, to_s) =>
      context.go("recording", recording.id, "time", {
        [stateKeys.from]: String(from_s - 1),
        [stateKeys.to]: String(to_s + 1),
      }),
    );
    root.append(element("div", { class: "scrolling" }, worth.root));
    recording.inspection().then(
      (found) => context.signal.aborted || worth.show(found),
      (error: unknown) => context.signal.aborted || worth.fail(error),
    );
    return () => {};
  },
};
