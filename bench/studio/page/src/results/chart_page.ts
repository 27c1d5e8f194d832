import type { ChartFile, ChartPoint } from "../api/results";
import type { Workspace, WorkspaceFile } from "../api/workspace";
import { element } from "../ui/dom";
import { plain, withUnit } from "../ui/numbers";
import { SortableTable } from "../ui/sortable_table";
import type { Context } from "../ui/view";
import { ChartPlot } from "./chart_plot";
import { ChoicePanel } from "./choice_panel";
import { LawPanel } from "./law_panel";
import { lawBeside, recordingsFor, resultName, stabilityInWords, stableWord } from "./names";
import { byAge } from "./of_recording/files";

const microseconds = (ns: number | null): string => (ns === null ? "–" : (1e-3 * ns).toFixed(3));

/** Of enough ticks; earlier versions wrote the largest of 128. */
const coldTail = (point: ChartPoint): number | null => (point.cold_ticks === undefined ? null : point.cold_p999_ns);
const fronts = (point: ChartPoint): string =>
  [point.on_front ? "median" : "", point.on_cold_front ? "cold" : ""].filter(Boolean).join(", ");

function tableOf(chart: ChartFile, open: (point: ChartPoint) => void): HTMLElement {
  const unit = chart.force_unit ?? "N";
  const columns = [
    {
      head: "law",
      text: (point: ChartPoint) => `${point.law}, ${point.fidelity}`,
      key: (point: ChartPoint) => `${point.law}, ${point.fidelity}`,
    },
    {
      head: "free",
      text: (point: ChartPoint) => String(point.parameters),
      key: (point: ChartPoint) => point.parameters,
    },
    {
      head: "p50 [µs]",
      file: "p50 [ns]",
      text: (point: ChartPoint) => microseconds(point.p50_ns),
      key: (point: ChartPoint) => point.p50_ns ?? 0,
    },
    {
      head: "p99.9 [µs]",
      file: "p99.9 [ns]",
      text: (point: ChartPoint) => microseconds(point.p999_ns),
      key: (point: ChartPoint) => point.p999_ns ?? 0,
    },
    {
      head: "cold p99.9 [µs]",
      file: "cold p99.9 [ns]",
      text: (point: ChartPoint) => microseconds(coldTail(point)),
      key: (point: ChartPoint) => coldTail(point) ?? Infinity,
    },
    {
      head: `error [${unit}]`,
      text: (point: ChartPoint) => plain(point.error_n),
      key: (point: ChartPoint) => point.error_n ?? Infinity,
    },
    {
      head: "error [JND]",
      text: (point: ChartPoint) => plain(point.error_jnd, 2),
      key: (point: ChartPoint) => point.error_jnd ?? Infinity,
    },
    {
      head: "outside [%]",
      file: "share outside the JND [1]",
      text: (point: ChartPoint) => (point.jnd_fraction == null ? "–" : (100 * point.jnd_fraction).toFixed(1)),
      key: (point: ChartPoint) => point.jnd_fraction ?? Infinity,
    },
    {
      head: "stable",
      text: stabilityInWords,
      key: (point: ChartPoint) => stableWord(point.stable),
    },
    {
      head: "front",
      text: fronts,
      key: (point: ChartPoint) => fronts(point) || "none",
    },
  ];
  return new SortableTable(`Every point of ${chart.source}`, columns, chart.points, open).root;
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
    private readonly chart: ChartFile,
    order: (path: string, body: Readonly<Record<string, unknown>>) => void,
  ) {
    this.law = new LawPanel(context);
    this.plot = new ChartPlot(chart, (index) => this.open(index));
    const recording = recordingsFor(workspace, chart.source, chart.recording ?? undefined)[0];
    const its = recording?.name.endsWith(`${chart.source}.h5`) ? recording : undefined;
    const choice = new ChoicePanel(
      context,
      workspace,
      its ? () => order("/api/choose", { recording: its.id }) : null,
      (id, title) => void this.law.open(id, title),
    );
    const isChosenBy = (it: WorkspaceFile): boolean => {
      if (it.of?.length && chart.recording) return it.of.includes(chart.recording);
      const [name = ""] = resultName(it).split("/").slice(-1);
      return name.replace(/(-\d+)?\.choice$/, "") === chart.source;
    };
    const choices = workspace.files.filter((it) => it.kind === "choice" && isChosenBy(it));
    const chosen = choices.sort(byAge).pop();
    if (chosen) void choice.open(chosen);
    const unjudged = chart.points.filter((it) => it.stable === null).length;
    this.root = element(
      "div",
      { class: "stack" },
      element("div", { class: "two wide" }, this.plot.root, this.law.root),
      element(
        "p",
        { class: "quiet" },
        `Errors towards ${chart.reference}. JND ${withUnit(chart.jnd_n, chart.force_unit ?? "N")}; a tick is ${withUnit(1 / chart.rate_hz, "s")}.`,
        unjudged > 0 ? ` The stability of ${unjudged} of ${chart.points.length} points was not judged.` : null,
      ),
      choice.root,
      tableOf(chart, (point) => this.open(chart.points.indexOf(point))),
      ...chart.notes.map((it) => element("p", { class: "quiet" }, it)),
    );
  }

  end(): void {
    this.plot.end();
    this.law.end();
  }

  private open(index: number): void {
    const point = this.chart.points[index]!;
    this.plot.markOpened(index);
    const law = lawBeside(this.workspace, this.file, point.law_file);
    const title = `${point.law}, ${point.fidelity}`;
    if (law) void this.law.open(law.id, title);
    else this.context.complain(new Error(`${title}: its law file is not in this folder; chart the recording again`));
  }
}
