import { element } from "../ui/dom";
import type { View } from "../ui/view";

export const sessions: View = {
  name: "sessions",
  title: "Sessions",
  mount(root) {
    root.append(element("h1", {}, "Sessions"));
    return () => {};
  },
};
