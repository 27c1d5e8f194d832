import "./results.css";

import type { ChartFile, FittedLaw } from "../api/results";
import type { Workspace, WorkspaceFile } from "../api/workspace";
import { ChartPage } from "../results/chart_page";
import { ChoicePanel } from "../results/choice_panel";
import { JobList } from "../results/jobs";
import { LawCheckboxes } from "../results/law_checkboxes";
import { LawPanel } from "../results/law_panel";
import { leadToTab } from "../results/of_recording/old_address";
import { byName, resultName } from "../results/names";
import { RecordingChoice } from "../results/order_form";
import { button, element } from "../ui/dom";
import type { Context, View } from "../ui/view";

/** A form for a chart of one recording, or a choice for it. */
function form(context: Context, workspace: Workspace, laws: FittedLaw[], chosen: string, jobs: JobList): HTMLElement {
  const boxes = new LawCheckboxes(laws);
  const which = new RecordingChoice(context, RecordingChoice.of(workspace), chosen, (axis) => boxes.show(axis));
  const order = (path: string, more: Record<string, unknown>): void => {
    if (!which.recording) return context.complain(new Error("There is no recording"));
    context.say("");
    void jobs.order(path, { recording: which.recording.id, axis: which.axis, ...more }, (file) =>
      context.go("chart", file),
    );
  };
  const start = (event: Event): void => {
    event.preventDefault();
    const models = boxes.chosen();
    if (models.length === 0) return context.complain(new Error("Choose a law to chart"));
    order("/api/chart", { models });
  };
  return element(
    "form",
    { class: "card order", submit: start },
    element("h2", {}, "Chart laws of a recording"),
    which.root,
    boxes.root,
    element(
      "p",
      { class: "quiet" },
      "Every law is fitted in every size, and its tick is timed: a chart takes a minute. " +
        "A choice tries every law that fits the axis, whatever is ticked.",
    ),
    element(
      "div",
      { class: "row" },
      element("button", { type: "submit", class: "firm" }, "Chart"),
      button("Choose the simplest that serves", () => order("/api/choose", {})),
    ),
  );
}

function listOf(title: string, files: readonly WorkspaceFile[]): HTMLElement {
  const links = files.map((it) => element("li", {}, element("a", { href: `#/chart/${it.id}` }, resultName(it))));
  return element(
    "section",
    { class: "card", "aria-label": title },
    element("h2", {}, title),
    links.length > 0
      ? element("ul", { class: "links" }, ...links)
      : element("p", { class: "quiet" }, "There is none yet."),
  );
}

/** The chart that a choice belongs beside, if there is one: that of the same name, the newest. */
function chartOf(charts: readonly WorkspaceFile[], choice: WorkspaceFile): WorkspaceFile | undefined {
  const stem = (it: WorkspaceFile): string => resultName(it).replace(/(-\d+)?\.(chart|choice)$/, "");
  return charts.filter((it) => stem(it) === stem(choice)).pop();
}

export const chart: View = {
  name: "chart",
  title: "Speed and accuracy",
  mount(root, context) {
    const title = element("h1", {}, "Speed and accuracy");
    root.append(title);
    const jobs = new JobList(context, ["chart", "choice"]);
    const ends: (() => void)[] = [() => jobs.end()];
    const gone = (): boolean => context.signal.aborted;
    const showChart = async (workspace: Workspace, file: WorkspaceFile): Promise<void> => {
      const of = await context.api.get<ChartFile>("/api/result", { id: file.id });
      if (gone()) return;
      title.textContent = `Speed and accuracy: ${resultName(file)}`;
      const page = new ChartPage(
        context,
        workspace,
        file,
        of,
        (path, body) => void jobs.order(path, body, (it) => context.go("chart", it)),
      );
      ends.push(() => page.end());
      root.append(page.root);
    };
    const showChoice = async (workspace: Workspace, file: WorkspaceFile): Promise<void> => {
      title.textContent = `Choice ${resultName(file)}`;
      const law = new LawPanel(context);
      ends.push(() => law.end());
      const panel = new ChoicePanel(context, workspace, null, (id, name) => void law.open(id, name));
      root.append(
        element("div", { class: "two" }, panel.root, law.root),
        element("p", {}, element("a", { href: "#/chart" }, "All charts and choices")),
      );
      await panel.open(file);
    };
    const show = async (): Promise<void> => {
      const { id } = context.place;
      const workspace = await context.api.get<Workspace>("/api/workspace");
      const charts = workspace.files.filter((it) => it.kind === "chart").sort(byName);
      const choices = workspace.files.filter((it) => it.kind === "choice").sort(byName);
      if (gone() || (id && leadToTab(context, workspace, "chart", [...charts, ...choices]))) return;
      const choice = choices.find((it) => it.id === id);
      const file = charts.find((it) => it.id === id) ?? (choice && chartOf(charts, choice));
      if (file) return showChart(workspace, file);
      if (choice) return showChoice(workspace, choice);
      const laws = await context.api.get<FittedLaw[]>("/api/laws/fitted");
      if (gone()) return;
      if (id) context.say("That chart is not in this folder any more.");
      root.append(
        element(
          "div",
          { class: "two" },
          form(context, workspace, laws, id, jobs),
          element(
            "div",
            { class: "stack" },
            jobs.root,
            listOf("Charts in this folder", charts),
            listOf("Choices in this folder", choices),
          ),
        ),
      );
    };
    show().catch(context.complain);
    return () => {
      for (const end of ends) end();
    };
  },
};
