import type { FindSettings, PhaseRows, Remark } from "../api/cycles";

/** Cycles as they are on the page; nothing in it is ever changed, only taken the place of. */
export interface Draft {
  readonly settings: FindSettings | null; // by which they were found here; null: those of the recording
  readonly phases: readonly PhaseRows[];
  readonly said: readonly Remark[];
}

export type Edge = "begin" | "end";

/** One end of a phase, and the end of its neighbour where both meet there. */
export interface Boundary {
  readonly index: number; // of the phase
  readonly edge: Edge;
  readonly cycle: number;
  readonly row: number;
  readonly time_s: number;
  readonly least: number; // rows that it may have
  readonly most: number;
  readonly text: string; // "closing begins"
}

const words = ["", "opening", "the wait", "closing", "the hold"] as const;

/** The phases that a boundary moves: its own, and one that meets it. */
function meeting(phases: readonly PhaseRows[], index: number, edge: Edge): number {
  const other = edge === "begin" ? index - 1 : index + 1;
  const [own, neighbour] = [phases[index], phases[other]];
  if (!own || !neighbour) return -1;
  return edge === "begin" ? (neighbour[3] === own[2] ? other : -1) : neighbour[2] === own[3] ? other : -1;
}

function boundary(draft: Draft, index: number, edge: Edge, rows: number): Boundary {
  const { phases } = draft;
  const own = phases[index]!;
  const met = phases[meeting(phases, index, edge)];
  const beside = phases[edge === "begin" ? index - 1 : index + 1];
  const least = edge === "begin" ? (met ? met[2] + 1 : (beside?.[3] ?? 0)) : own[2] + 1;
  const most = edge === "begin" ? own[3] - 1 : met ? met[3] - 1 : (beside?.[2] ?? rows);
  return {
    index,
    edge,
    cycle: own[0],
    row: edge === "begin" ? own[2] : own[3],
    time_s: edge === "begin" ? own[4] : own[5],
    least,
    most,
    text: `${words[own[1]]} ${edge === "begin" ? "begins" : "ends"}`,
  };
}

/** The boundaries of a cycle, in their order. */
export function boundariesOf(draft: Draft, cycle: number, rows: number): Boundary[] {
  const found: Boundary[] = [];
  draft.phases.forEach((phase, index) => {
    if (phase[0] !== cycle) return;
    found.push(boundary(draft, index, "begin", rows));
    const next = meeting(draft.phases, index, "end");
    if (next < 0 || draft.phases[next]![0] !== cycle) found.push(boundary(draft, index, "end", rows));
  });
  return found;
}

/** The draft with a boundary elsewhere, within what its neighbours leave. */
export function moved(draft: Draft, at: Boundary, row: number, time_s: number): Draft {
  const to = Math.min(at.most, Math.max(at.least, row));
  const phases = draft.phases.map((it): PhaseRows => [...it]);
  const own = phases[at.index]!;
  const met = phases[meeting(draft.phases, at.index, at.edge)];
  if (at.edge === "begin") [own[2], own[4]] = [to, time_s];
  else [own[3], own[5]] = [to, time_s];
  if (met && at.edge === "begin") [met[3], met[5]] = [to, time_s];
  else if (met) [met[2], met[4]] = [to, time_s];
  return { ...draft, phases };
}

/** What a person says of a cycle, in place of what was said by hand of it before; null: nothing any more. */
export function withRemark(draft: Draft, cycle: number, remark: Remark | null): Draft {
  const said = draft.said.filter((it) => it.cycle !== cycle);
  return { ...draft, said: remark ? [...said, remark].sort((a, b) => a.cycle - b.cycle) : said };
}

export function areAlike(a: Draft, b: Draft): boolean {
  const rows = (it: Draft): string =>
    JSON.stringify([it.settings, it.phases.map((phase) => phase.slice(0, 4)), it.said]);
  return rows(a) === rows(b);
}

/** Span of a cycle over all of its phases [s]. */
export function spanOf(draft: Draft, cycle: number): { from_s: number; to_s: number } | null {
  const own = draft.phases.filter((it) => it[0] === cycle);
  if (own.length === 0) return null;
  return { from_s: Math.min(...own.map((it) => it[4])), to_s: Math.max(...own.map((it) => it[5])) };
}

/** Which phases of which cycles there are, whatever their rows. */
const divisionOf = (it: Draft): string => JSON.stringify(it.phases.map((phase) => phase.slice(0, 2)));

/** The number that a cycle of `base` has in `theirs`, where cycles may have been split and merged; 0: none. */
function numberIn(theirs: Draft, base: Draft, cycle: number): number {
  if (divisionOf(theirs) === divisionOf(base)) return cycle;
  const rows = (it: Draft, number: number): string => {
    const own = it.phases.filter((phase) => phase[0] === number);
    return JSON.stringify([own[0]?.[2], own[own.length - 1]?.[3]]);
  };
  const wanted = rows(base, cycle);
  return [...new Set(theirs.phases.map((it) => it[0]))].find((it) => rows(theirs, it) === wanted) ?? 0;
}

/**
 * What was changed here from `base` to `mine`, put on top of what somebody else has saved meanwhile: boundaries that
 * were moved, and remarks. Where a boundary does not fit there any more, theirs stays; how many is told. Cycles that
 * were split or merged here are put on cycles that nobody else has touched, or not at all.
 */
export function onTop(base: Draft, mine: Draft, theirs: Draft, rows: number): { draft: Draft; lost: number } {
  // Found anew by other settings: theirs is what it takes the place of. Cycles that nobody has saved are found unasked.
  if (JSON.stringify(mine.settings) !== JSON.stringify(base.settings)) return { draft: mine, lost: 0 };
  if (divisionOf(base) !== divisionOf(mine))
    return areAlike(base, theirs) ? { draft: mine, lost: 0 } : { draft: theirs, lost: 1 };
  let draft = theirs;
  let lost = 0;
  for (const [index, phase] of mine.phases.entries()) {
    const before = base.phases[index];
    if (!before) continue;
    for (const edge of ["begin", "end"] as const) {
      const [row, time] = edge === "begin" ? [2, 4] : [3, 5];
      if (phase[row] === before[row]) continue;
      if (edge === "end" && meeting(mine.phases, index, "end") >= 0) continue; // told by the begin of the next
      const number = numberIn(theirs, base, phase[0]);
      const there = draft.phases.findIndex((it) => it[0] === number && it[1] === phase[1]);
      const at = there < 0 ? null : boundary(draft, there, edge, rows);
      if (!at || phase[row]! < at.least || phase[row]! > at.most) ++lost;
      else draft = moved(draft, at, phase[row]!, phase[time]!);
    }
  }
  const key = (it: Remark): string => JSON.stringify(it);
  const [had, have] = [new Set(base.said.map(key)), new Set(mine.said.map(key))];
  const say = (cycle: number, remark: Remark | null): void => {
    const number = numberIn(theirs, base, cycle);
    if (number === 0) ++lost;
    else draft = withRemark(draft, number, remark && { ...remark, cycle: number });
  };
  for (const it of base.said) if (!have.has(key(it))) say(it.cycle, null);
  for (const it of mine.said) if (!had.has(key(it))) say(it.cycle, it);
  return { draft, lost };
}
