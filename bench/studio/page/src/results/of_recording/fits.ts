import type { FittedLaw } from "../../api/results";
import { EarlierFits } from "../../cycles/earlier_fits";
import { stateKeys } from "../../recording/keys";
import { element } from "../../ui/dom";
import type { Context, OpenRecording } from "../../ui/view";
import { FitOptions } from "../fit_options";
import { LawCheckboxes } from "../law_checkboxes";
import { AxisChoice } from "./axis_choice";
import { ResultsOfRecording } from "./results";

/** The fits of one recording, and which of them are of cycles that it has no more. */
export function fitsOf(context: Context, recording: OpenRecording): ResultsOfRecording {
  const earlier = new EarlierFits(context, recording);
  const form = (laws: FittedLaw[]): HTMLElement[] => {
    const boxes = new LawCheckboxes(laws);
    const fold = element("div");
    let options = new FitOptions(undefined);
    const which = new AxisChoice(recording, (axis) => {
      boxes.show(axis);
      options = new FitOptions(axis);
      fold.replaceChildren(options.root);
    });
    const start = (event: Event): void => {
      event.preventDefault();
      const models = boxes.chosen();
      if (models.length === 0) return context.complain(new Error("Choose a law to fit"));
      results.work("/api/fit", { recording: recording.id, axis: which.name, models, ...options.given });
    };
    const press = element("button", { type: "submit", class: "firm" }, "Fit");
    return [
      element("summary", {}, "Fit laws"),
      element(
        "form",
        { class: "order", submit: start },
        boxes.root,
        fold,
        element("div", { class: "row" }, which.root, press),
      ),
    ];
  };
  const results = new ResultsOfRecording(
    context,
    recording,
    {
      kinds: ["fit"],
      key: stateKeys.fit,
      label: "Fit",
      none: "Nothing has been fitted to this recording yet: choose laws above and press Fit.",
      gone: "That fit is not in the folder any more: choose another above, or fit anew.",
      form,
      shown: (file) => earlier.show(file?.id ?? "none"),
    },
    earlier.root,
  );
  return results;
}
