import type { WorkspaceFile } from "../api/workspace";
import { element } from "../ui/dom";
import { resultName } from "./names";

/** The results of the folder that a page shows one of, or how one comes about. */
export function resultList(title: string, view: string, files: readonly WorkspaceFile[], none: string): HTMLElement {
  const links = files.map((it) => element("li", {}, element("a", { href: `#/${view}/${it.id}` }, resultName(it))));
  return element(
    "section",
    { class: "card", "aria-label": title },
    element("h2", {}, title),
    links.length > 0 ? element("ul", { class: "links" }, ...links) : element("p", { class: "quiet" }, none),
  );
}
