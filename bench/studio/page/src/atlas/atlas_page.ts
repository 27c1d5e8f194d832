import type { Sweep, SweepAnswer, SweepColumn, SweepSample, SweepTable } from "../api/sweeps";
import { button, element } from "../ui/dom";
import { Latest } from "../ui/latest";
import { csvOf, type CsvColumn } from "../ui/plot/out/csv_file";
import { download, fileName } from "../ui/plot/out/download";
import type { Context } from "../ui/view";
import { controls, filterPanel } from "./controls";
import { HeatMaps } from "./heat_maps";
import { ParallelPlot } from "./parallel/parallel_plot";
import {
  choiceIn,
  filtered,
  measureInWords,
  questionOf,
  results,
  tableIn,
  variedInputs,
  withUnitOf,
  writeChoice,
  type Choice,
} from "./question";

const most_lines = 1200;
const most_results = 8; // that are looked at for one that varies

/** A sweep from all sides: heat maps and parallel coordinates of what the address says. */
export class AtlasPage {
  readonly root: HTMLElement;
  private readonly choosing = element("div", { class: "atlas_choice" });
  private readonly counted = element("p", { class: "counted", role: "status" });
  private readonly save = button("Save CSV", () => this.handOut(), { class: "small", hidden: true });
  private answer: { found: SweepAnswer; measure: string } | null = null;
  private readonly maps = new HeatMaps();
  private readonly parallel: ParallelPlot;
  private readonly filtering = element("div", {});
  private readonly answers: Latest;
  private readonly samples: Latest;
  private readonly behind = new Map<string, SweepSample>(); // by the question: without filters
  private readonly telling = new Map<string, string>(); // by the table: the first result that is not the same everywhere

  constructor(
    private readonly context: Context,
    private readonly id: string,
    private readonly sweep: Sweep,
  ) {
    this.answers = new Latest(context.signal);
    this.samples = new Latest(context.signal);
    this.parallel = new ParallelPlot((column, filter) => {
      const choice = this.choice();
      if (choice) this.choose(filtered(choice, column, filter));
    });
    this.root = element(
      "div",
      { class: "stack" },
      element("p", { class: "quiet" }, about(sweep)),
      this.choosing,
      element("div", { class: "row" }, this.counted, this.save),
      this.maps.root,
      element("h2", {}, "Cells as lines"),
      this.parallel.root,
      this.filtering,
    );
    context.state.onChange(() => this.show());
    this.show();
  }

  end(): void {
    this.maps.end();
    this.parallel.end();
  }

  private choose(choice: Choice): void {
    writeChoice(this.context.state, choice);
    this.show();
  }

  private choice(): Choice | null {
    const { state } = this.context;
    return choiceIn(state, this.sweep, this.telling.get(tableIn(state, this.sweep)?.name ?? ""));
  }

  private show(): void {
    const table = tableIn(this.context.state, this.sweep);
    if (table && !this.telling.has(table.name) && !this.context.state.get("of"))
      void this.look(table).then(() => this.draw());
    else this.draw();
  }

  /** Which result of a table has something to show. */
  private async look(table: SweepTable): Promise<void> {
    const columns = results(table)
      .map((it) => it.name)
      .slice(0, most_results);
    const of = columns[0];
    if (of === undefined) return;
    const question = { id: this.id, table: table.name, by: [], of, columns, where: {}, most: most_lines };
    const sample = await this.context.api.post<SweepSample>("/api/sweep/sample", question).catch(() => null);
    const varies = (it: (number | null)[]): boolean => new Set(it.filter((value) => value !== null)).size > 1;
    this.telling.set(table.name, sample?.columns[sample.values.findIndex(varies)] ?? of);
  }

  private draw(): void {
    const choice = this.choice();
    if (!choice) return;
    this.fill(
      this.choosing,
      controls(this.sweep, choice, (next) => this.choose(next)),
    );
    this.fill(
      this.filtering,
      filterPanel(choice, (next) => this.choose(next)),
    );
    this.ask(choice).catch(this.context.complain);
    this.askLines(choice).catch(this.context.complain);
  }

  /** New controls in place of those before; what had the focus has it again. */
  private fill(place: HTMLElement, content: HTMLElement): void {
    const controlsOf = (of: HTMLElement): HTMLElement[] => [
      ...of.querySelectorAll<HTMLElement>("select, input, button, summary"),
    ];
    const open = [...place.querySelectorAll("details")].map((it) => it.open);
    const had = controlsOf(place).findIndex((it) => it === document.activeElement);
    place.replaceChildren(content);
    place.querySelectorAll("details").forEach((it, i) => (it.open = open[i] ?? false));
    if (had >= 0) controlsOf(place)[had]?.focus();
  }

