import type { Workspace, WorkspaceFile, WorkspaceRecording, WorkspaceSession } from "../../api/workspace";
import type { StudyEntry } from "../../api/studies";
import { stemOf, stemOfResult, stemsOf } from "../../results/of_recording/files";
import { folderOf } from "../../results/names";
import { isLeftOpen } from "../../recordings/left_open";
import { plain } from "../../ui/numbers";
import { whereItStands } from "../../sessions/standing";
import { bytes, length } from "../../recordings/recording_list";

export type Kind = "recordings" | "studies" | "sessions";
export type Order = "newest" | "name" | "longest" | "largest";

/** A line of the list: what it is called, what is told of it, and where it leads. */
export interface Entry {
  readonly id: string;
  readonly name: string;
  readonly address: string;
  readonly facts: string;
  /** Marks in words, each with a class: "fit", "not closed". */
  readonly marks: readonly string[];
  readonly modified: string;
  readonly seconds: number;
  readonly bytes: number;
}

export const kinds: readonly (readonly [Kind, string])[] = [
  ["recordings", "Recordings"],
  ["studies", "Studies"],
  ["sessions", "Sessions"],
];

export const orders: readonly { value: Order; text: string }[] = [
  { value: "newest", text: "Newest" },
  { value: "name", text: "Name" },
  { value: "longest", text: "Longest" },
  { value: "largest", text: "Largest" },
];

/** Which kinds of result there are: by the UUID of the recording, of those that do not say it by the stem of its name. */
function kindsOfResults(workspace: Workspace): (it: WorkspaceRecording) => string[] {
  const stems = stemsOf(workspace);
  const found = new Map<string, Set<string>>();
  for (const it of workspace.files) {
    if (it.kind !== "fit" && it.kind !== "chart" && it.kind !== "choice") continue;
    for (const key of it.of?.length ? it.of : [stemOfResult(it, stems)]) {
      const of = found.get(key) ?? new Set();
      found.set(key, of.add(it.kind));
    }
  }
  return (it) => [...new Set([...(found.get(it.uuid ?? "") ?? []), ...(found.get(stemOf(it.name)) ?? [])])];
}

function recordingEntry(it: WorkspaceRecording, results: (it: WorkspaceRecording) => string[]): Entry {
  return {
    id: it.id,
    name: it.name,
    address: `#/recording/${it.id}/time`,
    // Told when somebody looks: of thousands, twenty are seen.
    get facts() {
      return `${it.seconds === undefined ? bytes(it.bytes) : length(it.seconds)} · ${since(it.modified)}`;
    },
    get marks() {
      if (it.damaged) return ["unreadable"];
      if (isLeftOpen(it)) return ["not closed"];
      return it.partial ? ["being recorded"] : results(it);
    },
    modified: it.modified,
    seconds: it.seconds ?? 0,
    bytes: it.bytes,
  };
}

function sessionEntry(it: WorkspaceSession): Entry {
  return {
    id: it.id,
    name: it.name,
    address: `#/sessions/${it.id}`,
    facts: [it.subject && `subject ${it.subject}`, whereItStands(it)].filter(Boolean).join(" · "),
    marks: it.error ? ["unreadable"] : [],
    modified: "",
    seconds: it.answered,
    bytes: 0,
  };
}

function studyEntry(file: WorkspaceFile, known: StudyEntry | undefined): Entry {
  const facts = known && !known.error ? `${known.recordings} recordings · ${known.tissues.slice(0, 2).join(", ")}` : "";
  return {
    id: file.id,
    name: known?.name ?? (folderOf(file.name) || file.name),
    address: `#/studies/${file.id}`,
    facts: known?.error ? "cannot be read" : facts,
    marks: known ? [known.error ? "unreadable" : known.state] : [],
    modified: known?.run_at ?? "",
    seconds: known?.recordings ?? 0,
    bytes: known?.files ?? 0,
  };
}

export function entriesOf(kind: Kind, workspace: Workspace, studies: readonly StudyEntry[]): Entry[] {
  switch (kind) {
    case "recordings": {
      const results = kindsOfResults(workspace);
      return workspace.recordings.map((it) => recordingEntry(it, results));
    }
    case "studies":
      return workspace.files
        .filter((it) => it.kind === "study")
        .map((it) =>
          studyEntry(
            it,
            studies.find((each) => each.id === it.id),
          ),
        );
    case "sessions":
      return workspace.sessions.map(sessionEntry);
  }
}

export function countOf(kind: Kind, workspace: Workspace): number {
  if (kind === "studies") return workspace.files.filter((it) => it.kind === "study").length;
  return workspace[kind].length;
}

const byOrder: Record<Order, (a: Entry, b: Entry) => number> = {
  newest: (a, b) => (a.modified < b.modified ? 1 : a.modified > b.modified ? -1 : 0),
  name: () => 0, // as the names go, which all orders fall back to
  longest: (a, b) => b.seconds - a.seconds,
  largest: (a, b) => b.bytes - a.bytes,
};
const names = new Intl.Collator("en", { numeric: true });

/** Those whose name, facts or marks have every word, in the order asked for. */
export function chosen(entries: readonly Entry[], words: string, order: Order): Entry[] {
  const wanted = words.trim().toLowerCase().split(/\s+/);
  const has = (it: Entry): boolean => {
    const text = `${it.name} ${it.facts} ${it.marks.join(" ")}`.toLowerCase();
    return wanted.every((word) => text.includes(word));
  };
  const found = words.trim() ? entries.filter(has) : [...entries];
  return found.sort((a, b) => byOrder[order](a, b) || names.compare(a.name, b.name));
}

/** "4 min ago", "3 Nov", "3 Nov 2024". */
export function since(iso: string, now = new Date()): string {
  const at = new Date(iso);
  if (Number.isNaN(at.getTime())) return iso;
  const seconds = (now.getTime() - at.getTime()) / 1000;
  if (seconds >= 0 && seconds < 60) return "just now";
  if (seconds >= 0 && seconds < 3600) return `${plain(Math.floor(seconds / 60))} min ago`;
  if (seconds >= 0 && seconds < 12 * 3600) return `${plain(Math.floor(seconds / 3600))} h ago`;
  const year = at.getFullYear() === now.getFullYear() ? "" : ` ${at.getFullYear()}`;
  return `${at.getDate()} ${months[at.getMonth()]}${year}`;
}
const months = "Jan Feb Mar Apr May Jun Jul Aug Sept Oct Nov Dec".split(" ");
