import { element } from "../ui/dom";
import type { View } from "../ui/view";

export const fits: View = {
  name: "fits",
  title: "Fits",
  mount(root) {
    root.append(element("h1", {}, "Fits"));
    return () => {};
  },
};
