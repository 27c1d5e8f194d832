import { RecordingLoops } from "../../recordings/recording_loops";
import { element } from "../../ui/dom";
import type { RecordingTab } from "../../ui/view";
import { Overlay } from "../overlay";

/** Force against position: all cycles, one, or their average. */
export const loopTab: RecordingTab = {
  name: "loop",
  title: "Loop",
  mount(root, context, recording) {
    const loops = new RecordingLoops(context);
    const overlay = new Overlay(context, recording, () => loops.show(overlay.drawn));
    root.append(
      element(
        "div",
        { class: "recording_body" },
        element("div", { class: "recording_main" }, loops.root),
        element("aside", { class: "recording_side", "aria-label": "What is drawn" }, overlay.root),
      ),
    );
    loops.show(overlay.drawn);
    void overlay.follow();
    context.state.onChange(() => {
      loops.follow();
      void overlay.follow();
    });
    return () => loops.end();
  },
};
