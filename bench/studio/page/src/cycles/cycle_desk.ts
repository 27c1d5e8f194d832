import { ApiError } from "../api/api";
import type { CycleStep, CycleView, FindSettings, Remark } from "../api/cycles";
import { History } from "../editor/history";
import { Latest } from "../ui/latest";
import type { Context } from "../ui/view";
import { areAlike, moved, onTop, withRemark, type Boundary, type Draft } from "./cycle_draft";
import { keepDraft, keptDraft } from "./kept_drafts";

const after_ms = 220; // of silence the server is asked what a change comes to

/** What stands in the way of saving, and what can be done about it. */
export interface Trouble {
  text: string;
  canMerge: boolean; // somebody else has saved: theirs can be loaded with these changes on top
  isOther?: boolean; // another recording has taken the place of this one: nothing of it is what is shown here
}

/**
 * The cycles of one recording while they are mended: every step can be taken back; the server says what each comes to,
 * and an answer to an older question is dropped. Nothing is kept in the recording before save().
 */
export class CycleDesk {
  view: CycleView | null = null; // what the server has said last
  trouble: Trouble | null = null;
  loop = 0; // the cycle whose force over position is asked for
  private history: History<Draft> | null = null;
  private saved: Draft | null = null; // as it stands in the recording
  private uuid = "";
  private version = "";
  private timer = 0;
  private readonly latest: Latest;
  isBusy = false; // the server is asked what a change comes to
  isSaving = false;

  constructor(
    private readonly context: Context,
    private readonly id: string,
    private readonly changed: () => void,
    /** As OpenRecording has them. */
    private readonly recording: { writing: () => (written: boolean) => void; reload: () => void },
  ) {
    this.latest = new Latest(context.signal);
    context.signal.addEventListener("abort", () => clearTimeout(this.timer));
  }

  get draft(): Draft | null {
    return this.history?.now ?? null;
  }
  get isChanged(): boolean {
    return this.draft !== null && this.saved !== null && (!areAlike(this.draft, this.saved) || !this.isStored);
  }
  get isStored(): boolean {
    return this.saved?.settings === null;
  }
  get canUndo(): boolean {
    return this.history?.canUndo ?? false;
  }
  get canRedo(): boolean {
    return this.history?.canRedo ?? false;
  }

  /** Reads what is in the recording; changes that were not saved before come back. */
  async open(): Promise<void> {
    try {
      const view = await this.latest.ask((signal) =>
        this.context.api.get<CycleView>("/api/cycles", { id: this.id }, signal),
      );
      if (!view) return;
      this.begin(view);
      const kept = keptDraft(this.id);
      if (kept?.uuid === view.uuid && kept.version === view.version) {
        this.record(kept.draft);
        this.context.say("These are as they were left, and are not saved.");
      } else if (kept) this.putOnTop(kept.base, kept.draft, kept.uuid === view.uuid);
    } catch (error) {
      this.fail(error);
    }
    this.changed();
  }

  private begin(view: CycleView): void {
    this.take(view);
    this.saved = { settings: view.stored ? null : view.settings, phases: view.phases, said: view.said };
    [this.uuid, this.version] = [view.uuid, view.version];
    this.history = new History(this.saved);
  }

  private take(view: CycleView): void {
    this.view = view;
    this.trouble = view.locked ? { text: view.locked, canMerge: false } : null;
  }

  // What a person does.

  move(at: Boundary, row: number, time_s: number, tag = ""): void {
    if (this.draft) this.record(moved(this.draft, at, row, time_s), tag);
  }

  remark(cycle: number, remark: Remark | null): void {
    if (this.draft) this.record(withRemark(this.draft, cycle, remark));
  }

  /** Where phases of cycles that are split or merged begin and end is the server's to say. */
  async step(step: CycleStep): Promise<void> {
    const { draft } = this;
    if (!draft || this.view?.locked) return;
    clearTimeout(this.timer);
    await this.ask({ ...this.wanted(draft), step }, ({ phases, said }) => {
      if (this.draft === draft) this.record({ settings: draft.settings, phases, said }, "", false);
    });
  }

  /** Splits the cycle that lies at a time there. */
  async splitAt(time_s: number): Promise<void> {
    const phase = this.draft?.phases.find((it) => time_s >= it[4] && time_s < it[5]);
    if (!phase) return this.context.say("There is no cycle at the cursor.");
    try {
      const { row } = await this.context.api.get<{ row: number }>("/api/cycles/row", { id: this.id, time: time_s });
      await this.step({ kind: "split", cycle: phase[0], row });
    } catch (error) {
      this.fail(error);
      this.changed();
    }
  }

  /** Makes the chosen cycle and the next one one. */
  async merge(): Promise<void> {
    if (this.canMerge) await this.step({ kind: "merge", cycle: this.loop });
    else this.context.say("Choose a cycle that another one follows.");
  }
  get canMerge(): boolean {
    const numbers = this.draft?.phases.map((it) => it[0]) ?? [];
    return numbers.includes(this.loop) && numbers.includes(this.loop + 1);
  }

  undo(): void {
    if (this.history?.undo()) this.after();
  }
  redo(): void {
    if (this.history?.redo()) this.after();
  }

  show(cycle: number): void {
    if (cycle === this.loop) return;
    this.loop = cycle;
    this.soon();
  }

