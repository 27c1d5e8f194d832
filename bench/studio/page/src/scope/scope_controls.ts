import type { LoopStatus } from "../api/loop";
import type { Workspace, WorkspaceRecording } from "../api/workspace";
import { isLeftOpen, repairAddress } from "../recordings/left_open";
import { button, element, labelled, select, setOptions } from "../ui/dom";
import type { Context } from "../ui/view";
import { lackingFor, lawsToPick, shortName } from "../laws";

const mostLeft = 3;

/** The panel beside the scope: device, law, force and recording. Its parts keep their places, whatever the loop does. */
export class ScopeControls {
  readonly root: HTMLElement;
  private status: LoopStatus | null = null;
  private laws: Workspace["laws"] = [];
  private saved = ""; // the recording that has just ended
  private folder: Workspace | null = null;
  private left: WorkspaceRecording[] = []; // not closed, and nobody writes them
  private silent_s = 0;
  private readonly device = element("input", { type: "text", autocomplete: "off", spellcheck: "false" });
  private readonly sensor = element("input", {
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    placeholder: "none",
  });
  private readonly scene = select([{ value: "", text: "none" }], "", () => {});
  private readonly law = select([{ value: "", text: "nothing" }], "", () => {});
  // Going through the list renders nothing: a law comes to the hand by a press alone.
  private readonly render = button("Render", () => this.feel(), { disabled: true });
  private readonly rendered = element("p", { class: "rendered" });
  private readonly start = element("button", { type: "submit", class: "firm", disabled: true }, "Start"); // until the folder is known
  private readonly name = element("input", {
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    maxlength: 80,
    value: nameOfNow(),
  });
  private readonly record = button("Record", () => this.toggleRecording(), { disabled: true });
  private readonly recorded = element("div", { class: "recorded quiet" });
  private readonly state = element("p", { class: "ended", role: "status" });

