import "./recordings.css";

import { RecordingPage } from "../recording/recording_page";
import type { View } from "../ui/view";

export const recording: View = {
  name: "recording",
  title: "Recording",
  mount(root, context) {
    const page = new RecordingPage(root, context);
    return () => page.close();
  },
};
