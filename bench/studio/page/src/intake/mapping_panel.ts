import type { Mapping, Preview } from "../api/intake";
import { button, element, labelled, setOptions } from "../ui/dom";
import { Latest } from "../ui/latest";
import type { Context } from "../ui/view";
import { OptionsForm } from "./options_form";
import { PreviewTable } from "./preview_table";
import type { TakenFile } from "./taken_file";

const after_ms = 250; // of silence a changed mapping is tried

/** How the columns of the files become channels: tried on the chosen file at once, kept as an import file. */
export class MappingPanel {
  readonly root: HTMLElement;
  private readonly map: HTMLInputElement;
  private readonly options = new OptionsForm(() => this.soon());
  private readonly table = new PreviewTable((map) => {
    this.map.value = map;
    this.touched = true;
    this.soon();
  });
  private readonly saved: HTMLSelectElement;
  private readonly name: HTMLInputElement;
  private readonly verdict = element("p", { class: "verdict", role: "status" });
  private readonly warnings = element("ul", { class: "warnings" });
  private readonly latest: Latest;
  private file: TakenFile | null = null;
  private touched = false; // by a person: what the next file suggests does not take its place
  private timer = 0;
  /** The preview of the chosen file fits. */
  fits = false;

  constructor(
    private readonly context: Context,
    private readonly tried: (file: TakenFile, refusal: string) => void,
  ) {
    this.latest = new Latest(context.signal);
    this.map = element("input", {
      class: "map",
      spellcheck: "false",
      maxlength: 4000,
      input: () => {
        this.touched = true;
        this.soon();
      },
    });
    this.saved = element("select", { change: () => void this.load(this.saved.value) });
    this.name = element("input", {
      maxlength: 60,
      spellcheck: "false",
      placeholder: "a name",
      "aria-label": "Name to save the mapping under",
    });
    this.root = element(
      "section",
      { class: "mapping", "aria-label": "Mapping" },
      element(
        "div",
        { class: "row mapping_head" },
        labelled("Mapping as text", this.map),
        labelled("Saved mappings", this.saved),
        element(
          "div",
          { class: "save_mapping" },
          this.name,
          button("Save mapping", () => void this.save(false)),
        ),
        this.options.root,
      ),
      this.verdict,
      this.warnings,
      this.table.root,
    );
    context.signal.addEventListener("abort", () => clearTimeout(this.timer));
  }

  get mapping(): Mapping {
    return { map: this.map.value.trim(), options: this.options.value };
  }

  offer(mappings: readonly { id: string; name: string }[]): void {
    setOptions(this.saved, [
      { value: "", text: mappings.length > 0 ? "– as below –" : "– none –" },
      ...mappings.map((it) => ({ value: it.id, text: it.name.replace(/\.import\.toml$/, "") })),
    ]);
  }

  /** Tries the mapping on a file; one that nobody has touched gives way to what the file suggests. */
  show(file: TakenFile | null): void {
    if (file === this.file) return;
    this.file = file;
    this.root.hidden = file === null;
    if (!file) {
      this.latest.end();
      this.table.clear();
      return;
    }
    if (!this.touched) this.map.value = "";
    void this.try();
  }

  private soon(): void {
    this.saved.value = "";
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.try(), after_ms);
  }

  private async try(): Promise<void> {
    const { file, mapping } = this;
    if (!file) return;
    let preview: Preview | undefined;
    try {
      preview = await this.latest.ask(() => this.ask(file, mapping));
      if (preview && mapping.map === "" && !this.touched) {
        mapping.map = this.map.value = preview.suggested.map;
        preview = await this.latest.ask(() => this.ask(file, mapping));
      }
    } catch (error) {
      if (this.context.signal.aborted || file !== this.file) return;
      this.refuse(file, error instanceof Error ? error.message : String(error));
      return;
    }
    if (!preview) return;
    this.tried(file, "");
    this.table.show(preview, this.map.value);
    this.say(preview, preview.problem);
  }

  private ask(file: TakenFile, { map, options }: Mapping): Promise<Preview> {
    return this.context.api.post<Preview>("/api/import/preview", { upload: file.upload, map, options });
  }

  /** A map that is none is said here; a file that nobody can read, at the file. */
  private refuse(file: TakenFile, why: string): void {
    this.fits = false;
    const isMap = why.startsWith("The mapping") || why.startsWith("'");
    this.verdict.className = "verdict wrong";
    this.verdict.textContent = why;
    this.warnings.hidden = true;
    if (isMap) return;
    this.table.clear();
    this.tried(file, why);
  }

  private say(preview: Preview, problem: string): void {
    this.fits = problem === "" && preview.rows > 0;
    this.verdict.className = this.fits ? "verdict" : "verdict wrong";
    const part = preview.is_whole ? "" : "of the first million bytes ";
    const rows = `${preview.rows.toLocaleString("en-GB")} rows ${part}over ${(preview.seconds ?? 0).toPrecision(4)} s`;
    const none = "Nothing would come in: no line has a number in each column that is chosen.";
    this.verdict.textContent = problem || (this.fits ? `It fits: ${rows}.` : none);
    const said = [...preview.notes, ...preview.warnings];
    this.warnings.hidden = said.length === 0;
    this.warnings.replaceChildren(
      ...said.map((it) => element("li", {}, element("span", { "aria-hidden": "true" }, "⚠"), element("span", {}, it))),
    );
  }

  private async load(id: string): Promise<void> {
    if (!id) return;
    try {
      const mapping = await this.context.api.get<Mapping>("/api/import/mapping", { id }, this.context.signal);
      this.map.value = mapping.map;
      this.options.value = mapping.options;
      this.touched = true;
      await this.try();
    } catch (error) {
      this.context.complain(error);
    }
  }

  private async save(replace: boolean): Promise<void> {
    const { context } = this;
    try {
      const name = this.name.value.trim();
      const saved = await context.api.post<{ name: string }>("/api/import/mapping", { name, replace, ...this.mapping });
      context.say(`Saved as ${saved.name}: it is offered for further files, and the program takes it too.`);
      context.lookAtFolder();
    } catch (error) {
      context.complain(error);
    }
  }
}