  constructor(private readonly context: Context) {
    context.onFolder((workspace) => {
      if (!this.folder && this.device.value === "") this.device.value = workspace.device;
      this.folder = workspace;
      this.laws = lawsToPick(workspace);
      const scenes = workspace.files.filter((it) => it.kind === "scene").map((it) => ({ value: it.id, text: it.name }));
      setOptions(this.scene, [{ value: "", text: "none" }, ...scenes]);
      this.start.disabled = false;
      this.offerWhatSuits();
      this.left = workspace.recordings.filter(isLeftOpen);
      if (this.status) this.say(this.status);
    });
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
        this.start,
      ),
      this.state,
      element("div", { class: "law" }, labelled("Law to feel", this.law), this.render),
      this.rendered,
      element("div", { class: "record" }, labelled("New recording's name", this.name), this.record),
      this.recorded,
    );
  }

  show(status: LoopStatus): void {
    const before = this.status;
    this.status = status;
    this.offerWhatSuits();
    const running = status.running || status.starting === true;
    this.start.textContent = running ? "Stop" : "Start";
    this.start.classList.toggle("firm", !running);
    for (const it of [this.device, this.sensor, this.scene]) it.disabled = running;
    if (running && status.device && this.device.value !== status.device) this.device.value = status.device;
    this.law.disabled = !status.running;
    this.record.disabled = !status.running;
    this.render.disabled = !status.running;
    this.record.textContent = status.recording ? "Stop" : "Record";
    this.record.setAttribute("aria-label", status.recording ? "Stop recording" : "Record");
    this.record.classList.toggle("firm", status.recording !== null);
    this.name.disabled = !status.running || status.recording !== null;
    if (before?.recording && !status.recording) {
      this.name.value = nameOfNow();
      this.saved = before.recording.name;
      this.context.lookAtFolder();
    }
    if (status.recording || status.recording_failure) this.saved = "";
    this.recorded.classList.toggle("alarming", status.recording_failure !== "");
    this.say(status);
  }

  /** Nobody answers: what was said last is no longer known to be so. */
  showStale(seconds: number): void {
    this.silent_s = seconds;
    if (this.status) this.say(this.status);
  }

  private say(status: LoopStatus): void {
    const isUnknown = this.silent_s > 0 && (status.running || status.starting === true);
    put(
      this.state,
      isUnknown ? `No answer for ${this.silent_s} s: whether the loop runs is not known.` : stateText(status),
    );
    put(this.rendered, isUnknown ? "" : renderedText(status));
    const { recording } = status;
    if (this.saved !== "") this.showSaved();
    else if (isUnknown && recording)
      put(this.recorded, `${recording.name}: ${recordedText(status)} were written when the studio last answered.`);
    else if (!recording && !status.recording_failure && this.left.length > 0) this.showLeft();
    else put(this.recorded, recordedText(status));
  }

  /** What whoever recorded left behind as they died. */
  private showLeft(): void {
    const shown = this.left.slice(0, mostLeft);
    const more = this.left.length - shown.length;
    const key = `${shown.map((it) => it.id).join(" ")} ${more}`;
    if (this.recorded.dataset.shown === key && this.recorded.childElementCount > 0) return;
    this.recorded.dataset.shown = key;
    const items = shown.map((it) =>
      element(
        "li",
        {},
        it.name,
        " ended without being closed: ",
        element("a", { href: repairAddress(it) }, "close it"),
      ),
    );
    if (more > 0) items.push(element("li", {}, `and ${more} more`));
    this.recorded.replaceChildren("Not recording", element("ul", { class: "left_open" }, ...items));
  }

  /** What the device has no axis for stands in the list with the reason, and cannot be picked. */
  private offerWhatSuits(): void {
    const axes = this.status?.running ? this.status.axes : null;
    const laws = this.laws.map((law) => {
      const lacking = axes ? lackingFor(law, axes) : "";
      return { value: law.id, text: lacking ? `${law.name} (for ${lacking})` : law.name, disabled: lacking !== "" };
    });
    setOptions(this.law, [{ value: "", text: "nothing" }, ...laws]);
  }

  /** Where the recording is, as a way to its page once it is in the folder's list. */
  private showSaved(): void {
    const text = `Saved as ${this.saved}`;
    const id = this.folder?.recordings.find((it) => it.name === this.saved)?.id;
    if (this.recorded.dataset.shown === `${text} ${id ?? ""}`) return;
    this.recorded.dataset.shown = `${text} ${id ?? ""}`;
    this.recorded.replaceChildren(id ? element("a", { href: `#/recording/${id}/time` }, text) : text);
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
    this.context.api.post<Partial<LoopStatus>>(path, body).then(told, this.context.complain);
  }
}

function put(node: HTMLElement, text: string): void {
  if (node.textContent !== text) node.textContent = text;
}

function renderedText({ running, force, law }: LoopStatus): string {
  if (!running) return "";
  return law && force !== "rendered" ? `Held back: ${shortName(law)}` : `Rendered now: ${shortName(law) || "nothing"}`;
}

function recordedText(status: LoopStatus): string {
  if (status.recording_failure) return status.recording_failure;
  if (!status.recording) return "Not recording";
  const { rows, seconds } = status.recording;
  return `${rows.toLocaleString("en-GB")} rows, ${seconds.toFixed(1)} s`;
}

function stateText(status: LoopStatus): string {
  if (status.starting) return "The device is being opened.";
  if (!status.running) return status.ended ? `Ended: ${status.ended}` : "The loop is not running.";
  if (status.released || status.force === "held") return "Zero force: nothing is rendered.";
  if (status.blending) return "Force comes back gently.";
  const running = `Running at ${Math.round(status.rate_hz)} Hz.`;
  return status.warning ? `${running} ${status.warning}` : running;
}

function nameOfNow(): string {
  const now = new Date();
  const two = (value: number): string => String(value).padStart(2, "0");
  const day = `${now.getFullYear()}-${two(now.getMonth() + 1)}-${two(now.getDate())}`;
  return `${day}_${two(now.getHours())}-${two(now.getMinutes())}-${two(now.getSeconds())}`;
}
