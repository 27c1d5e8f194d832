import { element } from "../ui/dom";
import type { View } from "../ui/view";

export const chart: View = {
  name: "chart",
  title: "Speed and accuracy",
  mount(root) {
    root.append(element("h1", {}, "Speed and accuracy"));
    return () => {};
  },
};
