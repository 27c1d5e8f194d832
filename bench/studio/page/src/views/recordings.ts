import "./recordings.css";

import type { Workspace } from "../api/workspace";
import { recordingList } from "../recordings/recording_list";
import { element } from "../ui/dom";
import type { View } from "../ui/view";

export const recordings: View = {
  name: "recordings",
  title: "Recordings",
  mount(root, { api, signal, complain }) {
    root.append(element("h1", {}, "Recordings"));
    api.get<Workspace>("/api/workspace", {}, signal).then(
      (workspace) => root.append(recordingList(workspace)),
      (error: unknown) => signal.aborted || complain(error),
    );
    return () => {};
  },
};
