import "./sweeps.css";

import type { Sweep } from "../api/sweeps";
import type { Workspace } from "../api/workspace";
import { AtlasPage } from "../atlas/atlas_page";
import { element } from "../ui/dom";
import type { View } from "../ui/view";

/** "walls" of "lab/walls.merged/sweep.h5". */
function sweepName(file: string): string {
  return file.replace(/\/?sweep\.h5$/, "").replace(/\.merged$/, "") || file;
}

function listOf(workspace: Workspace): HTMLElement {
  const files = workspace.files.filter((it) => it.kind === "sweep");
  if (files.length === 0)
    return element(
      "p",
      {},
      "There is no merged sweep in this folder: ",
      element("code", {}, "kerf sweep merge"),
      " makes one.",
    );
  return element(
    "ul",
    { class: "links" },
    ...files.map((it) => element("li", {}, element("a", { href: `#/sweeps/${it.id}` }, sweepName(it.name)))),
  );
}

export const sweeps: View = {
  name: "sweeps",
  title: "Sweeps",
  mount(root, context) {
    const title = element("h1", {}, "Sweeps");
    root.append(title);
    let page: AtlasPage | null = null;
    const show = async (): Promise<void> => {
      const { id } = context.place;
      const workspace = await context.folder();
      const file = workspace.files.find((it) => it.id === id && it.kind === "sweep");
      if (!file) {
        if (id) context.say("That sweep is not in this folder any more.");
        root.append(listOf(workspace));
        return;
      }
      const sweep = await context.api.get<Sweep>("/api/sweep", { id }, context.signal);
      if (context.signal.aborted) return;
      title.textContent = `Sweep ${sweepName(file.name)}`;
      page = new AtlasPage(context, id, sweep);
      root.append(page.root);
    };
    show().catch(context.complain);
    return () => page?.end();
  },
};
