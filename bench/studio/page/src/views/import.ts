import "./import.css";

import { IntakePage } from "../intake/intake_page";
import type { View } from "../ui/view";

export const importView: View = {
  name: "import",
  title: "Import",
  mount(root, context) {
    const page = new IntakePage(root, context);
    return () => page.close();
  },
};
