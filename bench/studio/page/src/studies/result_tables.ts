import type { GroupEstimate, StudiedComparison, StudiedGroup, Study } from "../api/studies";
import { element, table } from "../ui/dom";
import { plain } from "../ui/numbers";

const mostRows = 200;

/** What a study found as tables: laws, quantities, comparisons. */
export function resultTables(study: Study): HTMLElement[] {
  const found: HTMLElement[] = [];
  if (study.groups.some((it) => it.laws.length > 0)) found.push(section("Which law serves", laws(study.groups)));
  const of = study.law === null ? "Peak and work" : `Peak, work and the parameters of ${study.law}`;
  if (study.groups.some((it) => it.quantities.length > 0)) found.push(section(of, quantities(study.groups)));
  if (study.comparisons.length > 0) found.push(section("Do tissues or speeds differ", comparisons(study.comparisons)));
  return found;
}

function section(head: string, content: HTMLElement): HTMLElement {
  return element("section", {}, element("h2", {}, head), element("div", { class: "scrolled" }, content));
}

function nameOf(group: StudiedGroup): string {
  return [group.tissue, group.speed].filter((it) => it !== "").join(", ") || "all recordings";
}

function laws(groups: readonly StudiedGroup[]): HTMLElement {
  const heads = ["Tissue and speed", "Law", "Parameters", "Serves in", "On held-out cycles [JND]", "On others [JND]"];
  const rows = groups.flatMap((group) =>
    group.laws.map((it) => [
      nameOf(group),
      it.law === group.serves ? element("strong", {}, `${it.law} (serves)`) : it.law,
      String(it.free_parameters),
      `${it.serves} of ${group.recordings.length}`,
      inWords(it.held_out_jnd, false),
      inWords(it.on_others_jnd, false),
    ]),
  );
  return table("Others are specimens, or recordings where these are not named, that it was not fitted to", heads, rows);
}

function quantities(groups: readonly StudiedGroup[]): HTMLElement {
  const heads = ["Tissue and speed", "Quantity", "Unit", "Mean (95 % interval)", "Between specimens", "Recordings"];
  const rows = groups.flatMap((group) =>
    group.quantities.map((it) => [
      nameOf(group),
      it.name,
      it.unit,
      inWords(it.estimate, it.logarithm),
      plain(it.estimate.between_specimens?.value),
      plain(it.estimate.between_recordings?.value),
    ]),
  );
  const more = rows.length > mostRows ? `; the first ${mostRows} rows, groups.csv has all` : "";
  return table(`Spreads of positive quantities are relative${more}`, heads, rows.slice(0, mostRows));
}

function comparisons(all: readonly StudiedComparison[]): HTMLElement {
  const heads = [
    "Quantity",
    "First",
    "Second",
    "Verdict",
    "n",
    "First to second (95 %)",
    "Hedges' g",
    "p",
    "p by Holm",
  ];
  const rows = all.map((it) => [
    it.quantity,
    it.first,
    it.second,
    it.verdict,
    `${it.first_units} and ${it.second_units}`,
    difference(it),
    plain(it.hedges_g, 2),
    plain(it.p, 2),
    plain(it.p_holm, 2),
  ]);
  return table("By permutation of specimens or recordings, corrected for all comparisons of the study", heads, rows);
}

function difference(it: StudiedComparison): string {
  const of = (value: number | null): string =>
    value === null ? "–" : plain(it.logarithm ? Math.exp(value) : value, 3);
  if (it.difference === null) return "–";
  const interval = it.ci95 ? ` (${of(it.ci95[0])} to ${of(it.ci95[1])})` : "";
  return `${it.logarithm ? "ratio" : "difference"} ${of(it.difference)}${interval}`;
}

/** "0.43 (0.31 to 0.6; 5 specimens)", of logarithms as they were before; as the report has it. */
export function inWords(it: GroupEstimate, logarithm: boolean): string {
  const of = (value: number | null): string => plain(value === null || !logarithm ? value : Math.exp(value), 3);
  if (it.mean === null) return "unknown";
  const [count, what] = it.specimens === null ? [it.recordings, "recording"] : [it.specimens, "specimen"];
  const over = `${count} ${what}${count === 1 ? "" : "s"}`;
  const interval = it.ci95 ? `${of(it.ci95[0])} to ${of(it.ci95[1])}` : "no interval";
  return `${of(it.mean)} (${interval}; ${over})`;
}
