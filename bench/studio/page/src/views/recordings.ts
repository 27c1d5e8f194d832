import "./recordings.css";

import { RecordingList } from "../recordings/recording_list";
import { element } from "../ui/dom";
import type { View } from "../ui/view";

export const recordings: View = {
  name: "recordings",
  title: "Recordings",
  mount(root, { onFolder }) {
    const list = new RecordingList();
    root.append(element("h1", {}, "Recordings"), list.root);
    onFolder((workspace) => list.show(workspace));
    return () => {};
  },
};
