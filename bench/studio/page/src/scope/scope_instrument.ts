import type { LoopStatus } from "../api/loop";
import type { Trace } from "../api/recordings";
import { button, element } from "../ui/dom";
import type { Context } from "../ui/view";
import { DeadlineStrip } from "./deadline_strip";
import { MarkPanel } from "./mark_panel";
import { ScopeCursors } from "./scope_cursors";
import type { ScopePicture } from "./scope_picture";
import { SpectrumView } from "./views/spectrum_view";
import { TriggerPanel } from "./trigger_panel";
import { XyView } from "./views/xy_view";

const views = [
  { name: "time", text: "Time" },
  { name: "xy", text: "XY" },
  { name: "spectrum", text: "Spectrum" },
] as const;
type ViewName = (typeof views)[number]["name"];

/** What makes the picture an instrument: its views, trigger, cursors, markers and deadlines. The address holds them. */
export class ScopeInstrument {
  /** Which view: beside the other controls of the picture. */
  readonly views: HTMLElement;
  readonly trigger: TriggerPanel;
  readonly cursors: ScopeCursors;
  readonly marks: MarkPanel;
  readonly strip = new DeadlineStrip();
  readonly xy: XyView;
  readonly spectrum: SpectrumView;
  private readonly buttons = new Map<ViewName, HTMLButtonElement>();
  private view: ViewName = "time";
  private rate_hz = 1000;
  private frame = 0;

  constructor(
    private readonly context: Context,
    private readonly picture: ScopePicture,
  ) {
    const { api, state, signal, complain } = context;
    const given = (key: string): string => state.get(key) ?? "";
    this.xy = new XyView({ x: given("x"), y: given("y") }, (x, y) => {
      state.set({ x, y });
      this.draw();
    });
    this.spectrum = new SpectrumView(
      api,
      signal,
      given("spectrum"),
      (spectrum) => {
        state.set({ spectrum });
        this.draw();
      },
      complain,
    );
    const trigger = { mode: given("trigger"), trace: given("channel"), edge: given("edge"), level: given("level") };
    this.trigger = new TriggerPanel(trigger, ({ mode, trace, edge, level }) => {
      state.set({ trigger: mode === "off" ? null : mode, channel: trace, edge, level });
      this.arm();
    });
    this.cursors = new ScopeCursors(picture.stack);
    this.marks = new MarkPanel(context);
    for (const { name, text } of views)
      this.buttons.set(
        name,
        button(text, () => this.show(name, true), { class: "small" }),
      );
    this.views = element(
      "div",
      { class: "scope_views", role: "group", "aria-label": "View" },
      ...this.buttons.values(),
    );
    const wanted = (): ViewName => views.find((it) => it.name === given("view"))?.name ?? "time";
    state.onChange(() => this.show(wanted(), false));
    this.show(wanted(), false);
    context.offer(
      { title: "Cursor A here", group: "Scope", keys: "a", run: () => this.cursors.put("A") },
      { title: "Cursor B here", group: "Scope", keys: "b", run: () => this.cursors.put("B") },
      { title: "No cursors", group: "Scope", run: () => this.cursors.clear() },
      { title: "Mark this moment", group: "Scope", keys: "m", run: () => this.marks.mark() },
      ...views.map(({ name, text }) => ({ title: `Show ${text}`, group: "Scope", run: () => this.show(name, true) })),
    );
    signal.addEventListener("abort", () => cancelAnimationFrame(this.frame));
  }

  /** Which traces the loop has. */
  offer(traces: readonly Trace[], rate_hz: number): void {
    this.rate_hz = rate_hz;
    this.trigger.offer(traces);
    this.spectrum.offer(traces);
    this.arm();
  }

  /** Which of them are drawn. */
  offerLines(): void {
    this.cursors.offer(this.picture.lines);
    this.xy.offer(this.picture.lines);
    this.draw();
  }

  showStatus(status: LoopStatus): void {
    this.marks.show(status);
    this.picture.setEnded(!status.running && status.starting !== true);
  }

  triggered(at: number | null): void {
    const { mode } = this.trigger.settings;
    if (mode === "off") this.trigger.say("");
    else this.trigger.say(at === null ? "waiting" : `triggered at ${at.toFixed(3)} s`);
  }

  /** With the screen's next picture. */
  draw(): void {
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      const { range, shared } = this.picture.stack;
      const { from, to } = range;
      const { lines, period_s, firstTick_s } = this.picture;
      if (this.view === "xy") this.xy.draw(from, to);
      else if (this.view === "spectrum") this.spectrum.draw(from, to, this.rate_hz);
      else this.cursors.draw();
      this.strip.draw(lines, shared.marks.events, { from, to }, period_s, firstTick_s);
    });
  }

  private arm(): void {
    const { settings } = this.trigger;
    this.picture.setTrigger(settings.trace < 0 ? { ...settings, mode: "off" } : settings);
    this.triggered(null);
  }

  private show(view: ViewName, byHand: boolean): void {
    this.view = view;
    if (byHand) this.context.state.set({ view: view === "time" ? null : view }, "push");
    for (const [name, it] of this.buttons) it.setAttribute("aria-pressed", String(name === view));
    this.picture.stack.root.hidden = view !== "time";
    this.cursors.root.hidden = view !== "time";
    this.xy.root.hidden = view !== "xy";
    this.spectrum.root.hidden = view !== "spectrum";
    this.draw();
  }
}
