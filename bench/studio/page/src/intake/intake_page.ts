import { ApiError } from "../api/api";
import type { ImportResult, IntakeOverview, Mapping } from "../api/intake";
import { button, element } from "../ui/dom";
import { whyNoName } from "../ui/file_names";
import type { PageContext } from "../ui/view";
import { onDropped } from "./dropped";
import { FileList } from "./file_list";
import { Imported } from "./imported";
import { ImportJob } from "./import_job";
import { recordingName } from "./mapping";
import { MappingPanel } from "./mapping_panel";
import { takenFile, type TakenFile } from "./taken_file";
import { Uploader } from "./uploader";

/** Files of other programs taken in: handed over, looked at, mapped, imported. */
export class IntakePage {
  private files: TakenFile[] = [];
  private chosen: TakenFile | null = null;
  private uploader: Uploader | null = null;
  private taken = new Set<string>(); // names of recordings of the folder
  private sending: Promise<void> = Promise.resolve();
  private isStarting = false;
  private readonly list: FileList;
  private readonly mapping: MappingPanel;
  private readonly imported: Imported;
  private readonly job: ImportJob;
  private readonly go: HTMLButtonElement;
  private readonly clear: HTMLButtonElement;
  private readonly hint: HTMLElement;

  constructor(
    root: HTMLElement,
    private readonly context: PageContext,
  ) {
    this.list = new FileList({
      choose: (file) => this.choose(file),
      remove: (file) => this.remove(file),
      rename: (file, name) => {
        file.recording = name;
        this.show();
      },
    });
    this.mapping = new MappingPanel(context, (file, refusal) => this.tried(file, refusal));
    this.imported = new Imported(context);
    this.job = new ImportJob(context, (state, error) => void this.importEnded(state, error));
    const picker = element("input", {
      type: "file",
      multiple: true,
      class: "unseen",
      "aria-label": "Files to import",
      change: () => {
        this.take([...(picker.files ?? [])]);
        picker.value = "";
      },
    });
    this.go = button("Import", () => void this.start(), { class: "firm", disabled: true });
    this.clear = button("Clear those imported", () =>
      this.files.filter((it) => it.state === "done").forEach((it) => this.remove(it)),
    );
    this.hint = element(
      "p",
      { class: "quiet" },
      "Drop files anywhere, or choose them: CSV, TSV and instrument text, xlsx and xls, MAT-files, LabVIEW's lvm and " +
        "TDMS, packed by gzip too.",
    );
    root.append(
      element(
        "div",
        { class: "import_head" },
        element("h1", {}, "Import"),
        picker,
        button("Choose files …", () => picker.click()),
        this.hint,
      ),
      element(
        "div",
        { class: "import_body" },
        element(
          "div",
          { class: "import_files" },
          this.list.root,
          element("div", { class: "row" }, this.go, this.clear),
          this.job.root,
        ),
        element("div", { class: "import_main" }, this.mapping.root, this.imported.root),
      ),
    );
    this.mapping.root.hidden = true;
    context.offer({ title: "Choose files to import", group: "Import", run: () => picker.click() });
    context.onFolder(({ recordings }) => {
      this.taken = new Set(recordings.map((it) => it.name.replace(/\.h5$/, "")));
      this.show();
    });
    this.show();
    void this.open();
  }

  close(): void {
    for (const file of this.files) file.sending.abort();
  }

  /** What was on its way before this page: files that have come, and some that have not come whole. */
  private async open(): Promise<void> {
    const { api, signal, complain } = this.context;
    try {
      const overview = await api.get<IntakeOverview>("/api/import", {}, signal);
      this.uploader = new Uploader(api, overview.piece);
      this.mapping.offer(overview.mappings);
      for (const it of overview.uploads) {
        const file = takenFile(it.name, it.bytes, null);
        Object.assign(file, { upload: it.upload, have: it.have, recording: this.nameFor(it.name) });
        this.settle(file, it.result);
        this.files.push(file);
      }
    } catch (error) {
      if (!signal.aborted) complain(error);
      return;
    }
    this.choose(this.files.find((it) => it.state === "ready") ?? null);
    for (const file of this.files) if (file !== this.chosen) void this.check(file);
    onDropped((files) => this.take(files), signal);
  }

  private settle(file: TakenFile, result: ImportResult): void {
    if (result.state === "done") {
      [file.state, file.result, file.said] = [
        "done",
        result,
        result.gone ? "Its recording has been removed or renamed since." : "",
      ];
    } else if (result.state === "failed") [file.state, file.said] = ["failed", result.error];
    else if (file.have < file.bytes)
      [file.state, file.said] = ["stopped", "Drop the file again: it goes on where it stopped."];
    else [file.state, file.said] = ["ready", ""];
  }

  private nameFor(file: string): string {
    return recordingName(file, new Set([...this.taken, ...this.files.map((it) => it.recording)]));
  }

  private take(files: readonly File[]): void {
    for (const file of files) {
      const again = this.files.find((it) => it.name === file.name && it.bytes === file.size && it.state === "stopped");
      const taken = again ?? takenFile(file.name, file.size, file);
      if (again) [again.file, again.state, again.said] = [file, "sending", ""];
      else this.files.push(taken);
      if (!again) taken.recording = this.nameFor(file.name);
      this.sending = this.sending.then(() => this.send(taken));
    }
    this.show();
  }

