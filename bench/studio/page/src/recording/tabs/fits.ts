import "../../views/results.css";

import { fitsOf } from "../../results/of_recording/fits";
import type { RecordingTab } from "../../ui/view";

/** Laws fitted to the recording: the newest fit, those before it, and a new one. */
export const fitsTab: RecordingTab = {
  name: "fits",
  title: "Fits",
  mount(root, context, recording) {
    const fits = fitsOf(context, recording);
    root.append(fits.root);
    return () => fits.end();
  },
};