  /** Cycles by other settings; asked for while they are changed, the last one counts. */
  find(settings: FindSettings, axis: number): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.findNow(settings, axis), after_ms);
  }

  private async findNow(settings: FindSettings, axis: number): Promise<void> {
    await this.ask({ axis, settings, said: [] }, (view) => {
      this.record({ settings, phases: view.phases, said: [] }, "settings", false);
    });
  }

  private record(draft: Draft, tag = "", ask = true): void {
    this.history?.record(draft, tag);
    this.after(ask);
  }

  private after(ask = true): void {
    const { draft, saved } = this;
    if (draft && saved)
      keepDraft(this.id, this.isChanged ? { uuid: this.uuid, version: this.version, base: saved, draft } : null);
    if (ask) this.soon();
    this.changed();
  }

  private soon(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => {
      const { draft } = this;
      if (draft) void this.ask(this.wanted(draft), (view) => this.exact(draft, view));
    }, after_ms);
  }

  /** The times of rows are the server's. */
  private exact(of: Draft, view: CycleView): void {
    if (of === this.draft && view.phases.length === of.phases.length) {
      for (const [k, phase] of view.phases.entries()) {
        const own = of.phases[k]!;
        [own[4], own[5]] = [phase[4], phase[5]];
      }
    }
  }

  private wanted({ settings, phases, said }: Draft): Record<string, unknown> {
    const rows = phases.map((it) => it.slice(0, 4));
    return { axis: this.view?.axis ?? 0, settings, phases: rows, said, loop: this.loop };
  }

  private async ask(wanted: Record<string, unknown>, use: (view: CycleView) => void): Promise<void> {
    this.isBusy = true;
    this.changed();
    try {
      const view = await this.latest.ask((signal) =>
        this.context.api.post<CycleView>(
          "/api/cycles/look",
          { recording: this.id, loop: this.loop, ...wanted },
          signal,
        ),
      );
      if (!view) return; // another question is under way
      this.isBusy = false;
      this.take(view);
      if (view.uuid !== this.uuid || view.version !== this.version)
        this.trouble = { text: "The recording's cycles have been changed by somebody else meanwhile.", canMerge: true };
      use(view);
    } catch (error) {
      this.isBusy = false;
      this.fail(error);
    }
    this.changed();
  }

  // Keeping it.

  async save(author: string): Promise<void> {
    const { draft, view } = this;
    if (!draft || !view || this.isSaving) return;
    clearTimeout(this.timer);
    this.isSaving = true;
    this.changed();
    const end = this.recording.writing();
    try {
      const body = { recording: this.id, version: this.version, uuid: this.uuid, author, ...this.wanted(draft) };
      const saved = await this.context.api.post<CycleView>("/api/cycles/save", body);
      end(true);
      if (this.context.signal.aborted) return;
      this.isSaving = false;
      // What was before can still be come back to, and be saved again.
      this.take(saved);
      this.saved = { settings: null, phases: saved.phases, said: saved.said };
      [this.uuid, this.version] = [saved.uuid, saved.version];
      if (this.draft === draft) this.history?.rename(this.saved);
      keepDraft(this.id, null);
      this.context.say(`Saved: ${saved.edits[saved.edits.length - 1]?.what ?? ""}`);
      this.context.lookAtFolder();
      this.soon();
    } catch (error) {
      end(false);
      this.isSaving = false;
      this.fail(error);
    }
    this.changed();
  }

  /** Takes what is in the recording now; with what was changed here on top, or without. */
  async reload(withMine: boolean): Promise<void> {
    const { draft, saved, uuid } = this;
    try {
      const view = await this.latest.ask((signal) =>
        this.context.api.get<CycleView>("/api/cycles", { id: this.id }, signal),
      );
      if (!view) return;
      if (view.uuid !== uuid) return this.leave();
      this.begin(view);
      keepDraft(this.id, null);
      if (withMine && draft && saved) this.putOnTop(saved, draft, true);
      this.soon();
    } catch (error) {
      this.fail(error);
    }
    this.changed();
  }

  /** For the recording that is there now: traces and all are read anew. */
  leave(): void {
    keepDraft(this.id, null);
    this.recording.reload();
    this.context.say("Another recording has taken the place of this one: what was changed in it is not put on top.");
  }

  private putOnTop(base: Draft, mine: Draft, isSame: boolean): void {
    const theirs = this.saved;
    if (!theirs) return;
    if (!isSame) {
      this.trouble = {
        text: "Another recording has taken the place of this one: what was changed in it is not put on top.",
        canMerge: false,
      };
      return;
    }
    const { draft, lost } = onTop(base, mine, theirs, this.view?.rows ?? 0);
    if (!areAlike(draft, theirs)) this.record(draft);
    this.context.say(
      lost === 0
        ? "Loaded; what was changed here is on top."
        : `Loaded; ${lost} of the changes made here do not fit there any more: theirs stay.`,
    );
  }

  /** Said at its place; what was changed stays. */
  private fail(error: unknown): void {
    if (this.context.signal.aborted) return;
    const text = error instanceof Error ? error.message : String(error);
    const status = error instanceof ApiError ? error.status : 0;
    this.trouble = { text, canMerge: status === 409, isOther: status === 410 };
  }
}
