import "./results.css";

import type { WorkspaceFile } from "../api/workspace";
import { byName, resultName } from "../results/names";
import { resultList } from "../results/result_list";
import { leadToTab } from "../results/of_recording/old_address";
import { openResult, type OpenedResult } from "../results/opened_result";
import { element } from "../ui/dom";
import type { View } from "../ui/view";

// Addresses of earlier versions: with the id of a recording, or of a result of one, they lead to its tab. A result
// whose recording is not in the folder is shown by itself.

function viewOf(name: "fits" | "chart", title: string, kinds: readonly WorkspaceFile["kind"][]): View {
  return {
    name,
    title,
    mount(root, context) {
      const head = element("h1", {}, title);
      root.append(head);
      let opened: OpenedResult | null = null;
      const show = async (): Promise<void> => {
        const { place, signal } = context;
        const { id } = place;
        const workspace = await context.folder();
        const files = workspace.files.filter((it) => kinds.includes(it.kind)).sort(byName);
        if (id && leadToTab(context, workspace, name, files)) return;
        const file = files.find((it) => it.id === id);
        if (!file) {
          if (id) context.say("That result is not in this folder any more.");
          root.append(
            resultList(
              `${title} in this folder`,
              name,
              files,
              "There is none yet: open a recording, and order one in its tab.",
            ),
          );
          return;
        }
        const open = await openResult(context, workspace, file, needsARecording, signal);
        head.textContent = resultName(file);
        opened = open();
        root.append(opened.root);
      };
      const needsARecording = (): void =>
        context.complain(new Error("Its recording is not in this folder: open one, and order it in its tab."));
      show().catch((error: unknown) => {
        if (!context.signal.aborted) context.complain(error);
      });
      return () => opened?.end();
    },
  };
}

export const fits = viewOf("fits", "Fits", ["fit"]);
export const chart = viewOf("chart", "Charts and choices", ["chart", "choice"]);
