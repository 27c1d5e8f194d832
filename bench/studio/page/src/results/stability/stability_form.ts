import type { Workspace } from "../../api/workspace";
import { element, labelled, select, setOptions } from "../../ui/dom";
import type { Context } from "../../ui/view";
import type { JobList } from "../jobs";
import { lawsToPick } from "../../laws";

const grips = [
  { value: "none", text: "none" },
  { value: "light", text: "light, a stylus" },
  { value: "firm", text: "firm, a stylus" },
  { value: "arm", text: "an arm" },
];

function number(value: number, min: number, max: number, step: number | "any"): HTMLInputElement {
  return element("input", { type: "number", value, min, max, step, required: true });
}

/** Which axis to map, in which hand, and for which law: walls without one. */
export function stabilityForm(context: Context, workspace: Workspace, chosen: string, jobs: JobList): HTMLElement {
  const simulated = workspace.device.startsWith("sim:") ? workspace.device : "sim:scissors";
  const device = element("input", {
    type: "text",
    value: simulated,
    spellcheck: "false",
    autocomplete: "off",
    required: true,
    pattern: "sim:.*",
    title: "A simulated device: sim:NAME",
  });
  const rate = number(1000, 20, 20000, "any");
  const cells = number(40, 2, 60, 1);
  const depth = number(10, 0.01, 500, "any");
  const speed = number(0.2, 0.0001, 10, "any");
  const law = select([], "", () => (of_law.hidden = !law.value));
  let grip = "light";
  const of_law = element(
    "div",
    { class: "row" },
    labelled("Depth of the tool [mm]", depth),
    labelled("Speed of the tool [m/s]", speed),
  );
  const offer = (folder: Workspace, wanted = law.value): void => {
    setOptions(
      law,
      [
        { value: "", text: "walls, over stiffness and damping" },
        ...lawsToPick(folder).map((it) => ({ value: it.id, text: it.name })),
      ],
      wanted,
    );
    of_law.hidden = !law.value;
  };
  offer(workspace, chosen);
  context.onFolder((folder) => offer(folder));
  const submit = (event: Event): void => {
    event.preventDefault();
    context.say("");
    const order = {
      device: device.value.trim(),
      rate_hz: Number(rate.value),
      grip,
      cells: Number(cells.value),
      ...(law.value ? { law: law.value, depth_m: Number(depth.value) / 1000, speed_m_s: Number(speed.value) } : {}),
    };
    void jobs.order("/api/stability", order, (file) => context.go("stability", file));
  };
  return element(
    "form",
    { class: "card order", submit },
    element("h2", {}, "Map where it goes unstable"),
    element(
      "div",
      { class: "row" },
      labelled("Device", device),
      labelled("Rate [Hz]", rate),
      labelled(
        "Hand on it",
        select(grips, grip, (value) => (grip = value)),
      ),
      labelled("Cells a side", cells),
    ),
    element(
      "div",
      { class: "row" },
      labelled("Map of", law),
      element("button", { type: "submit", class: "firm" }, "Map"),
    ),
    of_law,
  );
}
