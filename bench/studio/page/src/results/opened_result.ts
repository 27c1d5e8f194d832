import type { ChartFile, FitFile } from "../api/results";
import type { Workspace, WorkspaceFile } from "../api/workspace";
import { element } from "../ui/dom";
import type { Context } from "../ui/view";
import { ChartPage } from "./chart_page";
import { ChoicePanel } from "./choice_panel";
import { FitPage } from "./fit_page";
import { LawPanel } from "./law_panel";

/** A result as it is shown, until end(). */
export interface OpenedResult {
  root: HTMLElement;
  end: () => void;
}

/** Orders work that a result leads to, such as a choice for a chart. */
export type OrderWork = (path: string, body: Readonly<Record<string, unknown>>) => void;

/** Fetches a fit, a chart or a choice; it is built when what comes back is called, unless another is wanted by then. */
export async function openResult(
  context: Context,
  workspace: Workspace,
  file: WorkspaceFile,
  work: OrderWork,
  signal: AbortSignal,
): Promise<() => OpenedResult> {
  if (file.kind === "fit") {
    const fit = await context.api.get<FitFile>("/api/result", { id: file.id }, signal);
    return () => new FitPage(context, workspace, file, fit);
  }
  if (file.kind === "chart") {
    const chart = await context.api.get<ChartFile>("/api/result", { id: file.id }, signal);
    return () => new ChartPage(context, workspace, file, chart, work);
  }
  return () => choiceOf(context, workspace, file);
}

function choiceOf(context: Context, workspace: Workspace, file: WorkspaceFile): OpenedResult {
  const law = new LawPanel(context);
  const panel = new ChoicePanel(context, workspace, null, (id, name) => void law.open(id, name));
  void panel.open(file);
  return { root: element("div", { class: "two" }, panel.root, law.root), end: () => law.end() };
}
