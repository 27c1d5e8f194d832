import "../../cycles/cycles.css";

import { CyclesTab } from "../../cycles/cycles_tab";
import type { RecordingTab } from "../../ui/view";

/** Cycles found by other settings, mended and kept; below, what the recording is worth. */
export const cyclesTab: RecordingTab = {
  name: "cycles",
  title: "Cycles",
  mount(root, context, recording) {
    const tab = new CyclesTab(root, context, recording);
    return () => tab.end();
  },
};
