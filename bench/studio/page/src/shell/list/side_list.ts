import "./side_list.css";

import type { Api } from "../../api/api";
import type { StudyEntry } from "../../api/studies";
import type { Thumbnail, Workspace } from "../../api/workspace";
import { waysToARecording } from "../../recordings/recording_list";
import { button, element, select } from "../../ui/dom";
import { chosen, countOf, entriesOf, kinds, orders, type Entry, type Kind, type Order } from "./entries";
import { Thumbnails } from "./thumbnails";
import { VirtualList } from "./virtual_list";
import type { WorkspaceStore } from "./workspace_store";

const rowHeight = 44;
const setting = "kerf list";
const ages_ms = 15_000; // of a minute, which ages are told in

interface Choice {
  kind: Kind;
  order: Order;
}

/** What is in the folder, at the left of every page: searched, sorted, with what state it is in. */
export class SideList {
  readonly root: HTMLElement;
  private readonly search = element("input", {
    type: "search",
    class: "list_search",
    "aria-label": "Search the list",
    placeholder: "Search",
    autocomplete: "off",
    spellcheck: "false",
    input: () => this.show(),
    keydown: (event: KeyboardEvent) => this.down(event),
  });
  private readonly tabs: readonly (readonly [Kind, HTMLButtonElement])[];
  private readonly order: HTMLSelectElement;
  private readonly list: VirtualList<Entry>;
  private readonly count = element("p", { class: "list_count", role: "status" });
  private readonly thumbnails: Thumbnails;
  private choice: Choice = remembered();
  private studies: readonly StudyEntry[] = [];
  private open = ""; // id of what the page shows

  constructor(
    private readonly api: Api,
    private readonly store: WorkspaceStore,
  ) {
    this.thumbnails = new Thumbnails(api);
    this.order = select(orders, this.choice.order, (order) => this.choose({ order: order as Order }));
    this.order.setAttribute("aria-label", "Order of the list");
    this.tabs = kinds.map(([kind, text]) => [kind, button(text, () => this.choose({ kind }))] as const);
    this.list = new VirtualList(
      "In this folder",
      rowHeight,
      (it) => this.row(it),
      (a, b) => a.id === b.id && a.facts === b.facts && a.modified === b.modified && a.marks.join() === b.marks.join(),
    );
    this.root = element(
      "section",
      { class: "side_list", "aria-label": "In this folder" },
      element(
        "div",
        { class: "list_kinds", role: "group", "aria-label": "What is listed" },
        ...this.tabs.map(([, it]) => it),
      ),
      element("div", { class: "list_tools" }, this.search, this.order),
      this.list.root,
      this.count,
    );
    store.onChange((workspace) => this.take(workspace));
    setInterval(() => document.hidden || this.age(), ages_ms);
  }

  focusSearch(): void {
    this.search.focus();
    this.search.select();
  }

  /** The page shows this one now. */
  mark(kind: Kind | null, id: string): void {
    this.open = id;
    if (kind && kind !== this.choice.kind) this.choose({ kind });
    this.markRows();
  }

  private choose(changed: Partial<Choice>): void {
    this.choice = { ...this.choice, ...changed };
    localStorage.setItem(setting, JSON.stringify(this.choice));
    if (this.store.current) this.take(this.store.current);
  }

  private take(workspace: Workspace): void {
    if (this.choice.kind === "studies" && countOf("studies", workspace) > 0) void this.askForStudies(workspace);
    this.show();
  }

  private async askForStudies(workspace: Workspace): Promise<void> {
    try {
      this.studies = await this.api.get<StudyEntry[]>("/api/studies");
    } catch {
      return; // the page of studies says why
    }
    if (this.store.current === workspace) this.show();
  }

