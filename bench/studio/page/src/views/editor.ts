import { element } from "../ui/dom";
import type { View } from "../ui/view";

export const editor: View = {
  name: "editor",
  title: "Segment editor",
  mount(root) {
    root.append(element("h1", {}, "Segment editor"));
    return () => {};
  },
};
