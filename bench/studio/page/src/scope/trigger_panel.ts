import type { Trace } from "../api/recordings";
import { inWords } from "../recordings/trace_groups";
import { element, labelled, select, setOptions } from "../ui/dom";
import { unitFor } from "../ui/numbers";
import type { TriggerEdge, TriggerMode, TriggerSettings } from "./trigger";

const modes: readonly { value: TriggerMode; text: string }[] = [
  { value: "off", text: "off" },
  { value: "auto", text: "auto" },
  { value: "normal", text: "normal" },
  { value: "single", text: "single" },
];
const about = "auto lets time run where there is none, normal waits, single holds the first";

/** What of it stands in the address; the level in the trace's own unit, whatever the picture shows it in. */
export interface TriggerState {
  mode: string;
  trace: string;
  edge: string;
  level: string;
}

/** When the scope's window begins: mode, channel, edge and level. */
export class TriggerPanel {
  readonly root: HTMLElement;
  private traces: readonly Trace[] = [];
  private isGiven = true; // the level is still that of the address
  private readonly mode: HTMLSelectElement;
  private readonly trace = select([], "", () => this.told(true));
  private readonly edge: HTMLSelectElement;
  private readonly level = element("input", { type: "number", step: "any", change: () => this.told(true) });
  private readonly unit = element("span", {}, "Level");
  private readonly state = element("p", { class: "scope_reading", role: "status" });

  constructor(
    private readonly given: TriggerState,
    private readonly changed: (state: TriggerState) => void,
  ) {
    const known = modes.find((it) => it.value === given.mode)?.value ?? "off";
    this.mode = select(modes, known, () => this.told(true));
    this.edge = select(
      [
        { value: "rising", text: "rising" },
        { value: "falling", text: "falling" },
      ],
      given.edge === "falling" ? "falling" : "rising",
      () => this.told(true),
    );
    this.mode.title = about;
    this.root = element(
      "div",
      { class: "scope_trigger" },
      labelled("Trigger", this.mode),
      labelled("Channel", this.trace),
      labelled("Edge", this.edge),
      element("label", { class: "field" }, this.unit, this.level),
      this.state,
    );
  }

  offer(traces: readonly Trace[]): void {
    this.traces = traces;
    const wanted = this.trace.value || this.given.trace;
    const usual = traces.find((it) => it.group === "force")?.name ?? "";
    const chosen = traces.some((it) => it.name === wanted) ? wanted : usual;
    setOptions(
      this.trace,
      traces.map((it) => ({ value: it.name, text: inWords(it.name) })),
      chosen,
    );
    const level = Number(this.given.level);
    if (this.isGiven) this.level.value = Number.isFinite(level) ? inDigits(level / this.unitOfTrace().factor) : "0";
    this.isGiven = traces.length === 0;
    this.told(false);
  }

  /** In which the level is typed, as the picture has it. */
  private unitOfTrace(): { factor: number; text: string } {
    return unitFor(1, this.traces.find((it) => it.name === this.trace.value)?.unit ?? "");
  }

  /** As it is set; the level in the trace's own unit. */
  get settings(): TriggerSettings {
    const level = Number(this.level.value) * this.unitOfTrace().factor;
    return {
      mode: this.mode.value as TriggerMode,
      trace: this.traces.findIndex((it) => it.name === this.trace.value),
      level: Number.isFinite(level) ? level : 0,
      edge: this.edge.value as TriggerEdge,
    };
  }

  say(text: string): void {
    if (this.state.textContent !== text) this.state.textContent = text;
  }

  private told(byHand: boolean): void {
    const off = this.mode.value === "off";
    for (const it of [this.trace, this.edge, this.level]) it.disabled = off;
    const known = this.traces.some((it) => it.name === this.trace.value);
    this.unit.textContent = known ? `Level [${this.unitOfTrace().text || "1"}]` : "Level";
    if (!byHand) return;
    const { mode, edge, level } = this.settings;
    this.changed({ mode, trace: this.trace.value, edge, level: inDigits(level) });
  }
}

/** Without what a unit's factor leaves behind the last digit. */
function inDigits(value: number): string {
  return String(Number(value.toPrecision(12)));
}
