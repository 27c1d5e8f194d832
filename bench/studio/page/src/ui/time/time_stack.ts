import "./time_plot.css";

import { button, element } from "../dom";
import { plain, unitFor, withUnit } from "../numbers";
import { onColours } from "../palette";
import { gestures, pictureKey } from "../plot/gestures";
import { enlargeButton } from "../plot/enlarge";
import { exportMenu } from "../plot/out/export_menu";
import type { Sheet } from "../plot/out/sheet";
import { MovableTime } from "./movable_time";
import type { TimeLine } from "./time_line";
import { noMarks, type TimeMarks } from "./time_marks";
import { TimePlot, type Shared } from "./time_plot";
import { TimeRange } from "./time_range";

export interface PlotOrder {
  title: string; // "Force of theta"
  lines: TimeLine[]; // of one unit
  logarithmic?: boolean;
  titled?: boolean; // where the lines' names do not say what it is
}

export interface StackOptions {
  name: string;
  timeLabel: string;
  tools?: HTMLElement; // in the bar, before what is read there
  file?: () => string; // what files of it are called
  /** The stretch has changed, by hand. */
  changed?: (range: TimeRange) => void;
  zoomedWhileFollowing?: (factor: number) => void;
}

/** Plots above each other with one time axis, one cursor and one set of marks. They share the height they are given. */
export class TimeStack {
  readonly root: HTMLElement;
  readonly range: TimeRange;
  readonly shared: Shared;
  private plots: TimePlot[] = [];
  private readonly area = element("div", { class: "time_plots" });
  private readonly reading = element("p", { class: "time_reading" });
  private readonly spoken = element("p", { class: "unseen", "aria-live": "polite" });
  private readonly observer: ResizeObserver;
  private readonly endColours: () => void;
  private frame = 0;
  private speak = 0;

  constructor(private readonly options: StackOptions) {
    this.range = new TimeRange(
      () => {
        this.draw();
        this.options.changed?.(this.range);
      },
      () => this.point(),
      options.zoomedWhileFollowing,
    );
    this.shared = {
      range: this.range,
      marks: noMarks,
      origin_s: 0,
      timeLabel: options.timeLabel,
      redraw: () => this.draw(),
    };
    const plots = element(
      "div",
      {
        class: "time_focus",
        tabindex: 0,
        role: "application",
        "aria-roledescription": "plots over time",
        "aria-label": `${options.name}. Arrow keys move the cursor, plus and minus zoom, Shift and arrows move along, 0 shows all.`,
        keydown: (event: KeyboardEvent) => this.key(event),
      },
      this.area,
    );
    this.root = element("div", { class: "time_stack" }, this.bar(), plots, this.spoken);
    this.observer = new ResizeObserver(() => {
      for (const plot of this.plots) plot.fit();
      this.draw();
    });
    this.observer.observe(this.area);
    this.endColours = onColours(() => this.plots.forEach((it) => it.repaint()));
  }

  end(): void {
    this.observer.disconnect();
    this.endColours();
    cancelAnimationFrame(this.frame);
    clearTimeout(this.speak);
    this.plots = [];
  }

  /** Which plots there are; their lines may be filled later on. */
  build(orders: readonly PlotOrder[]): void {
    this.plots = orders.map(
      (it, k) =>
        new TimePlot(
          it.title,
          it.lines,
          this.shared,
          k === orders.length - 1,
          it.logarithmic ?? false,
          it.titled ?? false,
        ),
    );
    this.area.replaceChildren(...this.plots.map((it) => it.root));
    for (const plot of this.plots) {
      gestures(plot.over, new MovableTime(this.range, plot.over));
      plot.fit();
    }
    this.draw();
  }

  /** Pixels of the screen across a plot: as many columns are worth fetching. */
  get columns(): number {
    return this.plots[0]?.columns ?? 1000;
  }

  set marks(marks: TimeMarks) {
    this.shared.marks = marks;
    this.draw();
  }

  logarithmic(title: string, on: boolean): void {
    this.plots.find((it) => it.title === title)?.useLogarithms(on);
    this.draw();
  }

  /** With the screen's next picture. */
  draw(): void {
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      for (const plot of this.plots) plot.draw();
      this.read();
    });
  }

  /** What is shown, to be handed out: what has one unit has it in all of a file, with one prefix. */
  sheet(): Sheet {
    const largest = new Map<string, number>();
    for (const { reach } of this.plots) largest.set(reach.unit, Math.max(largest.get(reach.unit) ?? 0, reach.largest));
    const figures = this.plots.map((it) => it.figure(unitFor(largest.get(it.reach.unit) ?? 1, it.reach.unit)));
    return { name: this.options.file?.() ?? this.options.name, figures };
  }

  private point(): void {
    for (const plot of this.plots) plot.point();
    this.read();
  }

  private read(): void {
    const { from, to, cursor, span } = this.range;
    const origin = this.shared.origin_s;
    const decimals = Math.min(6, Math.max(2, Math.ceil(3 - Math.log10(Math.max(span, 1e-9)))));
    const at = (t: number): string => `${(t - origin).toFixed(decimals).replace("-", "−")} s`;
    const seen = cursor !== null && cursor >= from && cursor <= to;
    const length = span < 1 ? withUnit(span, "s", 3) : `${plain(span, 5)} s`;
    const text = `${at(from)} to ${at(to)} (${length})${seen ? `, cursor at ${at(cursor)}` : ""}`;
    if (this.reading.textContent !== text) this.reading.textContent = text;
  }

  private key(event: KeyboardEvent): void {
    if (!pictureKey(event, new MovableTime(this.range, this.area))) return;
    clearTimeout(this.speak);
    this.speak = window.setTimeout(() => {
      this.spoken.textContent = [this.reading.textContent, ...this.plots.map((it) => it.spoken())].join("; ");
    }, 400);
  }

  private bar(): HTMLElement {
    const small = (text: string, name: string, press: () => void): HTMLButtonElement =>
      button(text, press, { class: "small", "aria-label": name, title: name });
    return element(
      "div",
      { class: "time_bar" },
      this.options.tools ?? null,
      this.reading,
      element(
        "div",
        { class: "time_buttons", role: "group", "aria-label": "Stretch shown" },
        small("◀", "Earlier", () => this.range.pan(-0.5)),
        small("▶", "Later", () => this.range.pan(0.5)),
        small("+", "Show less, larger", () => this.range.zoom(0.5)),
        small("−", "Show more", () => this.range.zoom(2)),
        small("All", "Show all", () => this.range.whole()),
      ),
      element(
        "div",
        { class: "plot_tools" },
        enlargeButton(),
        exportMenu(() => this.sheet()),
      ),
    );
  }
}
