import "./studio.css";

import { Api } from "./api/api";
import { Shell } from "./shell/shell";
import { ForceBar } from "./ui/force/force_bar";

function byId(id: string): HTMLElement {
  const node = document.getElementById(id);
  if (!node) throw new Error(`no element ${id}`);
  return node;
}

const notice = byId("notice");

function complain(error: unknown): void {
  if (error instanceof DOMException && error.name === "AbortError") return;
  notice.textContent = error instanceof Error ? error.message : String(error);
  notice.classList.add("wrong");
}

function say(text: string): void {
  notice.textContent = text;
  notice.classList.remove("wrong");
}

const api = new Api(document.querySelector<HTMLMetaElement>("meta[name=kerf-token]")?.content ?? "");
new ForceBar(api, byId("force_bar"), complain); // first: whatever fails below, Escape is heard
new Shell(api, {
  root: byId("view"),
  places: byId("places"),
  help: byId("help_opener"),
  skip: byId("skip"),
  say,
  complain,
});
