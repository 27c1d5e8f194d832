import "./results.css";

import type { DeviceFile } from "../api/results";
import { DevicePage } from "../devices/device_page";
import { byName, resultName } from "../results/names";
import { resultList } from "../results/result_list";
import { element } from "../ui/dom";
import type { View } from "../ui/view";

export const devices: View = {
  name: "devices",
  title: "Devices",
  mount(root, context) {
    const gone = new AbortController();
    const title = element("h1", {}, "Devices");
    root.append(title);
    let page: DevicePage | null = null;
    const show = async (): Promise<void> => {
      const { id } = context.place;
      const workspace = await context.folder();
      const files = workspace.files.filter((it) => it.kind === "device").sort(byName);
      const file = files.find((it) => it.id === id);
      const of = file ? await context.api.get<DeviceFile>("/api/result", { id }, gone.signal) : null;
      if (gone.signal.aborted) return;
      if (file && of) {
        title.textContent = `Device ${resultName(file)}`;
        page = new DevicePage(of);
        root.append(page.root);
        return;
      }
      if (id) context.say("That device is not in this folder any more.");
      root.append(
        resultList("Devices in this folder", "devices", files, "There is none yet."),
        element(
          "p",
          {},
          element("a", { href: "#/work/identify" }, "Identify a simulated device"),
          ": one that moves a hand is measured at a terminal, by kerf identify.",
        ),
      );
    };
    show().catch(context.complain);
    return () => {
      gone.abort();
      page?.end();
    };
  },
};
