import type { Preview } from "../api/intake";

/** What a person has chosen for a column: the channel that it becomes, and its unit where the file does not say it. */
export interface Choice {
  channel: string; // empty: left out
  unit: string;
}

export const usualChannels = ["time", "position", "velocity", "force", "force_commanded"] as const;

/** As --map names it. */
function nameOf(channel: string): string {
  return channel === "force_measured" ? "force" : channel;
}

/** Of a tool that moves in space, each with its own column. */
const spatialParts = ["position", "force", "torque"].flatMap((vector) =>
  ["x", "y", "z"].map((it) => `${vector}.${it}`),
);
/** What the select of a column offers beside the usual ones; an orientation takes its column and those after it. */
export const spatialChannels: readonly string[] = [...spatialParts, "orientation"];

interface Entry {
  channel: string;
  first: number; // column, from 1
  last: number;
  brackets: string; // unit, frame, form
}

const entryText = /^\s*([\w.-]+)\s*=\s*(\d+)(?:\s*:\s*(\d+))?\s*(?:\[([^\]]*)\])?\s*$/;

/** A map whose columns are numbers, entry by entry; null of any other, and of a wrench, whose brackets say two units. */
function entriesOf(map: string): Entry[] | null {
  const entries: Entry[] = [];
  for (const text of map.split(/,(?![^[]*\])/)) {
    if (text.trim() === "") continue;
    const [, channel = "", first = "", last = first, brackets = ""] = entryText.exec(text) ?? [];
    if (channel === "" || channel === "wrench") return null;
    entries.push({ channel: nameOf(channel), first: Number(first), last: Number(last), brackets: brackets.trim() });
  }
  return entries;
}

/** How many columns an orientation written so has. */
export function columnsOfForm(form: string): number {
  if (form.startsWith("quaternion")) return 4;
  return form.startsWith("matrix") ? 9 : 3;
}

/** A column that belongs to the orientation which begins before it. */
export function isContinued(channel: string): boolean {
  return channel.startsWith("orientation.");
}

/** The other two of x, y and z of a vector. */
export function siblingsOf(channel: string): string[] {
  if (!spatialParts.includes(channel)) return [];
  return spatialParts.filter((it) => it !== channel && it.slice(0, -1) === channel.slice(0, -1));
}

/** Whether columns can be chosen where the map is, or it can be changed as text alone. */
export function isPlain(preview: Preview, map: string): boolean {
  if (entriesOf(map) !== null) return true;
  return preview.mapped.length > 0 && !preview.mapped.some(({ channel }) => channel.includes("."));
}

/** What a map comes to, column by column. */
export function choicesOf(preview: Preview, map: string): Choice[] {
  const choices = preview.columns.map((): Choice => ({ channel: "", unit: "" }));
  const choose = (column: number, channel: string, unit: string): void => {
    if (choices[column - 1]) choices[column - 1] = { channel, unit };
  };
  const entries = entriesOf(map);
  if (entries === null) {
    for (const { channel, column, unit, unit_from_file } of preview.mapped)
      choose(column, nameOf(channel), unit_from_file ? "" : unit);
    return choices;
  }
  for (const { channel, first, last, brackets } of entries) {
    const isVector = last > first && channel !== "orientation";
    for (let column = first; column <= Math.min(last, choices.length); ++column) {
      const part = column - first;
      if (isVector) choose(column, `${channel}.${"xyz"[part] ?? part + 1}`, brackets);
      else choose(column, part === 0 ? channel : `${channel}.${part + 1}`, part === 0 ? brackets : "");
    }
  }
  return choices;
}

/** The map of what was chosen: x, y and z side by side in one unit as one entry. */
export function mapOf(choices: readonly Choice[]): string {
  const entries: string[] = [];
  for (let k = 0; k < choices.length; ++k) {
    const { channel, unit } = choices[k]!;
    if (channel === "" || isContinued(channel)) continue;
    const brackets = unit ? `[${unit}]` : "";
    const isOneVector =
      channel.endsWith(".x") &&
      siblingsOf(channel).every((it, i) => choices[k + 1 + i]?.channel === it && choices[k + 1 + i]?.unit === unit);
    if (channel === "orientation") entries.push(`orientation=${k + 1}:${k + columnsOfForm(unit)}${brackets}`);
    else if (isOneVector) entries.push(`${channel.slice(0, -2)}=${k + 1}:${k + 3}${brackets}`);
    else entries.push(`${channel}=${k + 1}${brackets}`);
    if (isOneVector) k += 2;
  }
  return entries.join(",");
}

/** A column's name as that of a channel of its own, which no other column has. */
export function ownChannel(heading: string, number: number, taken: readonly string[]): string {
  const letters = heading.replace(/[^A-Za-z0-9_-]+/g, "_").replace(/^[^A-Za-z]+|_+$/g, "");
  const name = letters || `column_${number}`;
  return taken.includes(name) ? `${name}_${number}` : name;
}

/** The name of a recording of a file: letters, digits and what the folder's names may have. */
export function recordingName(file: string, taken: ReadonlySet<string>): string {
  const stem = file
    .replace(/\.gz$/i, "")
    .replace(/\.[A-Za-z0-9]{1,5}$/, "")
    .normalize("NFKD")
    .replace(/[\u0300-\u036f]/g, "")
    .replace(/[^A-Za-z0-9._-]+/g, "-")
    .replace(/^[^A-Za-z0-9]+|[-.]+$/g, "")
    .slice(0, 70);
  const name = stem || "recording";
  if (!taken.has(name)) return name;
  for (let k = 2; ; ++k) if (!taken.has(`${name}-${k}`)) return `${name}-${k}`;
}
