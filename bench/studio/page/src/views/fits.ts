import "./results.css";

import type { FitFile, FittedLaw } from "../api/results";
import type { Workspace, WorkspaceFile } from "../api/workspace";
import { element } from "../ui/dom";
import type { Context, View } from "../ui/view";
import { FitPage } from "../results/fit_page";
import { FitOptions } from "../results/fit_options";
import { JobList } from "../results/jobs";
import { LawCheckboxes } from "../results/law_checkboxes";
import { leadToTab } from "../results/of_recording/old_address";
import { byName, resultName } from "../results/names";
import { RecordingChoice } from "../results/order_form";

/** A form for a fit of one recording. */
function form(context: Context, workspace: Workspace, laws: FittedLaw[], chosen: string, jobs: JobList): HTMLElement {
  const boxes = new LawCheckboxes(laws);
  const fold = element("div");
  let options = new FitOptions(undefined);
  const which = new RecordingChoice(context, RecordingChoice.of(workspace), chosen, (axis) => {
    boxes.show(axis);
    options = new FitOptions(axis);
    fold.replaceChildren(options.root);
  });
  const start = (event: Event): void => {
    event.preventDefault();
    const models = boxes.chosen();
    if (!which.recording) return context.complain(new Error("There is no recording to fit"));
    if (models.length === 0) return context.complain(new Error("Choose a law to fit"));
    context.say("");
    const order = { recording: which.recording.id, axis: which.axis, models, ...options.given };
    void jobs.order("/api/fit", order, (file) => context.go("fits", file));
  };
  return element(
    "form",
    { class: "card order", submit: start },
    element("h2", {}, "Fit laws to a recording"),
    which.root,
    boxes.root,
    fold,
    element("div", { class: "row" }, element("button", { type: "submit", class: "firm" }, "Fit")),
  );
}

function listOf(files: readonly WorkspaceFile[]): HTMLElement {
  const links = files.map((it) => element("li", {}, element("a", { href: `#/fits/${it.id}` }, resultName(it))));
  return element(
    "section",
    { class: "card", "aria-label": "Fits in this folder" },
    element("h2", {}, "Fits in this folder"),
    links.length > 0
      ? element("ul", { class: "links" }, ...links)
      : element("p", { class: "quiet" }, "There is none yet."),
  );
}

export const fits: View = {
  name: "fits",
  title: "Fits",
  mount(root, context) {
    const title = element("h1", {}, "Fits");
    root.append(title);
    const jobs = new JobList(context, ["fit"]);
    let page: FitPage | null = null;
    const gone = (): boolean => context.signal.aborted;
    const show = async (): Promise<void> => {
      const { id } = context.place;
      const workspace = await context.api.get<Workspace>("/api/workspace");
      const files = workspace.files.filter((it) => it.kind === "fit").sort(byName);
      if (gone() || (id && leadToTab(context, workspace, "fits", files))) return;
      const file = files.find((it) => it.id === id);
      if (file) {
        const fit = await context.api.get<FitFile>("/api/result", { id });
        if (gone()) return;
        title.textContent = `Fit ${resultName(file)}`;
        page = new FitPage(context, workspace, file, fit);
        root.append(page.root);
        return;
      }
      const laws = await context.api.get<FittedLaw[]>("/api/laws/fitted");
      if (gone()) return;
      if (id) context.say("That fit is not in this folder any more.");
      root.append(
        element(
          "div",
          { class: "two" },
          form(context, workspace, laws, id, jobs),
          element("div", { class: "stack" }, jobs.root, listOf(files)),
        ),
      );
    };
    show().catch(context.complain);
    return () => {
      jobs.end();
      page?.end();
    };
  },
};
