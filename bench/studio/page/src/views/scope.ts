import "./scope.css";

import type { LoopStatus } from "../api/loop";
import type { Trace } from "../api/recordings";
import { button, element, labelled, select, setOptions } from "../ui/dom";
import { singleKeysOn } from "../ui/single_keys";
import { isTyping } from "../ui/keys";
import type { Context, View } from "../ui/view";
import { LastEvents, LiveStream } from "../scope/live_stream";
import { ScopeControls } from "../scope/scope_controls";
import { ScopeFigures } from "../scope/scope_figures";
import { ScopeInstrument } from "../scope/scope_instrument";
import { ScopePicture } from "../scope/scope_picture";
import { axisOf } from "../recordings/trace_groups";

const channels = "(channels)"; // in place of an axis
const windows_s = [1, 2, 5, 10, 30, 60];

/** The scope: what the loop does now. */
class Scope {
  private readonly root = element("div", { class: "scope_page" });
  private readonly forbidden = element("p", { class: "forbidden", hidden: true });
  private readonly stale = element("p", { class: "stale", role: "status" });
  private readonly controls: ScopeControls;
  private readonly figures = new ScopeFigures();
  private readonly picture: ScopePicture;
  private readonly instrument: ScopeInstrument;
  private readonly stopped = element("p", { class: "stopped", role: "status" });
  private readonly stream: LiveStream;
  private readonly events = new LastEvents();
  private readonly list = element("ol", { class: "event_list", tabindex: 0, "aria-label": "Events, newest first" });
  private readonly window: HTMLSelectElement;
  private readonly pauseButton = button("Pause", () => this.togglePause(), {
    title: "Space",
    "aria-keyshortcuts": "Space",
  });
  private readonly axis = select([{ value: "", text: "all axes" }], "", () => this.chooseTraces());
  private readonly scale = select(
    [
      { value: "linear", text: "linear" },
      { value: "log", text: "log" },
    ],
    "linear",
    (value) => this.picture.stack.logarithmic("Timing", value === "log"),
  );
  private status: LoopStatus | null = null;
  private traces: Trace[] = [];
  private asking = false;
  private readonly observer: ResizeObserver;
  private readonly key = (event: KeyboardEvent): void => this.onKey(event);

  constructor(
    private readonly context: Context,
    parent: HTMLElement,
  ) {
    const { api, complain } = context;
    this.controls = new ScopeControls(context);
    this.window = select(
      windows_s.map((it) => ({ value: String(it), text: `${it} s` })),
      "5",
      (value) => this.picture.setWindow(Number(value)),
    );
    this.picture = new ScopePicture(
      api,
      (ticks) => this.stream.open(ticks),
      (factor) => this.otherWindow(factor),
      complain,
      () => this.instrument.draw(),
      (at) => this.onTriggered(at),
    );
    this.instrument = new ScopeInstrument(context, this.picture);
    this.stream = new LiveStream(api, {
      frame: (frame) => {
        if (this.events.add(frame.events)) this.showEvents();
        this.picture.push(frame);
      },
      status: (status) => this.show(status),
      stale: (seconds) => this.showStale(seconds),
      session: (line) => this.forbid(line),
    });
    this.observer = new ResizeObserver(() => this.picture.fit());
    this.build(parent);
    addEventListener("keydown", this.key);
    this.stream.open(1);
  }

  end(): void {
    removeEventListener("keydown", this.key);
    this.observer.disconnect();
    this.stream.close();
    this.picture.end();
  }

  private build(parent: HTMLElement): void {
    this.root.append(
      element(
        "section",
        { class: "scope_plots", "aria-label": "Traces" },
        element(
          "div",
          { class: "scope_head" },
          element("h1", {}, "Scope"),
          labelled("Window", this.window),
          labelled("Axis", this.axis),
          labelled("Timing", this.scale),
          this.pauseButton,
          this.instrument.views,
        ),
        this.instrument.trigger.root,
        this.stopped,
        this.picture.stack.root,
        this.instrument.xy.root,
        this.instrument.spectrum.root,
        this.instrument.strip.root,
        element("div", { class: "scope_foot" }, this.instrument.strip.reading, this.instrument.cursors.root),
        this.stale,
      ),
      element(
        "aside",
        { class: "scope_panel", "aria-label": "Loop" },
        this.controls.root,
        this.instrument.marks.root,
        this.figures.root,
        element("div", { class: "events" }, element("h2", {}, "Events"), this.list),
      ),
    );
    parent.append(this.root, this.forbidden);
    this.observer.observe(this.picture.stack.root);
  }

