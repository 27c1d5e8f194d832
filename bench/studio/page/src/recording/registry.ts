import type { RecordingTab } from "../ui/view";
import { chartTab } from "./tabs/chart";
import { cyclesTab } from "./tabs/cycles";
import { fitsTab } from "./tabs/fits";
import { lawTab } from "./tabs/law";
import { loopTab } from "./tabs/loop";
import { reportTab } from "./tabs/report";
import { timeTab } from "./tabs/time";

/** The tabs of a recording, in their order: a new one is a line here. */
export const recordingTabs: readonly RecordingTab[] = [
  timeTab,
  loopTab,
  cyclesTab,
  lawTab,
  fitsTab,
  chartTab,
  reportTab,
];
