import { element } from "../ui/dom";
import type { View } from "../ui/view";

export const scope: View = {
  name: "scope",
  title: "Scope",
  mount(root) {
    root.append(element("h1", {}, "Scope"));
    return () => {};
  },
};
