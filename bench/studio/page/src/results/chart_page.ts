import type { ChartFile, Workspace, WorkspaceFile } from "../api";
import { element } from "../ui/dom";
import { plain, withUnit } from "../ui/numbers";
import type { Context } from "../ui/view";
import { ChartPlot } from "./chart_plot";
import { PlacedChart } from "./chart_points";
import type { PlacedPoint } from "./chart_points";
import { ChoicePanel } from "./choice_panel";
import type { JobList } from "./jobs";
import { LawPanel } from "./law_panel";
import { byName, lawBeside, recordingsFor, resultName } from "./names";
import { SortableTable } from "./sortable_table";

const microseconds = (ns: number | null): string => (ns === null ? "–" : (1e-3 * ns).toFixed(3));

function tableOf(chart: PlacedChart, open: (at: PlacedPoint) => void): HTMLElement {
  const columns = [
    {
      head: "law",
      text: (at: PlacedPoint) => `${at.point.law}, ${at.point.fidelity}`,
      key: (at: PlacedPoint) => `${at.point.law}, ${at.point.fidelity}`,
    },
    {
      head: "free",
      text: (at: PlacedPoint) => String(at.point.parameters),
      key: (at: PlacedPoint) => at.point.parameters,
    },
    {
      head: "p50 [µs]",
      text: (at: PlacedPoint) => microseconds(at.point.p50_ns),
      key: (at: PlacedPoint) => at.point.p50_ns ?? 0,
    },
    {
      head: "p99.9 [µs]",
      text: (at: PlacedPoint) => microseconds(at.point.p999_ns),
      key: (at: PlacedPoint) => at.point.p999_ns ?? 0,
    },
    {
      head: "error [N]",
      text: (at: PlacedPoint) => plain(at.point.error_n),
      key: (at: PlacedPoint) => at.point.error_n ?? Infinity,
    },
    {
      head: "error [JND]",
      text: (at: PlacedPoint) => plain(at.point.error_jnd, 2),
      key: (at: PlacedPoint) => at.point.error_jnd ?? Infinity,
    },
    {
      head: "stable",
      text: (at: PlacedPoint) => (at.point.stable ? "yes" : `no: ${at.point.why_not_stable}`),
      key: (at: PlacedPoint) => (at.point.stable ? "yes" : "no"),
    },
    {
      head: "front",
      text: (at: PlacedPoint) => (at.point.on_front ? "yes" : ""),
      key: (at: PlacedPoint) => (at.point.on_front ? "a" : "b"),
    },
  ];
  return new SortableTable("Every point", columns, chart.points, open).root;
}

/** A chart as it was written: points that open their laws, and the choice of one beside it. */
export class ChartPage {
  readonly root: HTMLElement;
  private readonly plot: ChartPlot;
  private readonly law: LawPanel;

  constructor(
    private readonly context: Context,
    private readonly workspace: Workspace,
    private readonly file: WorkspaceFile,
    chart: ChartFile,
    jobs: JobList,
  ) {
    const placed = new PlacedChart(chart);
    this.law = new LawPanel(context);
    this.plot = new ChartPlot(placed, (at) => this.open(at));
    const recording = recordingsFor(workspace, chart.source)[0];
    const its = recording?.name.endsWith(`${chart.source}.h5`) ? recording : undefined;
    const choice = new ChoicePanel(
      context,
      workspace,
      its ? () => void jobs.order("/api/choose", { recording: its.id }, (id) => context.go("chart", id)) : null,
      (id, title) => void this.law.open(id, title),
    );
    const chosen = workspace.files
      .filter(
        (it) =>
          it.kind === "choice" &&
          resultName(it)
            .split("/")
            .pop()
            ?.replace(/(-\d+)?\.choice$/, "") === chart.source,
      )
      .sort(byName)
      .pop();
    if (chosen) void choice.open(chosen);
    this.root = element(
      "div",
      { class: "stack" },
      element(
        "p",
        { class: "quiet" },
        `Errors towards ${chart.reference}. JND ${withUnit(chart.jnd_n, "N")}; a tick is ${withUnit(1 / chart.rate_hz, "s")}.`,
      ),
      element(
        "div",
        { class: "two wide" },
        this.plot.root,
        element("div", { class: "stack" }, this.law.root, jobs.root),
      ),
      choice.root,
      tableOf(placed, (at) => this.open(at)),
      ...chart.notes.map((it) => element("p", { class: "quiet" }, it)),
      element("p", {}, element("a", { href: "#/chart" }, "All charts")),
    );
  }

  end(): void {
    this.plot.end();
    this.law.end();
  }

  private open(at: PlacedPoint): void {
    this.plot.markOpened(at.index);
    const law = lawBeside(this.workspace, this.file, at.point.law_file);
    const title = `${at.point.law}, ${at.point.fidelity}`;
    if (law) void this.law.open(law.id, title);
    else this.context.complain(new Error(`${title}: its law file is not in this folder; chart the recording again`));
  }
}
