import type { Workspace, WorkspaceRecording } from "../api/workspace";
import { element, labelled } from "../ui/dom";
import { isLeftOpen, repairAddress } from "./left_open";
import { date } from "../ui/words/moments";
import { plain } from "../ui/numbers";

const shownAtOnce = 300;

/** The recordings of the workspace, newest first, with a filter by name. It follows the folder. */
export class RecordingList {
  readonly root: HTMLElement;
  private all: readonly WorkspaceRecording[] = [];
  private readonly count = element("p", { class: "quiet", role: "status" });
  private readonly frame = element("div", { class: "table_frame" });
  private readonly filter = element("input", {
    type: "search",
    autocomplete: "off",
    spellcheck: "false",
    input: () => this.draw(),
  });

  constructor() {
    this.root = element(
      "section",
      { class: "recording_list" },
      element("div", { class: "row" }, labelled("Filter by name", this.filter), this.count),
      this.frame,
    );
  }

  show(workspace: Workspace): void {
    this.all = [...workspace.recordings].sort((a, b) => b.modified.localeCompare(a.modified));
    if (this.all.length > 0) return this.draw();
    this.count.textContent = "";
    this.frame.replaceChildren(element("p", {}, ...waysToARecording(` in ${workspace.folder}`)));
  }

  private draw(): void {
    const wanted = this.filter.value.trim().toLowerCase().split(/\s+/);
    const found = this.all.filter((it) => wanted.every((word) => it.name.toLowerCase().includes(word)));
    const timed = this.all.some((it) => it.seconds !== undefined);
    const heads = element(
      "tr",
      {},
      element("th", { scope: "col" }, "Name"),
      timed ? element("th", { scope: "col", class: "number" }, "Length") : null,
      element("th", { scope: "col", class: "number" }, "Size"),
      element("th", { scope: "col" }, "Changed"),
    );
    const focused = this.frame.contains(document.activeElement) ? document.activeElement?.getAttribute("href") : null;
    this.frame.replaceChildren(
      element(
        "table",
        {},
        element("thead", {}, heads),
        element("tbody", {}, ...found.slice(0, shownAtOnce).map((it) => row(it, timed))),
      ),
    );
    if (focused) this.frame.querySelector<HTMLElement>(`a[href="${focused}"]`)?.focus({ preventScroll: true });
    const more = found.length > shownAtOnce ? `; the newest ${shownAtOnce} are shown` : "";
    this.count.textContent = `${found.length} of ${this.all.length} recordings${more}`;
  }
}

function row(it: WorkspaceRecording, timed: boolean): HTMLElement {
  return element(
    "tr",
    {},
    element(
      "td",
      {},
      element("a", { href: `#/recording/${it.id}/time` }, it.name),
      it.partial ? element("p", { class: "partial" }, ...partialInWords(it)) : null,
    ),
    timed ? element("td", { class: "number" }, it.seconds === undefined ? "–" : length(it.seconds)) : null,
    element("td", { class: "number" }, bytes(it.bytes)),
    element("td", {}, date(it.modified)),
  );
}

function partialInWords(it: WorkspaceRecording): (string | HTMLElement)[] {
  if (!isLeftOpen(it)) return ["Being recorded."];
  const way = element("a", { href: repairAddress(it) }, "close it");
  return ["It ended without being closed: ", way, " (", element("code", {}, `kerf repair ${it.name}`), ")."];
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

/** What somebody sees who has none. */
export function waysToARecording(where = ""): (string | HTMLElement)[] {
  return [
    `No recording${where} yet: `,
    element("a", { href: "#/import" }, "import a file"),
    " (or drop it anywhere here), or record one on the ",
    element("a", { href: "#/scope" }, "scope"),
    ".",
  ];
}
