import type { SessionLook, SessionState } from "../api/sessions";
import type { WorkspaceSession } from "../api/workspace";
import { element, labelled } from "../ui/dom";
import type { Context } from "../ui/view";
import { qualityRows } from "./quality_rows";

/** How the trials of the session that runs go; nothing of what was felt or answered. */
export function liveQuality(): { root: HTMLElement; show: (state: SessionState) => void } {
  const list = element("dl", { class: "quality", "aria-label": "How its trials went" });
  const cells = qualityRows.map((row) => {
    const cell = element("dd", { class: "number" }, "–");
    list.append(element("div", {}, element("dt", {}, row.head), cell));
    return cell;
  });
  list.hidden = true;
  return {
    root: list,
    show(state) {
      const { quality } = state;
      list.hidden = quality === null;
      if (quality === null) return;
      qualityRows.forEach((row, i) => {
        const text = row.text(quality);
        const cell = cells[i];
        if (cell && cell.textContent !== text) cell.textContent = text;
      });
    },
  };
}

interface Told {
  session: WorkspaceSession;
  look: SessionLook | null;
  error: string;
}

function tableOf(told: readonly Told[]): HTMLElement {
  const heads = ["Session", "Subject", "State", ...qualityRows.map((row) => row.head)];
  const rows = told.flatMap(({ session, look, error }) => {
    if (look === null)
      return [
        element(
          "tr",
          {},
          element("th", { scope: "row" }, session.name),
          element("td", {}, session.subject),
          element("td", { colspan: qualityRows.length + 1 }, error),
        ),
      ];
    const row = element(
      "tr",
      {},
      element("th", { scope: "row" }, session.name),
      element("td", {}, look.subject),
      element("td", {}, look.finished ? "finished" : look.quality.given > 0 ? "under way" : "not begun"),
      ...qualityRows.map((row) => element("td", { class: "number" }, row.text(look.quality))),
    );
    if (look.notes.length === 0) return [row];
    const written = look.notes.map((it) => element("li", {}, `${it.time} ${it.text}`));
    return [
      row,
      element(
        "tr",
        {},
        element("th", { scope: "row", class: "quiet" }, "Notes"),
        element("td", { colspan: heads.length - 1 }, element("ul", { class: "notes" }, ...written)),
      ),
    ];
  });
  return element(
    "div",
    { class: "scrolled", tabindex: 0, role: "region", "aria-label": "How the trials of each session went" },
    element(
      "table",
      {},
      element("caption", {}, "Sums over the trials of each session, of no sample, slot, level or answer"),
      element("thead", {}, element("tr", {}, ...heads.map((it) => element("th", { scope: "col" }, it)))),
      element("tbody", {}, ...rows),
    ),
  );
}

/** The same of sessions of the folder, on demand: each is opened with the key. */
export function folderQuality(
  context: Context,
  sessions: () => readonly WorkspaceSession[],
  words: { head: string; read: string },
): HTMLElement {
  const passphrase = element("input", { type: "password", autocomplete: "off" });
  const found = element("div", { "aria-live": "polite" });
  const ask = async (): Promise<void> => {
    const told: Told[] = [];
    const given = passphrase.value;
    passphrase.value = "";
    for (const session of sessions()) {
      context.say(`Reading ${session.name}`);
      try {
        const look = await context.api.post<SessionLook>("/api/session/quality", {
          session: session.id,
          passphrase: given,
        });
        told.push({ session, look, error: "" });
      } catch (error) {
        told.push({ session, look: null, error: error instanceof Error ? error.message : String(error) });
      }
    }
    context.say("");
    found.replaceChildren(
      told.length > 0 ? tableOf(told) : element("p", { class: "quiet" }, "There is no session in this folder."),
    );
  };
  return element(
    "section",
    { class: "folder_quality", "aria-label": words.head },
    element("h2", {}, words.head),
    element(
      "form",
      {
        class: "ask",
        submit: (event: SubmitEvent) => {
          event.preventDefault();
          ask().catch(context.complain);
        },
      },
      labelled("Passphrase, for sessions that were sealed with one", passphrase),
      element("button", { type: "submit" }, words.read),
    ),
    found,
  );
}
