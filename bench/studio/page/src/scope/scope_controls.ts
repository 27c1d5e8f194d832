import type { LoopStatus, Workspace } from "../api";
import { button, element, labelled, select } from "../ui/dom";
import type { Context } from "../ui/view";
import { lawsToPick } from "../laws";

/** The panel beside the scope: device, law, force and recording. Its parts keep their places, whatever the loop does. */
export class ScopeControls {
  readonly root: HTMLElement;
  private status: LoopStatus | null = null;
  private laws: Workspace["laws"] = [];
  private readonly device = element("input", { type: "text", autocomplete: "off", spellcheck: "false" });
  private readonly sensor = element("input", {
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    placeholder: "none",
  });
  private readonly scene = select([{ value: "", text: "none" }], "", () => {});
  private readonly law = select([{ value: "", text: "nothing" }], "", () => this.feel());
  private readonly start = element("button", { type: "submit", class: "firm", disabled: true }, "Start"); // until fill()
  private readonly resume = button("Let force back", () => this.order("/api/live/resume"), { disabled: true });
  private readonly name = element("input", {
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    maxlength: 80,
    value: nameOfNow(),
  });
  private readonly record = button("Record", () => this.toggleRecording(), { disabled: true });
  private readonly recorded = element("p", { class: "recorded quiet" });
  private readonly state = element("p", { class: "ended", role: "status" });

  constructor(private readonly context: Context) {
    this.root = element(
      "div",
      { class: "controls" },
      element(
        "form",
        {
          submit: (event: Event) => {
            event.preventDefault();
            this.startOrStop();
          },
        },
        labelled("Device", this.device),
        element("div", { class: "pair" }, labelled("Force sensor", this.sensor), labelled("Scene", this.scene)),
        element("div", { class: "pair" }, this.start, this.resume),
      ),
      this.state,
      labelled("Law to feel", this.law),
      element("div", { class: "record" }, labelled("New recording's name", this.name), this.record),
      this.recorded,
    );
  }

  fill(workspace: Workspace): void {
    if (this.device.value === "") this.device.value = workspace.device;
    this.start.disabled = false;
    this.laws = lawsToPick(workspace);
    const options = (first: string, items: readonly { id: string; name: string }[]): HTMLOptionElement[] => [
      element("option", { value: "" }, first),
      ...items.map((it) => element("option", { value: it.id }, it.name)),
    ];
    this.scene.replaceChildren(
      ...options(
        "none",
        workspace.files.filter((it) => it.kind === "scene"),
      ),
    );
    this.law.replaceChildren(...options("nothing", this.laws));
    if (this.status) this.show(this.status);
  }

  show(status: LoopStatus): void {
    const before = this.status;
    this.status = status;
    const running = status.running || status.starting === true;
    this.start.textContent = running ? "Stop" : "Start";
    this.start.classList.toggle("firm", !running);
    for (const it of [this.device, this.sensor, this.scene]) it.disabled = running;
    if (running && status.device && this.device.value !== status.device) this.device.value = status.device;
    this.resume.disabled = !status.released;
    this.law.disabled = !status.running;
    this.record.disabled = !status.running;
    this.showLaw(status, before);
    this.record.textContent = status.recording ? "Stop" : "Record";
    this.record.setAttribute("aria-label", status.recording ? "Stop recording" : "Record");
    this.record.classList.toggle("firm", status.recording !== null);
    this.name.disabled = !status.running || status.recording !== null;
    if (before?.recording && !status.recording) this.name.value = nameOfNow();
    put(this.recorded, recordedText(status));
    this.recorded.classList.toggle("alarming", status.recording_failure !== "");
    put(this.state, stateText(status));
  }

  /** What the loop renders, unless somebody is choosing right now. */
  private showLaw(status: LoopStatus, before: LoopStatus | null): void {
    if (before && before.law === status.law && this.law.value !== "" && document.activeElement === this.law) return;
    const id = this.idOf(status.law);
    if (document.activeElement !== this.law || before?.law !== status.law) this.law.value = id;
  }

  /** A law is told by its file's name, with or without its ending. */
  private idOf(law: string): string {
    return this.laws.find((it) => it.name === law || it.name === `${law}.law.toml`)?.id ?? "";
  }

  private startOrStop(): void {
    if (this.status?.running || this.status?.starting) return this.order("/api/live/stop");
    const body: Record<string, string> = { device: this.device.value.trim() };
    if (this.sensor.value.trim()) body.sensor = this.sensor.value.trim();
    if (this.scene.value) body.scene_id = this.scene.value;
    this.order("/api/live/start", body);
  }

  private feel(): void {
    this.order("/api/live/feel", this.law.value ? { law: this.law.value } : {});
  }

  private toggleRecording(): void {
    if (this.status?.recording) this.order("/api/live/record/stop");
    else this.order("/api/live/record", { name: this.name.value.trim() });
  }

  private order(path: string, body: unknown = {}): void {
    this.context.say("");
    const told = (status: Partial<LoopStatus>): void => {
      if (status.ticks !== undefined) this.show(status as LoopStatus);
    };
    this.context.api.post<Partial<LoopStatus>>(path, body).then(told, (error: unknown) => {
      this.context.complain(error);
      this.law.value = this.idOf(this.status?.law ?? "");
    });
  }
}

function put(node: HTMLElement, text: string): void {
  if (node.textContent !== text) node.textContent = text;
}

function recordedText(status: LoopStatus): string {
  if (status.recording_failure) return status.recording_failure;
  if (!status.recording) return "Not recording";
  const { rows, seconds } = status.recording;
  return `${rows.toLocaleString("en-GB")} rows, ${seconds.toFixed(1)} s`;
}

function stateText(status: LoopStatus): string {
  if (status.starting) return "The device is being opened.";
  if (!status.running && status.released) return "The loop is not running; zero force is held until it is let back.";
  if (!status.running) return status.ended ? `Ended: ${status.ended}` : "The loop is not running.";
  if (status.released) return "Zero force: nothing is rendered until force is let back.";
  if (status.blending) return "Force comes back gently.";
  return `Running at ${Math.round(status.rate_hz)} Hz.`;
}

function nameOfNow(): string {
  const now = new Date();
  const two = (value: number): string => String(value).padStart(2, "0");
  const day = `${now.getFullYear()}-${two(now.getMonth() + 1)}-${two(now.getDate())}`;
  return `${day}_${two(now.getHours())}-${two(now.getMinutes())}-${two(now.getSeconds())}`;
}
