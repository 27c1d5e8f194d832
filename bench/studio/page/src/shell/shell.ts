import type { Api } from "../api/api";
import type { VerbForm } from "../api/jobs";
import { watchDrops } from "../intake/dropped";
import { slug } from "../jobs/verb_page";
import { resultName } from "../results/names";
import { element } from "../ui/dom";
import type { PageContext, View } from "../ui/view";

import type { Address } from "./address";
import { Commands, type Command } from "./keys/commands";
import { Help } from "./keys/help";
import { Palette } from "./keys/palette";
import { Shortcuts } from "./keys/shortcuts";
import { kinds, type Kind } from "./list/entries";
import { SideList } from "./list/side_list";
import { WorkspaceStore } from "./list/workspace_store";
import { byId, type Notice } from "./notice";
import { belongsTo, hiddenPages, pages } from "./pages";
import { Router } from "./router";
import { Side } from "./side";

/** What stays around the pages, and which of them is there. */
export class Shell {
  private readonly root = byId("view");
  private readonly links = new Map<string, HTMLAnchorElement>();
  private readonly commands = new Commands();
  private readonly store: WorkspaceStore;
  private readonly list: SideList;
  private readonly router: Router;
  private shown: { view: View; id: string } | null = null;
  private end: () => void = () => {};
  private tabListeners: (() => void)[] = [];
  private forms: readonly VerbForm[] = []; // of Work, once they are known

  constructor(
    private readonly api: Api,
    private readonly notice: Notice,
  ) {
    this.store = new WorkspaceStore(api);
    this.list = new SideList(api, this.store);
    const side = new Side(this.list.root);
    pages.forEach((view, k) => {
      const link = element("a", { href: `#/${view.name}`, title: `Ctrl + Alt + ${k + 1}` }, view.title);
      this.links.set(view.name, link);
      byId("places").append(link);
    });
    this.router = new Router((now) => this.show(now));
    const help = new Help(byId("help_opener"), this.commands);
    const palette = new Palette(this.commands, () => this.places());
    const openPalette = (): void => {
      palette.toggle();
      void this.learnForms();
    };
    byId("palette_opener").addEventListener("click", openPalette);
    this.commands.offer([
      { title: "Go to, do …", keys: "Ctrl+K", run: openPalette },
      { title: "Keys", keys: "?", run: () => help.toggle() },
      { title: "Show or hide the list", keys: "Ctrl+B", run: () => side.toggle() },
      {
        title: "Search the list",
        keys: "/",
        run: () => {
          side.open();
          this.list.focusSearch();
        },
      },
      { title: "Copy the address of this view", keys: "y", run: () => void this.copyAddress() },
      ...pages.map((view, k) => ({
        title: view.title,
        group: "Page",
        keys: `Ctrl+Alt+${k + 1}`,
        run: () => this.goTo(`#/${view.name}`),
      })),
    ]);
    new Shortcuts(this.commands);
    watchDrops(() => this.goTo("#/import"));
    byId("skip").addEventListener("click", (event) => {
      event.preventDefault(); // the address is the page's place
      this.focusHead();
    });
    this.show(this.router.address, true);
  }

  private goTo(hash: string): void {
    location.hash = hash;
  }

  private async learnForms(): Promise<void> {
    if (this.forms.length === 0) this.forms = await this.api.get<VerbForm[]>("/api/verbs").catch(() => []);
  }

  /** Whatever is in the folder, and what can be made of it, for the palette. */
  private places(): Command[] {
    const workspace = this.store.current;
    if (!workspace) return [];
    const results = { fit: ["Fit", "fits"], chart: ["Chart", "chart"], choice: ["Choice", "chart"] } as const;
    const place = (group: string, title: string, hash: string): Command => ({
      group,
      title,
      run: () => this.goTo(hash),
    });
    return [
      ...workspace.recordings.map((it) => place("Recording", it.name, `#/recording/${it.id}/time`)),
      ...workspace.files.filter((it) => it.kind === "study").map((it) => place("Study", it.name, `#/studies/${it.id}`)),
      ...workspace.sessions.map((it) => place("Session", it.name, `#/sessions/${it.id}`)),
      ...workspace.files.flatMap((it) => {
        if (it.kind !== "fit" && it.kind !== "chart" && it.kind !== "choice") return [];
        const [group, page] = results[it.kind];
        return [place(group, resultName(it), `#/${page}/${it.id}`)];
      }),
      ...this.forms.map((it) => place("Work", it.title, `#/work/${slug(it)}`)),
    ];
  }

  private async copyAddress(): Promise<void> {
    this.router.flush();
    try {
      await navigator.clipboard.writeText(location.href.replace(/token=[0-9a-f]+&?/, "").replace("/?#", "/#"));
      this.notice.say("The address is copied, without the studio's token.");
    } catch {
      this.notice.say("The browser does not let the page copy: take the address from its bar.");
    }
  }

  private show(address: Address, first = false): void {
    const view = [...pages, ...hiddenPages].find((it) => it.name === address.view) ?? pages[0]!;
    this.list.mark(kindOf(view.name), address.id);
    if (this.shown?.view === view && this.shown.id === address.id && this.tabListeners.length > 0) {
      for (const it of this.tabListeners) it();
      return;
    }
    this.end();
    this.store.look(); // what the page before has written
    this.shown = { view, id: address.id };
    this.notice.say("");
    for (const [name, link] of this.links) {
      if (name === (belongsTo[view.name] ?? view.name)) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
    document.title = `${view.title} – Kerf studio`;
    this.root.className = view.name;
    this.root.replaceChildren();
    this.mount(view);
    if (!first) this.focusHead();
  }

  private mount(view: View): void {
    const gone = new AbortController();
    const ends: (() => void)[] = [];
    this.tabListeners = [];
    const { router, notice } = this;
    const context: PageContext = {
      api: this.api,
      get place() {
        return router.address;
      },
      state: {
        get: (key) => router.address.state[key] ?? null,
        number: (key) => numberIn(router.address.state[key]),
        set: (values, step) => router.set(values, step),
        onChange: (listener) => ends.push(router.onState(listener)),
      },
      signal: gone.signal,
      go: (name, id = "", tab = "", state = {}, step = "push") => router.go({ view: name, id, tab, state }, step),
      say: (text) => notice.say(text),
      complain: (error) => notice.complain(error),
      focusHead: () => this.focusHead(),
      offer: (...commands) => {
        const end = this.commands.offer(commands);
        ends.push(end);
        return end;
      },
      onTab: (listener) => this.tabListeners.push(listener),
      onFolder: (listener) => ends.push(this.store.onChange(listener)),
      folder: () => this.store.now(gone.signal),
      lookAtFolder: () => this.store.look(),
    };
    const unmount = view.mount(this.root, context);
    this.end = () => {
      gone.abort();
      for (const it of ends) it();
      unmount();
    };
  }

  /** Whoever cannot see that the page has changed is told by the focus. */
  private focusHead(): void {
    const head = this.root.querySelector("h1");
    head?.setAttribute("tabindex", "-1");
    (head ?? this.root).focus({ preventScroll: true });
    this.root.scrollTop = 0;
  }
}

/** Which kind of the list a page shows one of. */
function kindOf(view: string): Kind | null {
  const name = belongsTo[view] ?? view;
  return kinds.find(([it]) => it === name)?.[0] ?? null;
}

function numberIn(text: string | undefined): number | null {
  const value = text === undefined || text === "" ? NaN : Number(text);
  return Number.isFinite(value) ? value : null;
}