  private show(status: LoopStatus): void {
    const before = this.status;
    this.status = status;
    this.root.hidden = false;
    this.forbidden.hidden = true;
    this.controls.show(status);
    this.figures.show(status);
    this.instrument.showStatus(status);
    this.showStopped(status);
    this.pauseButton.disabled = this.traces.length === 0;
    const another = before !== null && status.run !== before.run;
    const hasRun = status.running || (status.run ?? 0) > 0;
    if (hasRun && !status.starting && (another || this.traces.length === 0)) void this.askTraces(another);
  }

  /** Which traces a loop has is known once it runs. */
  private async askTraces(another: boolean): Promise<void> {
    if (this.asking) return;
    this.asking = true;
    try {
      this.traces = await this.context.api.get<Trace[]>("/api/live/traces");
      const axes = this.status?.axes ?? [];
      const known = this.axis.options.length > 1;
      const chosen = known ? this.axis.value : axes.length > 1 ? axes[0]?.name : "";
      const ofChannels = this.traces.some((it) => it.group === "channel")
        ? [{ value: channels, text: "channels" }]
        : [];
      setOptions(
        this.axis,
        [{ value: "", text: "all axes" }, ...axes.map(({ name }) => ({ value: name, text: name })), ...ofChannels],
        chosen,
      );
      if (another) {
        this.events.clear();
        this.showEvents();
        this.picture.restart();
        this.showPaused();
      }
      this.instrument.offer(this.traces, this.status?.rate_hz ?? 1000);
      this.chooseTraces();
    } catch (error) {
      this.context.complain(error);
    } finally {
      this.asking = false;
    }
  }

  private chooseTraces(): void {
    const axes = this.status?.axes ?? [];
    const chosen = this.traces
      .map((trace, k) => ({ trace, k, axis: axisOf(trace, axes) }))
      .filter((it) => this.isShown(it.trace, it.axis))
      .map((it) => it.k);
    const { rate_hz = 1000, ticks = 0 } = this.status ?? {};
    this.picture.setTraces(this.traces, chosen, rate_hz || 1000, ticks, this.scale.value === "log");
    this.instrument.offerLines();
  }

  private isShown(trace: Trace, axis: string): boolean {
    if (trace.group === "timing") return trace.name === "wake_latency" || trace.name === "cycle_time";
    if (this.axis.value === channels) return trace.group === "channel";
    return trace.group !== "channel" && (this.axis.value === "" || axis === this.axis.value);
  }

  private otherWindow(factor: number): void {
    const at = windows_s.indexOf(Number(this.window.value)) + (factor < 1 ? -1 : 1);
    const window_s = windows_s[at];
    if (window_s === undefined) return;
    this.window.value = String(window_s);
    this.picture.setWindow(window_s);
  }

  private togglePause(): void {
    if (this.picture.paused) this.picture.resume();
    else this.picture.pause();
    this.showPaused();
  }

  private onTriggered(at: number | null): void {
    this.instrument.triggered(at);
    this.showPaused();
    // A single one holds after it is told.
    queueMicrotask(() => this.showPaused());
  }

  /** What is seen of a loop that has ended is not what a loop does now, and is not to be taken for it. */
  private showStopped(status: LoopStatus): void {
    const stopped = !status.running && status.starting !== true && this.traces.length > 0;
    const text = stopped ? "Stopped: this is the end of the last loop." : "";
    if (this.stopped.textContent !== text) this.stopped.textContent = text;
    this.root.classList.toggle("is_stopped", stopped);
  }

  private showPaused(): void {
    this.pauseButton.textContent = this.picture.paused ? "Go on" : "Pause";
    this.pauseButton.setAttribute("aria-pressed", String(this.picture.paused));
  }

  private onKey(event: KeyboardEvent): void {
    if (event.key !== " " || event.ctrlKey || event.altKey || event.metaKey || isTyping(event)) return;
    if (!singleKeysOn()) return;
    event.preventDefault();
    if (!this.pauseButton.disabled) this.togglePause();
  }

  private showEvents(): void {
    const items = this.events.events
      .slice(-50)
      .reverse()
      .map((it) => element("li", {}, `${it.time_s.toFixed(3)} s ${it.kind}${it.text ? `: ${it.text}` : ""}`));
    this.list.replaceChildren(...items);
    this.picture.showEvents(this.events.events);
  }

  private showStale(seconds: number): void {
    this.controls.showStale(seconds);
    const text = seconds > 0 ? `Stale since ${seconds} s` : "";
    if (this.stale.textContent !== text) this.stale.textContent = text;
    this.root.classList.toggle("is_stale", seconds > 0);
  }

  /** During a blind session: just one line. */
  private forbid(line: string): void {
    this.status = null;
    this.root.hidden = true;
    this.forbidden.hidden = false;
    if (this.forbidden.textContent !== line) this.forbidden.textContent = line;
  }
}

export const scope: View = {
  name: "scope",
  title: "Scope",
  mount(root, context) {
    const it = new Scope(context, root);
    return () => it.end();
  },
};
