import { element } from "../ui/dom";
import type { View } from "../ui/view";

export const recordings: View = {
  name: "recordings",
  title: "Recordings",
  mount(root) {
    root.append(element("h1", {}, "Recordings"));
    return () => {};
  },
};
