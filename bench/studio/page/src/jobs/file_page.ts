import type { Trashed } from "../api/jobs";
import { bytes } from "../recordings/recording_list";
import { date } from "../ui/words/moments";
import { button, element, labelled } from "../ui/dom";
import type { Context } from "../ui/view";

interface ChangeableFile {
  id: string;
  kind: "recording" | "law";
  name: string;
  takesNotes: boolean;
}

/** Recordings and laws as files: renamed, annotated, deleted, and had back. */
export class FilePage {
  readonly root = element("section", { class: "file_page", "aria-label": "Files" });
  private readonly told = element("p", { class: "undo", role: "status" });
  private readonly rows = element("tbody");
  private readonly trash = element("ul", {});
  private readonly trashHead = element("h3", {}, "Trash");
  private readonly empty = button("Empty the trash", () => this.act("/api/trash/empty", {}, "The trash is empty."));

  constructor(private readonly context: Context) {
    const filter = element("input", { type: "search", autocomplete: "off", input: () => this.filter(filter.value) });
    this.root.append(
      labelled("Filter by name", filter),
      this.told,
      element(
        "div",
        { class: "table_frame" },
        element(
          "table",
          {},
          element("caption", { class: "unseen" }, "Recordings and laws"),
          element("thead", {}, element("tr", {}, ...["Name", "", ""].map((it) => element("th", { scope: "col" }, it)))),
          this.rows,
        ),
      ),
      this.trashHead,
      this.trash,
      this.empty,
    );
    void this.load();
  }

  private async load(): Promise<void> {
    const { api, folder, signal, complain } = this.context;
    try {
      const workspace = await folder();
      const trash = await api.get<Trashed[]>("/api/trash", {}, signal);
      const files: ChangeableFile[] = [
        ...workspace.recordings
          .filter((it) => !it.partial)
          .map(({ id, name }) => ({ id, name, kind: "recording" as const, takesNotes: true })),
        ...workspace.laws.map(({ id, name }) => ({ id, name, kind: "law" as const, takesNotes: false })),
      ];
      this.rows.replaceChildren(...files.map((it) => this.row(it)));
      this.trash.replaceChildren(...trash.map((it) => this.trashed(it)));
      this.trashHead.hidden = this.empty.hidden = trash.length === 0;
    } catch (error) {
      complain(error);
    }
  }

  private row(file: ChangeableFile): HTMLElement {
    const more = element("td", { colspan: 2 });
    const actions = (): HTMLElement =>
      element(
        "div",
        { class: "row" },
        button("Rename", () => this.edit(file, more, actions, "rename"), { "aria-label": `Rename ${file.name}` }),
        file.takesNotes
          ? button("Note", () => this.edit(file, more, actions, "annotate"), { "aria-label": `Note on ${file.name}` })
          : null,
        button("Delete", () => this.remove(file), { "aria-label": `Delete ${file.name}` }),
      );
    more.append(actions());
    return element("tr", { "data-name": file.name.toLowerCase() }, element("th", { scope: "row" }, file.name), more);
  }

  /** A field in the place of the buttons; Escape puts them back. */
  private edit(file: ChangeableFile, place: HTMLElement, back: () => HTMLElement, how: "rename" | "annotate"): void {
    const stem = file.name.replace(/.*\//, "").replace(/(\.law\.toml|\.h5)$/, "");
    const text = element("input", {
      type: "text",
      autocomplete: "off",
      value: how === "rename" ? stem : "",
      maxlength: how === "rename" ? 80 : 200,
    });
    const at = element("input", { type: "number", step: "any", placeholder: "none" });
    const end = (): void => place.replaceChildren(back());
    const send = (event: Event): void => {
      event.preventDefault();
      const body: Record<string, unknown> = { id: file.id, kind: file.kind };
      if (how === "rename") body.name = text.value.trim();
      else body.text = text.value.trim();
      if (how === "annotate" && at.value !== "") body.time_s = Number(at.value);
      const said =
        how === "rename" ? `${file.name} has the name ${text.value.trim()} now.` : `The note stands in ${file.name}.`;
      this.act(`/api/files/${how}`, body, said);
    };
    const form = element(
      "form",
      {
        class: "row",
        submit: send,
        keydown: (event: KeyboardEvent) => {
          if (event.key !== "Escape") return;
          end();
          place.querySelector("button")?.focus();
        },
      },
      labelled(how === "rename" ? "New name" : "Note", text),
      how === "annotate" ? labelled("At [s]", at) : null,
      element("button", { type: "submit", class: "firm" }, how === "rename" ? "Rename" : "Keep"),
      button("Leave it", end),
    );
    place.replaceChildren(form);
    text.focus();
    text.select();
  }

  private remove(file: ChangeableFile): void {
    this.context.api.post<{ key: string }>("/api/files/delete", { id: file.id, kind: file.kind }).then(({ key }) => {
      this.say(`${file.name} is in the trash.`, () => this.restore(key, file.name));
      this.context.lookAtFolder();
      return this.load();
    }, this.context.complain);
  }

  private restore(key: string, name: string): void {
    this.act("/api/trash/restore", { key }, `${name} is back.`);
  }

  private trashed(it: Trashed): HTMLElement {
    const back = button("Put back", () => this.restore(it.key, it.name), { "aria-label": `Put back ${it.name}` });
    return element(
      "li",
      { class: "row" },
      element("span", {}, `${it.name} (${bytes(it.bytes)}), ${date(it.time)}`),
      back,
    );
  }

  private act(path: string, body: unknown, said: string): void {
    this.context.say("");
    this.context.api.post(path, body).then(() => {
      this.say(said);
      this.context.lookAtFolder();
      return this.load();
    }, this.context.complain);
  }

  private say(text: string, undo?: () => void): void {
    this.told.replaceChildren(text, ...(undo ? [" ", button("Undo", undo)] : []));
  }

  private filter(text: string): void {
    const words = text.trim().toLowerCase().split(/\s+/);
    for (const row of this.rows.children)
      if (row instanceof HTMLElement) row.hidden = !words.every((it) => (row.dataset.name ?? "").includes(it));
  }
}