  private show(): void {
    const workspace = this.store.current;
    if (!workspace) return;
    const { kind, order } = this.choice;
    for (const [it, press] of this.tabs) {
      press.setAttribute("aria-pressed", String(it === kind));
      const count = countOf(it, workspace);
      press.title = `${count} ${it}`;
    }
    const all = entriesOf(kind, workspace, this.studies);
    const found = chosen(all, this.search.value, order);
    this.list.show(found);
    this.list.point(found.findIndex((it) => it.id === this.open));
    const of = found.length === all.length ? "" : ` of ${all.length.toLocaleString("en-GB")}`;
    const unlooked = workspace.unlooked > 0 ? `; ${workspace.unlooked} not looked into yet` : "";
    if (all.length === 0) this.count.replaceChildren(...none[kind]());
    else
      this.count.textContent = `${found.length.toLocaleString("en-GB")}${of} ${found.length === 1 ? one[kind] : kind}${unlooked}`;
    this.markRows();
  }

  private row(it: Entry): HTMLElement {
    const picture = element("span", { class: "list_picture" });
    const told = ({ flagged }: Thumbnail): void => {
      if (flagged > 0) picture.append(badge("flagged", `⚑ ${flagged}`));
    };
    if (this.choice.kind === "recordings") picture.append(this.thumbnails.of(it, told));
    const [name, folder] = inShort(it.name);
    return element(
      "a",
      { class: "list_row", href: it.address, title: it.name },
      picture.hasChildNodes() ? picture : null,
      element(
        "span",
        { class: "list_text" },
        element(
          "span",
          { class: "list_name" },
          element("bdi", {}, name),
          folder ? element("span", { class: "list_folder" }, ` ${folder}`) : null,
        ),
        element(
          "span",
          { class: "list_more" },
          element("span", { class: "list_facts" }, it.facts),
          it.marks.length > 0 ? badge(it.marks.join(" ")) : null,
        ),
      ),
    );
  }

  /** Ages go on in the rows that are there, which keep their focus. */
  private age(): void {
    for (const [{ facts }, row] of this.list.rows()) {
      const told = row.querySelector(".list_facts");
      if (told && told.textContent !== facts) told.textContent = facts;
    }
  }

  private markRows(): void {
    for (const [it, row] of this.list.rows()) {
      if (it.id === this.open && this.open !== "") row.setAttribute("aria-current", "page");
      else row.removeAttribute("aria-current");
    }
  }

  private down(event: KeyboardEvent): void {
    if (event.key !== "ArrowDown" && event.key !== "Enter") return;
    event.preventDefault();
    this.list.focus();
  }
}

const one: Record<Kind, string> = { recordings: "recording", studies: "study", sessions: "session" };
const none: Record<Kind, () => (string | HTMLElement)[]> = {
  recordings: waysToARecording,
  studies: () => ["No study yet: ", element("a", { href: "#/studies" }, "how one is made"), "."],
  sessions: () => ["No session yet: ", element("a", { href: "#/sessions" }, "how one is made"), "."],
};

/** What a file is called and where it lies: "cut" and "day_2"; of a study's "recording.h5" the other way round. */
function inShort(path: string): [string, string] {
  const parts = path.split("/");
  const file = (parts.pop() ?? path).replace(/\.h5$/, "");
  const folder = parts.pop() ?? "";
  return /^recording$/.test(file) && folder ? [folder, file] : [file, folder];
}

const alarming = ["flagged", "not closed", "unreadable", "changed"];

function badge(name: string, text = name): HTMLElement {
  return element("span", { class: `mark_badge${alarming.includes(name) ? " alarming" : ""}`, title: name }, text);
}

function remembered(): Choice {
  const usual: Choice = { kind: "recordings", order: "newest" };
  try {
    const kept = JSON.parse(localStorage.getItem(setting) ?? "{}") as Partial<Choice>;
    const kind = kinds.find(([it]) => it === kept.kind)?.[0] ?? usual.kind;
    const order = orders.find((it) => it.value === kept.order)?.value ?? usual.order;
    return { kind, order };
  } catch {
    return usual;
  }
}
