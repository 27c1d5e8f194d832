import "./recordings.css";

import type { Recording } from "../api/recordings";
import type { Workspace } from "../api/workspace";
import { element } from "../ui/dom";
import type { Context, View } from "../ui/view";
import { recordingList } from "../recordings/recording_list";
import { recordingPage } from "../recordings/recording_page";

export const recordings: View = {
  name: "recordings",
  title: "Recordings",
  mount(root, context) {
    const gone = new AbortController();
    let end: () => void = () => {};
    const waiting = element("h1", {}, "Recordings");
    root.append(waiting);
    load(context, gone.signal).then(
      ([workspace, recording]) => {
        if (gone.signal.aborted) return;
        if (!recording) return root.append(recordingList(workspace));
        const hadFocus = document.activeElement === waiting;
        waiting.remove();
        end = recordingPage(context, root, recording, workspace);
        if (hadFocus) context.focusHead();
      },
      (error: unknown) => gone.signal.aborted || context.complain(error),
    );
    return () => {
      gone.abort();
      end();
    };
  },
};

function load({ api, place }: Context, signal: AbortSignal): Promise<[Workspace, Recording | null]> {
  return Promise.all([
    api.get<Workspace>("/api/workspace", {}, signal),
    place.id ? api.get<Recording>("/api/recording", { id: place.id }, signal) : null,
  ]);
}
