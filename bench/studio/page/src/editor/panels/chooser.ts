import { element } from "../../ui/dom";
import type { Context } from "../../ui/view";

/** The recordings of the workspace, to choose one to draw over. */
export async function chooser(root: HTMLElement, context: Context): Promise<void> {
  const workspace = await context.folder();
  const items = workspace.recordings
    .filter((it) => !it.partial)
    .map((it) => element("li", {}, element("a", { href: `#/recording/${it.id}/law` }, it.name)));
  root.append(
    element("h1", {}, "Segment editor"),
    element("p", {}, "A law of straight segments is drawn over the averaged cycle of a recording. Choose one:"),
    items.length > 0
      ? element("ul", { class: "card choices" }, ...items)
      : element(
          "p",
          { class: "card quiet" },
          "The workspace has no recordings yet. The scope makes them, and so does 'kerf record'.",
        ),
  );
}