  private async ask(choice: Choice): Promise<void> {
    const question = { id: this.id, ...questionOf(choice) };
    const found = await this.answers.ask(() => this.context.api.post<SweepAnswer>("/api/sweep/answer", question));
    if (!found) return;
    const { computed, known, failed, missing } = found.all;
    const texts = [`${count(computed + failed + missing)} cells count`, `${count(known)} of them have a number`];
    if (failed > 0) texts.push(`${count(failed)} failed`);
    if (missing > 0) texts.push(`${count(missing)} are missing`);
    this.counted.textContent = `${texts.join(", ")}.`;
    this.answer = { found, measure: measureInWords(choice) };
    this.save.hidden = false;
    this.maps.show(found, this.answer.measure);
  }

  private handOut(): void {
    if (!this.answer) return;
    const { found, measure } = this.answer;
    download(csvOf(partColumns(found, measure)), fileName(`${this.sweep.verb} ${measure}`, "csv"), "text/csv");
  }

  private async askLines(choice: Choice): Promise<void> {
    const columns = lineColumns(choice);
    const names = [...columns.map((it) => it.name), choice.of];
    const question = { id: this.id, table: choice.table.name, by: [], of: choice.of, columns: names, most: most_lines };
    const key = JSON.stringify(question);
    const post = (where: object): Promise<SweepSample> =>
      this.context.api.post<SweepSample>("/api/sweep/sample", { ...question, where });
    const found = await this.samples.ask(async () => {
      const all = this.behind.get(key) ?? (await post({}));
      this.behind.set(key, all);
      return { all, some: Object.keys(choice.where).length > 0 ? await post(choice.where) : all };
    });
    if (found) this.parallel.show(found.some, found.all, columns, choice.where);
  }
}

/** Every part of the maps in a row: what it is of, what is drawn, and of how many cells. */
function partColumns({ axes, value, computed, known, failed, missing }: SweepAnswer, measure: string): CsvColumn[] {
  let apart = 1; // how far parts that differ along an axis lie from each other
  const along = axes.flatMap((axis): CsvColumn[] => {
    const count = Math.max(axis.names.length, axis.values.length, axis.edges.length - 1);
    const step = apart;
    apart *= count;
    const at = value.map((_, part) => Math.floor(part / step) % count);
    const head = withUnitOf(axis.column, axis.unit);
    const numbers = axis.values.some((it) => it !== null) ? axis.values : [];
    if (numbers.length > 0) return [{ head, cells: at.map((it) => numbers[it] ?? null) }];
    if (axis.names.length > 0) return [{ head, cells: at.map((it) => axis.names[it] ?? "") }];
    return [
      { head: `${head} from`, cells: at.map((it) => axis.edges[it] ?? null) },
      { head: `${head} to`, cells: at.map((it) => axis.edges[it + 1] ?? null) },
    ];
  });
  return [
    ...along,
    { head: measure, cells: value },
    { head: "cells computed", cells: computed },
    { head: "of these with a number", cells: known },
    { head: "cells that failed", cells: failed },
    { head: "cells that are missing", cells: missing },
  ];
}

/** Up to six inputs and two results, with what is drawn above among them. */
function lineColumns(choice: Choice): SweepColumn[] {
  const inputs = variedInputs(choice.table).slice(0, 6);
  const shown = results(choice.table).filter((it) => it.name === choice.of || it.name in choice.where);
  return [...inputs, ...shown].slice(0, 8);
}

/** 1,000,000 */
function count(cells: number): string {
  return cells.toLocaleString("en-GB");
}

function about(sweep: Sweep): string {
  const tables = sweep.tables.map((it) => {
    const counts = [`${count(it.computed)} computed`];
    if (it.failed > 0) counts.push(`${count(it.failed)} failed`);
    if (it.missing > 0) counts.push(`${count(it.missing)} missing`);
    return `${it.name}: ${counts.join(", ")}`;
  });
  const listed = tables.length > 4 ? `${tables.slice(0, 4).join("; ")}; …` : tables.join("; ");
  return `A sweep of kerf ${sweep.verb} over ${count(sweep.cells)} cells, by ${sweep.software}. ${listed}.`;
}
