import "./results.css";

import type { StabilityFile } from "../api/results";
import { JobList } from "../results/jobs";
import { byName, resultName } from "../results/names";
import { resultList } from "../results/result_list";
import { stabilityForm } from "../results/stability/stability_form";
import { StabilityMap } from "../results/stability/stability_map";
import { element } from "../ui/dom";
import { withUnit } from "../ui/numbers";
import type { View } from "../ui/view";

/** What was mapped, in a line. */
function about(file: StabilityFile): string {
  const { on } = file;
  const what = {
    wall: "Virtual walls",
    plane: "Diolaiti's plane",
    z_width: "Z-width",
    controllers: "Controllers of a wall",
  };
  if (file.study === "several") return `Several axes of ${on.device} at once, hand: ${on.grip}.`;
  const of =
    file.study === "law"
      ? `${file.law}, to ${withUnit(file.range.depth_m, "m")} at up to ${withUnit(file.range.speed_m_s, "m/s")}`
      : what[file.study];
  return `${of}, on ${on.device}, axis ${on.axis}, at ${withUnit(on.rate_hz, "Hz")}, hand: ${on.grip}.`;
}

export const stability: View = {
  name: "stability",
  title: "Stability",
  mount(root, context) {
    const title = element("h1", {}, "Stability");
    root.append(title);
    const jobs = new JobList(context, ["stability"]);
    let map: StabilityMap | null = null;
    let ended = false;
    const show = async (): Promise<void> => {
      const { id } = context.place;
      const workspace = await context.folder();
      const files = workspace.files.filter((it) => it.kind === "stability").sort(byName);
      const file = files.find((it) => it.id === id);
      const of = file ? await context.api.get<StabilityFile>("/api/result", { id }) : null;
      if (ended) return;
      if (file && of) {
        title.textContent = `Stability: ${resultName(file)}`;
        const words = element("ul", { class: "words" }, ...of.in_words.map((it) => element("li", {}, it)));
        root.append(element("p", { class: "quiet" }, about(of)));
        if (of.figure) {
          map = new StabilityMap(of, of.figure, about(of));
          root.append(map.root);
        }
        root.append(words);
      } else if (id && !workspace.laws.some((it) => it.id === id)) {
        context.say("That map is not in this folder any more.");
      }
      root.append(
        element(
          "div",
          { class: "two" },
          stabilityForm(context, workspace, id, jobs),
          element(
            "div",
            { class: "stack" },
            jobs.root,
            resultList("Maps in this folder", "stability", files, "There is none yet."),
          ),
        ),
      );
    };
    show().catch(context.complain);
    return () => {
      ended = true;
      jobs.end();
      map?.end();
    };
  },
};
