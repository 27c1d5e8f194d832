import { element } from "../ui/dom";
import type { View } from "../ui/view";

export const stability: View = {
  name: "stability",
  title: "Stability",
  mount(root) {
    root.append(element("h1", {}, "Stability"));
    return () => {};
  },
};
