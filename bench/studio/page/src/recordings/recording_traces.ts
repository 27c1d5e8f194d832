import type { Recording, Trace } from "../api/recordings";
import { element } from "../ui/dom";
import { axisOf, inWords } from "./trace_groups";

/** Which traces are shown at first: position, velocity and force of the cycles' axis, or of the first. */
export function firstTraces(recording: Recording): Set<string> {
  const axis = recording.axes[recording.cycles?.axis ?? 0]?.name ?? "";
  const wanted = recording.traces.filter(
    (it) =>
      (it.group === "position" || it.group === "velocity" || it.group === "force") &&
      axisOf(it, recording.axes) === axis,
  );
  return new Set((wanted.length > 0 ? wanted : recording.traces.slice(0, 3)).map((it) => it.name));
}

/** Boxes to tick, by group. */
export function traceChoice(traces: readonly Trace[], chosen: Set<string>, changed: () => void): HTMLElement {
  const box = (trace: Trace): HTMLElement => {
    const input = element("input", {
      type: "checkbox",
      checked: chosen.has(trace.name),
      change: () => {
        if (input.checked) chosen.add(trace.name);
        else chosen.delete(trace.name);
        changed();
      },
    });
    return element(
      "label",
      { class: "tick" },
      input,
      `${inWords(trace.name)}${trace.unit === "1" ? "" : ` [${trace.unit}]`}`,
    );
  };
  return element("fieldset", { class: "trace_choice" }, element("legend", {}, "Traces"), ...traces.map(box));
}
