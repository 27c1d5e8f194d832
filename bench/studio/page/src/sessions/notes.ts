import type { SessionNote, SessionState } from "../api/sessions";
import { element, labelled } from "../ui/dom";
import type { Context } from "../ui/view";

export const longestNote = 500;

function line(note: SessionNote): HTMLElement {
  return element("li", {}, element("time", { datetime: note.time, class: "quiet" }, note.time), ` ${note.text}`);
}

/** What the experimenter writes while a session runs: for everybody to read, with its time. */
export function notes(context: Context): { root: HTMLElement; show: (state: SessionState) => void } {
  const text = element("input", { type: "text", maxlength: longestNote, autocomplete: "off" });
  const list = element("ul", { class: "notes", "aria-label": "Notes" });
  const form = element(
    "form",
    {
      class: "ask",
      submit: (event: SubmitEvent) => {
        event.preventDefault();
        const written = text.value.trim();
        if (written === "") return;
        context.api.post("/api/session/note", { text: written }).then(() => {
          text.value = "";
        }, context.complain);
      },
    },
    labelled("Note, for everybody to read: nothing that tells samples or answers", text),
    element("button", { type: "submit" }, "Keep the note"),
  );
  const root = element("div", { class: "note_panel" }, form, list);
  root.hidden = true;
  return {
    root,
    show(state) {
      root.hidden = !state.running && state.notes.length === 0;
      form.hidden = !state.running;
      if (list.childElementCount !== state.notes.length) list.replaceChildren(...state.notes.map(line));
    },
  };
}
