import type { Recording, RecordingInspection } from "../api/recordings";
import type { Workspace, WorkspaceRecording } from "../api/workspace";
import { element } from "../ui/dom";
import type { Context, OpenRecording, PageContext } from "../ui/view";
import { factsInShort } from "./facts";
import { recordingTabs } from "./registry";
import { TabStrip } from "./tab_strip";

/** One recording with its tabs: what is around the tab stays while they change. */
export class RecordingPage {
  private readonly head = element("h1", {});
  private readonly facts = element("p", { class: "recording_facts" });
  private readonly strip: TabStrip;
  private readonly panel = element("div", { class: "tab_panel", role: "tabpanel", id: "tab_panel" });
  private recording: OpenRecording | null = null;
  private found: "" | "changed" | "damaged" | "gone" = ""; // of the file, since it was read
  private writers = 0; // of the file, within this page
  private end: () => void = () => {};

  constructor(
    root: HTMLElement,
    private readonly context: PageContext,
  ) {
    this.strip = new TabStrip(recordingTabs, (tab) => this.go(tab));
    this.head.textContent = "Recording";
    root.append(element("div", { class: "recording_head" }, this.head, this.strip.root, this.facts), this.panel);
    context.onTab(() => this.show());
    context.onFolder((workspace) => this.compare(workspace));
    context.offer(
      { title: "Read the recording anew", group: "Recording", keys: "r", run: () => void this.open() },
      ...recordingTabs.map((tab, k) => ({
        title: `Show the tab ${tab.title}`,
        group: "Recording",
        keys: String(k + 1),
        run: () => this.go(tab.name),
      })),
    );
    void this.open();
  }

  close(): void {
    this.end();
  }

  private get tab(): string {
    const { tab } = this.context.place;
    return recordingTabs.some((it) => it.name === tab) ? tab : recordingTabs[0]!.name;
  }

  /** The state goes along. */
  private go(tab: string): void {
    const { place, go } = this.context;
    go("recording", place.id, tab, place.state);
  }

  private async open(): Promise<void> {
    const { api, place, signal } = this.context;
    const { id } = place;
    this.strip.mark(this.tab);
    try {
      const [workspace, about] = await Promise.all([
        this.context.folder(),
        api.get<Recording>("/api/recording", { id }, signal),
      ]);
      const entry = workspace.recordings.find((it) => it.id === id);
      const name = entry?.name ?? id;
      this.recording = {
        ...{ id, name, about, workspace },
        inspection: this.inspectOnce(id),
        writing: () => this.beginWriting(),
        reload: () => void this.open(),
      };
      if (this.found) this.context.say("");
      this.found = "";
      const file = name.lastIndexOf("/") + 1;
      this.head.replaceChildren(
        element("span", { class: "head_folder" }, name.slice(0, file)),
        element("span", { class: "head_file" }, name.slice(file)),
      );
      this.head.title = name;
      this.tellFacts(about, entry);
      this.show();
    } catch (error) {
      if (signal.aborted) return;
      this.context.complain(error);
      const why = error instanceof Error ? error.message : String(error);
      this.panel.replaceChildren(element("p", { class: "empty" }, `${why}. Choose another in the list.`));
    }
  }

  private tellFacts(about: Recording, entry: WorkspaceRecording | undefined): void {
    const text = factsInShort(about, entry);
    if (this.facts.textContent !== text) this.facts.textContent = this.facts.title = text;
  }

  private beginWriting(): (written: boolean, read?: () => void) => void {
    ++this.writers;
    let ended = false;
    return (written, read) => {
      if (ended) return;
      ended = true;
      void (written ? this.readQuietly() : Promise.resolve()).finally(() => {
        --this.writers;
        if (written) read?.();
      });
    };
  }

  /** What the page has written itself, into what its tabs hold. */
  private async readQuietly(): Promise<void> {
    const { recording, context } = this;
    if (!recording) return;
    const { id } = recording;
    try {
      const [workspace, about] = await Promise.all([
        context.folder(),
        context.api.get<Recording>("/api/recording", { id }, context.signal),
      ]);
      Object.assign(recording, { about, workspace, inspection: this.inspectOnce(id) });
    } catch {
      // what is shown is of before, and the next look at the folder says so
    }
  }

  /** With what is in the folder now: what has changed is read anew, unless somebody is at work on what is shown. */
  private compare(workspace: Workspace): void {
    if (!this.recording || this.writers > 0) return;
    const { id, name, workspace: read } = this.recording;
    const then = read.recordings.find((it) => it.id === id);
    const now = workspace.recordings.find((it) => it.id === id);
    this.tellFacts(this.recording.about, now);
    const isOther = now && !now.partial && then && (now.modified !== then.modified || now.bytes !== then.bytes);
    const found = !now ? "gone" : now.damaged ? "damaged" : isOther ? "changed" : "";
    if (found === this.found) return;
    const wasAway = this.found === "gone" || this.found === "damaged";
    this.found = found;
    if (found === "gone") this.context.say(`${name} is not in the folder any more: what is shown was read before.`);
    else if (found === "damaged")
      this.context.say(`${name} is damaged, and cannot be read any more: what is shown was read before.`);
    else if (this.isAtWork() && found === "changed")
      this.context.say(`${name} has changed in the folder: press R to read it anew.`);
    else
      void this.open().then(() =>
        this.context.say(wasAway ? "" : `${name} has changed in the folder, and was read anew.`),
      );
  }

  /** Somebody draws, mends or types, and would lose their place. */
  private isAtWork(): boolean {
    const types =
      this.panel.contains(document.activeElement) && document.activeElement?.matches("input, select, textarea");
    return types === true || this.tab === "cycles" || this.tab === "law";
  }

  /** Begins the tab of the address; what is there of the one before ends. */
  private show(): void {
    const { recording, tab } = this;
    const chosen = recordingTabs.find((it) => it.name === tab);
    if (!recording || !chosen) return;
    this.end();
    this.strip.mark(tab);
    document.title = `${recording.name}: ${chosen.title} – Kerf studio`;
    this.panel.className = `tab_panel tab_${tab}`;
    this.panel.setAttribute("aria-labelledby", `tab_${tab}`);
    this.panel.replaceChildren();
    const { context, end } = forTab(this.context);
    const unmount = chosen.mount(this.panel, context, recording);
    this.end = () => {
      this.end = () => {};
      end();
      unmount();
    };
  }

  /** After what is seen first: it takes a second where there are a million rows. */
  private inspectOnce(id: string): () => Promise<RecordingInspection> {
    const { api, signal } = this.context;
    let found: Promise<RecordingInspection> | null = null;
    return () =>
      (found ??= new Promise((go) => setTimeout(go, 200)).then(() =>
        api.get<RecordingInspection>("/api/recording/inspection", { id }, signal),
      ));
  }
}

/** What a tab is given ends with the tab, not with the page. */
function forTab(page: PageContext): { context: Context; end: () => void } {
  const gone = new AbortController();
  const ends: (() => void)[] = [];
  const context: Context = {
    ...page,
    get place() {
      return page.place;
    },
    signal: gone.signal,
    state: { ...page.state, onChange: (listener) => page.state.onChange(() => gone.signal.aborted || listener()) },
    folder: async () => {
      const workspace = await page.folder();
      gone.signal.throwIfAborted();
      return workspace;
    },
    onFolder: (listener) => page.onFolder((it) => gone.signal.aborted || listener(it)),
    offer: (...commands) => {
      const take = page.offer(...commands);
      ends.push(take);
      return take;
    },
  };
  return {
    context,
    end: () => {
      gone.abort();
      for (const it of ends) it();
    },
  };
}
