import "../../views/results.css";

import { chartsOf } from "../../results/of_recording/charts";
import type { RecordingTab } from "../../ui/view";

/** Cost against error of every law and size, and the simplest that serves. */
export const chartTab: RecordingTab = {
  name: "chart",
  title: "Chart",
  mount(root, context, recording) {
    const charts = chartsOf(context, recording);
    root.append(charts.root);
    return () => charts.end();
  },
};
