import type { Sweep, SweepColumn, SweepFilter, SweepQuestion, SweepTable } from "../api/sweeps";
import type { State } from "../ui/view";

/** What is looked at, as the address has it. */
export interface Choice {
  table: SweepTable;
  x: string;
  y: string;
  by: string[]; // what stands beside and below each other
  of: string;
  statistic: string;
  share: string; // a condition; empty: the statistic of a column
  where: Record<string, SweepFilter>;
}

export const statistics = ["mean", "median", "smallest", "largest"] as const;

/** Inputs that are varied and listed, those with most values first. */
export function variedInputs(table: SweepTable): SweepColumn[] {
  return table.columns.filter((it) => it.input && it.texts.length > 1).sort((a, b) => b.texts.length - a.texts.length);
}

export function results(table: SweepTable): SweepColumn[] {
  return table.columns.filter((it) => !it.input);
}

function filtersIn(text: string | null): Record<string, SweepFilter> {
  try {
    const found: unknown = JSON.parse(text ?? "{}");
    return typeof found === "object" && found !== null ? (found as Record<string, SweepFilter>) : {};
  } catch {
    return {}; // an address that somebody has cut
  }
}

export function tableIn(state: State, sweep: Sweep): SweepTable | undefined {
  return sweep.tables.find((it) => it.name === state.get("table")) ?? sweep.tables[0];
}

/**
 * What the address says, and what is usual for whatever it does not say or the sweep does not have: of the results,
 * `result` or the first.
 */
export function choiceIn(state: State, sweep: Sweep, result?: string): Choice | null {
  const table = tableIn(state, sweep);
  if (!table) return null;
  const has = (name: string | null): name is string => table.columns.some((it) => it.name === name);
  const inputs = variedInputs(table).map((it) => it.name);
  const pick = (key: string, otherwise: string | undefined): string => {
    const name = state.get(key);
    return has(name) ? name : (otherwise ?? table.columns[0]?.name ?? "");
  };
  const x = pick("x", inputs[0]);
  const y = pick("y", inputs.find((it) => it !== x) ?? results(table)[0]?.name);
  const given = state.get("by");
  const by = given === null ? [] : given.split(",").filter(has).slice(0, 2);
  const statistic = state.get("stat") ?? "mean";
  const where = Object.fromEntries(Object.entries(filtersIn(state.get("where"))).filter(([name]) => has(name)));
  return {
    table,
    x,
    y,
    by: by.filter((it) => it !== x && it !== y),
    of: pick("of", result ?? results(table)[0]?.name),
    statistic: statistics.some((it) => it === statistic) ? statistic : "mean",
    share: state.get("share") ?? "",
    where,
  };
}

/** The choice with another filter of a column; null: none. */
export function filtered(choice: Choice, column: string, filter: SweepFilter | null): Choice {
  const others = Object.entries(choice.where).filter(([name]) => name !== column);
  return { ...choice, where: Object.fromEntries(filter ? [...others, [column, filter]] : others) };
}

export function writeChoice(state: State, choice: Choice): void {
  state.set(
    {
      table: choice.table.name,
      x: choice.x,
      y: choice.y,
      by: choice.by.join(",") || null,
      of: choice.of,
      stat: choice.statistic,
      share: choice.share || null,
      where: Object.keys(choice.where).length > 0 ? JSON.stringify(choice.where) : null,
    },
    "push",
  );
}

export function questionOf(choice: Choice): SweepQuestion {
  const measure = choice.share ? { share: choice.share } : { of: choice.of, statistic: choice.statistic };
  return {
    table: choice.table.name,
    by: choice.x === choice.y ? [choice.x, ...choice.by] : [choice.x, choice.y, ...choice.by],
    ...measure,
    where: choice.where,
  };
}

/** "mean comes_to_rest", "share of cells with a < 3". */
export function measureInWords(choice: Choice): string {
  if (choice.share) return `share of cells with ${choice.share}`;
  const unit = choice.table.columns.find((it) => it.name === choice.of)?.unit ?? "1";
  return withUnitOf(`${choice.statistic} ${choice.of}`, unit);
}

export function withUnitOf(name: string, unit: string): string {
  return unit === "1" || unit === "" ? name : `${name} [${unit}]`;
}
