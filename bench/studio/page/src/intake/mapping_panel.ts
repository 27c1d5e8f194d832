import { ApiError } from "../api/api";
import type { Mapping, Preview } from "../api/intake";
import { button, element, labelled, setOptions } from "../ui/dom";
import { Latest } from "../ui/latest";
import type { Context } from "../ui/view";
import { OptionsForm } from "./options_form";
import { PreviewTable } from "./preview_table";
import type { TakenFile } from "./taken_file";

const after_ms = 250; // of silence a changed mapping is tried

/**
 * How the columns of a file become channels: tried on the chosen file at once, kept as an import file. What a person has
 * chosen for one file goes for those whose columns are called the same.
 */
export class MappingPanel {
  readonly root: HTMLElement;
  private readonly map: HTMLInputElement;
  private readonly options = new OptionsForm(() => this.soon());
  private readonly table = new PreviewTable((map) => {
    this.map.value = map;
    this.soon();
  });
  private readonly saved: HTMLSelectElement;
  private readonly name: HTMLInputElement;
  private readonly verdict = element("p", { class: "verdict", role: "status" });
  private readonly confirm = button("Yes, these are the columns", () => {
    this.keep();
    void this.try();
  });
  private readonly warnings = element("ul", { class: "warnings" });
  private readonly latest: Latest;
  private file: TakenFile | null = null;
  private readonly byHand = new Map<string, Mapping>(); // by what the columns are called
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
      input: () => this.soon(),
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
      element("div", { class: "row" }, this.verdict, this.confirm),
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

  /** Tries the mapping of a file: its own, else that of its like, else what its columns suggest. */
  show(file: TakenFile | null): void {
    if (file === this.file) return;
    this.file = file;
    this.root.hidden = file === null;
    if (!file) {
      this.latest.end();
      this.table.clear();
      return;
    }
    this.put(this.known(file) ?? { map: "", options: {} });
    void this.try();
  }

  /** How a file is to be read; null where nobody has said what its columns are, nor does any line of it. */
  async mappingOf(file: TakenFile): Promise<Mapping | null> {
    const known = this.known(file);
    if (known) return known;
    const preview = await this.ask(file, { map: "", options: {} });
    file.columns = columnsOf(preview);
    return this.known(file) ?? (isGuess(preview) ? null : { map: preview.suggested.map, options: {} });
  }

  /** Whether something would come of a file, before anybody has chosen it. @returns why it is refused */
  async check(file: TakenFile): Promise<string> {
    try {
      const known = this.known(file) ?? { map: "", options: {} };
      let preview = await this.ask(file, known);
      if (!known.map) preview = await this.ask(file, { map: preview.suggested.map, options: {} });
      file.problem = problemOf(preview);
      return "";
    } catch (error) {
      if (error instanceof ApiError && error.status === 400) return error.message;
      return ""; // it is looked at again when it is chosen
    }
  }

  private known(file: TakenFile): Mapping | undefined {
    return file.mapping ?? this.byHand.get(file.columns);
  }

  private put({ map, options }: Mapping): void {
    this.map.value = map;
    this.options.value = options;
  }

  /** What is chosen now is a person's. */
  private keep(): void {
    const { file, mapping } = this;
    if (!file) return;
    file.mapping = mapping;
    if (file.columns) this.byHand.set(file.columns, mapping);
  }

  private soon(): void {
    this.saved.value = "";
    this.keep();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.try(), after_ms);
  }

  private async try(): Promise<void> {
    const { file } = this;
    if (!file) return;
    let preview: Preview | undefined;
    try {
      preview = await this.latest.ask(() => this.ask(file, this.mapping));
      if (!preview) return;
      file.columns = columnsOf(preview);
      if (!file.mapping && this.map.value === "") {
        this.put(this.known(file) ?? { map: preview.suggested.map, options: {} });
        preview = await this.latest.ask(() => this.ask(file, this.mapping));
      }
    } catch (error) {
      if (this.context.signal.aborted || file !== this.file) return;
      this.refuse(file, error instanceof Error ? error.message : String(error));
      return;
    }
    if (!preview) return;
    file.problem = problemOf(preview);
    this.tried(file, "");
    this.table.show(preview, this.map.value);
    this.say(preview, isGuess(preview) && !this.known(file));
  }

  private ask(file: TakenFile, { map, options }: Mapping): Promise<Preview> {
    return this.context.api.post<Preview>("/api/import/preview", { upload: file.upload, map, options });
  }

  /** A map that is none is said here; a file that nobody can read, at the file. */
  private refuse(file: TakenFile, why: string): void {
    this.fits = false;
    this.confirm.hidden = true;
    const isMap = why.startsWith("The mapping") || why.startsWith("'");
    this.verdict.className = "verdict wrong";
    this.verdict.textContent = why;
    this.warnings.hidden = true;
    if (isMap) return;
    this.table.clear();
    this.tried(file, why);
  }

  private say(preview: Preview, isGuessed: boolean): void {
    const problem = problemOf(preview);
    this.fits = problem === "";
    this.confirm.hidden = !this.fits || !isGuessed;
    this.verdict.className = this.fits && !isGuessed ? "verdict" : "verdict wrong";
    const part = preview.is_whole ? "" : "of the first million bytes ";
    const rows = `${preview.rows.toLocaleString("en-GB")} rows ${part}over ${(preview.seconds ?? 0).toPrecision(4)} s`;
    const guess = `No line names the columns: what each is below, and in what unit, is a guess (${rows}).`;
    this.verdict.textContent = problem || (isGuessed ? guess : `It fits: ${rows}.`);
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
      this.put(mapping);
      this.keep();
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

/** What tells files of one kind from others. */
function columnsOf({ columns }: Preview): string {
  return JSON.stringify(columns.map((it) => it.heading));
}

/** Why nothing would come of a file; empty if something would. */
function problemOf({ problem, rows }: Preview): string {
  if (problem || rows > 0) return problem;
  return "Nothing would come in: no line has a number in each column that is chosen.";
}

function isGuess({ layout }: Preview): boolean {
  return layout.header_line === 0;
}