  /** One after the other: together they would only be slower. */
  private async send(file: TakenFile): Promise<void> {
    const { uploader, context } = this;
    const { signal } = file.sending;
    if (!uploader || !file.file || signal.aborted) return;
    try {
      file.upload = await uploader.send(
        file.file,
        ({ have, waits }) => {
          [file.have, file.said] = [have, waits];
          this.show();
        },
        signal,
      );
      [file.state, file.said, file.have] = ["ready", "", file.bytes];
    } catch (error) {
      if (context.signal.aborted || isAbort(error)) return;
      [file.state, file.said] = ["refused", error instanceof Error ? error.message : String(error)];
    }
    if (file.upload && file.have === file.bytes && this.chosen?.state !== "ready") this.choose(file);
    else await this.check(file);
  }

  /** What is not chosen is not looked at by the mapping. */
  private async check(file: TakenFile): Promise<void> {
    if (file.state === "ready") this.tried(file, await this.mapping.check(file));
    this.show();
  }

  private choose(file: TakenFile | null): void {
    this.chosen = file;
    const isTried = file !== null && (file.state === "ready" || file.state === "failed" || file.state === "importing");
    this.mapping.show(isTried ? file : null);
    this.imported.show(file);
    this.show();
  }

  private remove(file: TakenFile): void {
    file.sending.abort();
    this.files = this.files.filter((it) => it !== file);
    if (file.upload) this.context.api.post("/api/import/forget", { upload: file.upload }).catch(this.context.complain);
    if (this.chosen === file) this.choose(this.files.find((it) => it.state === "ready") ?? null);
    else this.show();
  }

  /** A preview has come, or the file was refused. */
  private tried(file: TakenFile, refusal: string): void {
    if (refusal) [file.state, file.said] = ["refused", refusal];
    this.show();
  }

  private get waiting(): TakenFile[] {
    return this.files.filter((it) => it.state === "ready" || it.state === "failed");
  }

  private get toImport(): TakenFile[] {
    return this.waiting.filter((it) => it.problem === "");
  }

  private show(): void {
    for (const file of this.waiting) if (file.state === "ready") file.said = this.doubt(file) || file.problem;
    this.list.show(this.files, this.chosen);
    const ready = this.toImport;
    this.go.textContent = ready.length > 1 ? `Import ${ready.length} files` : "Import";
    this.go.disabled =
      ready.length === 0 || this.isStarting || this.job.isUnderWay || ready.some((it) => this.doubt(it) !== "");
    this.clear.hidden = !this.files.some((it) => it.state === "done");
    this.go.hidden = this.waiting.length === 0;
    this.hint.hidden = this.files.length > 0;
  }

  /** What is wrong with the name of its recording, said where it is typed. */
  private doubt(file: TakenFile): string {
    const name = file.recording;
    const why = whyNoName(name);
    if (why) return why;
    if (this.taken.has(name)) return `${name}.h5 is there already: choose another name.`;
    if (this.files.some((it) => it !== file && it.recording === name && it.state !== "done" && it.state !== "refused"))
      return `Two files are to become ${name}.h5: choose another name for one.`;
    return "";
  }

  private async start(): Promise<void> {
    const files = this.toImport;
    this.isStarting = true;
    this.show();
    try {
      const orders = new Map<TakenFile, object>();
      for (const file of files) {
        const mapping = await this.mappingOf(file);
        if (mapping === null) {
          this.context.say(`${file.name}: no line names its columns. Say what they are first.`);
          this.choose(file);
          return;
        }
        if (mapping) orders.set(file, { upload: file.upload, name: file.recording, ...mapping });
      }
      if (orders.size === 0) return;
      const { job } = await this.context.api.post<{ job: number }>("/api/import/start", {
        files: [...orders.values()],
      });
      for (const file of orders.keys()) [file.state, file.said] = ["importing", ""];
      this.job.watch(job);
    } catch (error) {
      this.context.complain(error);
    } finally {
      this.isStarting = false;
      this.show();
    }
  }

  /** Nothing of a file that nobody can read, which says so; null where it has to be said first. */
  private async mappingOf(file: TakenFile): Promise<Mapping | null | undefined> {
    try {
      return await this.mapping.mappingOf(file);
    } catch (error) {
      if (!(error instanceof ApiError) || error.status !== 400) throw error;
      [file.state, file.said] = ["refused", error.message];
      return undefined;
    }
  }

  /** Each file says for itself what has become of it, also after the studio was started anew meanwhile. */
  private async importEnded(state: string, error: string): Promise<void> {
    const { api, signal } = this.context;
    const files = this.files.filter((it) => it.state === "importing");
    for (const file of files) {
      try {
        this.settle(file, await api.get<ImportResult>("/api/import/result", { upload: file.upload }, signal));
        if (file.state === "ready") file.said = state === "stopped" ? "" : error;
      } catch (failure) {
        if (signal.aborted) return;
        [file.state, file.said] = ["failed", failure instanceof Error ? failure.message : String(failure)];
      }
    }
    const done = files.filter((it) => it.state === "done");
    this.context.say(
      state === "stopped"
        ? `The import was stopped: ${done.length} of ${files.length} came in.`
        : `${done.length} of ${files.length} ${files.length === 1 ? "file" : "files"} imported.`,
    );
    this.context.lookAtFolder();
    this.choose(done[0] ?? files[0] ?? null);
  }
}

function isAbort(error: unknown): boolean {
  return error instanceof DOMException && error.name === "AbortError";
}
