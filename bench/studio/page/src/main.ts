import "./studio.css";

import { Api } from "./api/api";
import { ForceBar } from "./ui/force/force_bar";
import { help, pageKeys } from "./ui/help";
import { element } from "./ui/dom";
import type { Place, View } from "./ui/view";
import { chart } from "./views/chart";
import { devices } from "./views/devices";
import { editor } from "./views/editor";
import { fits } from "./views/fits";
import { recordings } from "./views/recordings";
import { scope } from "./views/scope";
import { sessions } from "./views/sessions";
import { stability } from "./views/stability";
import { studies } from "./views/studies";

const views: readonly View[] = [scope, recordings, editor, fits, chart, stability, sessions, studies, devices];

function byId(id: string): HTMLElement {
  const node = document.getElementById(id);
  if (!node) throw new Error(`no element ${id}`);
  return node;
}

const api = new Api(document.querySelector<HTMLMetaElement>("meta[name=kerf-token]")?.content ?? "");
new ForceBar(api, byId("force_bar"), complain); // first: whatever fails below, Escape is heard
const root = byId("view");
const notice = byId("notice");
const links = new Map<string, HTMLAnchorElement>();
let end: () => void = () => {};

function placeOf(hash: string): Place {
  const [view = "", id = ""] = hash.replace(/^#\/?/, "").split("/");
  return { view: views.some((it) => it.name === view) ? view : "scope", id };
}

function say(text: string): void {
  notice.textContent = text;
  notice.classList.remove("wrong");
}

function complain(error: unknown): void {
  if (error instanceof DOMException && error.name === "AbortError") return;
  notice.textContent = error instanceof Error ? error.message : String(error);
  notice.classList.add("wrong");
}

function show(first = false): void {
  const place = placeOf(location.hash);
  const view = views.find((it) => it.name === place.view);
  if (!view) return;
  end();
  say("");
  for (const [name, link] of links) {
    if (name === place.view) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  document.title = `${view.title} – Kerf studio`;
  root.className = view.name;
  root.replaceChildren();
  end = view.mount(root, {
    api,
    place,
    go: (name, id = "") => {
      location.hash = id ? `#/${name}/${id}` : `#/${name}`;
    },
    say,
    complain,
    focusHead,
  });
  if (!first) focusHead();
}

/** Whoever cannot see that the page has changed is told by the focus. */
function focusHead(): void {
  const head = root.querySelector("h1");
  head?.setAttribute("tabindex", "-1");
  (head ?? root).focus({ preventScroll: true });
  scrollTo(0, 0);
}

for (const view of views) {
  const link = element("a", { href: `#/${view.name}`, title: `Ctrl + Alt + ${views.indexOf(view) + 1}` }, view.title);
  links.set(view.name, link);
  byId("places").append(link);
}
help(byId("help_opener") as HTMLButtonElement);
pageKeys((page) => {
  const view = views[page];
  if (view) location.hash = `#/${view.name}`;
});
byId("skip").addEventListener("click", (event) => {
  event.preventDefault(); // the address is the page's place
  focusHead();
});
addEventListener("hashchange", () => show());
show(true);
