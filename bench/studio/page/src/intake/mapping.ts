import type { MappedColumn, Preview } from "../api/intake";

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

/** A map that says more than one column a channel can be changed as text alone. */
export function isPlain(map: string): boolean {
  return !/orientation|wrench|position\.|force\.|torque\.|=\s*[^,[]*:/.test(map);
}

/** What a map comes to, column by column. */
export function choicesOf(preview: Preview, map: string): Choice[] {
  const choices = preview.columns.map((): Choice => ({ channel: "", unit: "" }));
  const given = preview.mapped.length > 0 ? preview.mapped : entriesOf(map);
  for (const { channel, column, unit, unit_from_file } of given) {
    const at = choices[column - 1];
    if (at) [at.channel, at.unit] = [nameOf(channel), unit_from_file ? "" : unit];
  }
  return choices;
}

/** Entries whose columns are numbers, of a map that does not fit yet. */
function entriesOf(map: string): MappedColumn[] {
  const entries: MappedColumn[] = [];
  for (const [, channel = "", number = "", unit = ""] of map.matchAll(/([\w-]+)\s*=\s*(\d+)\s*(?:\[([^\]]*)\])?/g))
    entries.push({ channel, column: Number(number), unit, unit_from_file: unit === "", si: "" });
  return entries;
}

/** The map of what was chosen. */
export function mapOf(choices: readonly Choice[]): string {
  return choices
    .flatMap(({ channel, unit }, k) => (channel ? [`${channel}=${k + 1}${unit ? `[${unit}]` : ""}`] : []))
    .join(",");
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
