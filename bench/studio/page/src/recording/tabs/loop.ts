import { RecordingLoops } from "../../recordings/recording_loops";
import type { RecordingTab } from "../../ui/view";
import { Overlay } from "../overlay";

/** Force against position: all cycles, one, or their average. */
export const loopTab: RecordingTab = {
  name: "loop",
  title: "Loop",
  mount(root, context, recording) {
    const loops = new RecordingLoops(context);
    const overlay = new Overlay(context, recording, () => loops.show(overlay.drawn));
    loops.tools.lastElementChild?.before(overlay.popover.root);
    root.append(loops.root);
    loops.show(overlay.drawn);
    void overlay.follow();
    context.state.onChange(() => {
      loops.follow();
      void overlay.follow();
    });
    return () => loops.end();
  },
};
