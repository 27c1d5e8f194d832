import type { Workspace, WorkspaceRecording } from "../api/workspace";
import { element, labelled } from "../ui/dom";
import { plain } from "../ui/numbers";

const shownAtOnce = 300;

/** The recordings of the workspace, newest first, with a filter by name. */
export function recordingList(workspace: Workspace): HTMLElement {
  const all = [...workspace.recordings].sort((a, b) => b.modified.localeCompare(a.modified));
  const count = element("p", { class: "quiet", role: "status" });
  const body = element("tbody");
  const timed = all.some((it) => it.seconds !== undefined);
  const show = (): void => {
    const wanted = filter.value.trim().toLowerCase().split(/\s+/);
    const found = all.filter((it) => wanted.every((word) => it.name.toLowerCase().includes(word)));
    body.replaceChildren(...found.slice(0, shownAtOnce).map((it) => row(it, timed)));
    const more = found.length > shownAtOnce ? `; the newest ${shownAtOnce} are shown` : "";
    count.textContent = `${found.length} of ${all.length} recordings${more}`;
  };
  const filter = element("input", { type: "search", autocomplete: "off", spellcheck: "false", input: show });
  const heads = element(
    "tr",
    {},
    element("th", { scope: "col" }, "Name"),
    timed ? element("th", { scope: "col", class: "number" }, "Length") : null,
    element("th", { scope: "col", class: "number" }, "Size"),
    element("th", { scope: "col" }, "Changed"),
  );
  show();
  return element(
    "section",
    { class: "recording_list" },
    element("div", { class: "row" }, labelled("Filter by name", filter), count),
    all.length > 0
      ? element("div", { class: "table_frame" }, element("table", {}, element("thead", {}, heads), body))
      : element("p", {}, `No recordings in ${workspace.folder} yet. Record one on the scope, or by kerf record.`),
  );
}

function row(it: WorkspaceRecording, timed: boolean): HTMLElement {
  return element(
    "tr",
    {},
    element(
      "td",
      {},
      element("a", { href: `#/recording/${it.id}/time` }, it.name),
      it.partial
        ? element(
            "p",
            { class: "partial" },
            "Not closed: being written, or left by a crash. Then mend it: ",
            element("code", {}, `kerf repair ${it.name}`),
          )
        : null,
    ),
    timed ? element("td", { class: "number" }, it.seconds === undefined ? "–" : length(it.seconds)) : null,
    element("td", { class: "number" }, bytes(it.bytes)),
    element("td", {}, date(it.modified)),
  );
}

/** 3725 -> "1 h 2 min 5 s". */
export function length(seconds: number): string {
  if (seconds < 60) return `${plain(seconds, 3)} s`;
  const whole = Math.round(seconds);
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor((whole % 3600) / 60)];
  return `${hours > 0 ? `${hours} h ` : ""}${minutes} min ${whole % 60} s`;
}

export function bytes(count: number): string {
  if (count < 1000) return `${count} B`;
  if (count < 1e6) return `${plain(count / 1e3)} kB`;
  if (count < 1e9) return `${plain(count / 1e6)} MB`;
  return `${plain(count / 1e9)} GB`;
}

export function date(iso: string): string {
  const at = new Date(iso);
  if (Number.isNaN(at.getTime())) return iso;
  return at.toLocaleString("en-GB", { dateStyle: "medium", timeStyle: "short" });
}
