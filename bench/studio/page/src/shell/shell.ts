import type { Api } from "../api/api";
import { element } from "../ui/dom";
import { help, pageKeys } from "../ui/help";
import type { PageContext, View } from "../ui/view";
import type { Address } from "./address";
import { Commands } from "./commands";
import { belongsTo, hiddenPages, pages } from "./pages";
import { Router } from "./router";

interface Parts {
  readonly root: HTMLElement;
  readonly places: HTMLElement;
  readonly help: HTMLElement;
  readonly skip: HTMLElement;
  readonly say: (text: string) => void;
  readonly complain: (error: unknown) => void;
}

/** What stays around the pages, and which of them is there. */
export class Shell {
  private readonly links = new Map<string, HTMLAnchorElement>();
  private readonly commands = new Commands();
  private readonly router: Router;
  private shown: { view: View; id: string } | null = null;
  private end: () => void = () => {};
  private tabListeners: (() => void)[] = [];

  constructor(
    private readonly api: Api,
    private readonly parts: Parts,
  ) {
    for (const view of pages) {
      const keys = `Ctrl + Alt + ${pages.indexOf(view) + 1}`;
      const link = element("a", { href: `#/${view.name}`, title: keys }, view.title);
      this.links.set(view.name, link);
      parts.places.append(link);
    }
    help(parts.help as HTMLButtonElement);
    pageKeys((page) => {
      const view = pages[page];
      if (view) location.hash = `#/${view.name}`;
    });
    parts.skip.addEventListener("click", (event) => {
      event.preventDefault(); // the address is the page's place
      this.focusHead();
    });
    this.router = new Router((now) => this.show(now));
    this.show(this.router.address, true);
  }

  private show(address: Address, first = false): void {
    const view = [...pages, ...hiddenPages].find((it) => it.name === address.view) ?? pages[0]!;
    if (this.shown?.view === view && this.shown.id === address.id && this.tabListeners.length > 0) {
      for (const it of this.tabListeners) it();
      return;
    }
    this.end();
    this.shown = { view, id: address.id };
    this.parts.say("");
    for (const [name, link] of this.links) {
      if (name === (belongsTo[view.name] ?? view.name)) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
    document.title = `${view.title} – Kerf studio`;
    this.parts.root.className = view.name;
    this.parts.root.replaceChildren();
    this.mount(view);
    if (!first) this.focusHead();
  }

  private mount(view: View): void {
    const gone = new AbortController();
    const ends: (() => void)[] = [];
    this.tabListeners = [];
    const { router } = this;
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
      say: this.parts.say,
      complain: this.parts.complain,
      focusHead: () => this.focusHead(),
      offer: (...commands) => {
        const end = this.commands.offer(commands);
        ends.push(end);
        return end;
      },
      onTab: (listener) => this.tabListeners.push(listener),
    };
    const unmount = view.mount(this.parts.root, context);
    this.end = () => {
      gone.abort();
      for (const it of ends) it();
      unmount();
    };
  }

  /** Whoever cannot see that the page has changed is told by the focus. */
  private focusHead(): void {
    const { root } = this.parts;
    const head = root.querySelector("h1");
    head?.setAttribute("tabindex", "-1");
    (head ?? root).focus({ preventScroll: true });
    scrollTo(0, 0);
  }
}

function numberIn(text: string | undefined): number | null {
  const value = text === undefined || text === "" ? NaN : Number(text);
  return Number.isFinite(value) ? value : null;
}
