import type { FittedLaw } from "../../api/results";
import { stateKeys } from "../../recording/keys";
import { button, element } from "../../ui/dom";
import type { Context, OpenRecording } from "../../ui/view";
import { LawCheckboxes } from "../law_checkboxes";
import { AxisChoice } from "./axis_choice";
import { ResultsOfRecording } from "./results";

const about =
  "Every law is fitted in every size, and its tick is timed: a chart takes a minute. " +
  "A choice tries every law that fits the axis, whatever is ticked.";

/** The charts and choices of one recording. */
export function chartsOf(context: Context, recording: OpenRecording): ResultsOfRecording {
  const form = (laws: FittedLaw[]): HTMLElement[] => {
    const boxes = new LawCheckboxes(laws);
    const which = new AxisChoice(recording, (axis) => boxes.show(axis));
    const asked = (): { recording: string; axis: string } => ({ recording: recording.id, axis: which.name });
    const start = (event: Event): void => {
      event.preventDefault();
      const models = boxes.chosen();
      if (models.length === 0) return context.complain(new Error("Choose a law to chart"));
      results.work("/api/chart", { ...asked(), models });
    };
    // A choice stands beside the chart, where there is one.
    const choose = (): void => results.work("/api/choose", asked(), (shown) => shown?.kind === "chart");
    const press = element("button", { type: "submit", class: "firm" }, "Chart");
    return [
      element("summary", {}, "Chart laws, or choose one"),
      element(
        "form",
        { class: "order", submit: start },
        boxes.root,
        element("p", { class: "quiet" }, about),
        element("div", { class: "row" }, which.root, press, button("Choose the simplest that serves", choose)),
      ),
    ];
  };
  const results = new ResultsOfRecording(context, recording, {
    kinds: ["chart", "choice"],
    key: stateKeys.chart,
    label: "Result",
    none: "This recording has no chart yet: choose laws above and press Chart. It takes a minute.",
    gone: "That chart is not in the folder any more: choose another above, or chart anew.",
    form,
  });
  return results;
}
