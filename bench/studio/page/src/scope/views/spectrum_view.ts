import type { Api } from "../../api/api";
import type { Trace } from "../../api/recordings";
import { inWords } from "../../recordings/trace_groups";
import { element, labelled, select, setOptions } from "../../ui/dom";
import { figureOf, lineOf } from "../../ui/figure_description";
import { Latest } from "../../ui/latest";
import { asDrawn, plain, unitFor } from "../../ui/numbers";
import { palette } from "../../ui/palette";
import { exportMenu } from "../../ui/plot/out/export_menu";
import type { Sheet } from "../../ui/plot/out/sheet";
import { clipTo, drawAxes } from "./canvas_axes";
import { firstLine, peakOf, powerOfTwo, spectrumOf, type Spectrum } from "./spectrum";

const every_ms = 400;
const mostRows = 8192;
const mostColumns = 10000; // of one question: a row at both ends more than is asked for finds room

/** The amplitude spectrum of a trace over the stretch that the scope shows, tick by tick: asked for a few times a second. */
export class SpectrumView {
  readonly root: HTMLElement;
  private readonly canvas = element("canvas", {
    class: "scope_canvas",
    role: "img",
    "aria-label": "Amplitude over frequency",
  });
  private readonly trace = select([], "", () => this.choose());
  private readonly reading = element("p", { class: "scope_reading", role: "status" });
  private readonly answers: Latest;
  private traces: readonly Trace[] = [];
  private spectrum: Spectrum | null = null;
  private asked = 0;
  private later = 0;

  constructor(
    private readonly api: Api,
    signal: AbortSignal,
    private wanted: string,
    private readonly changed: (trace: string) => void,
    private readonly complain: (error: unknown) => void,
  ) {
    this.answers = new Latest(signal);
    signal.addEventListener("abort", () => clearTimeout(this.later));
    this.root = element(
      "div",
      { class: "scope_view", hidden: true },
      element(
        "div",
        { class: "scope_bar" },
        labelled("Spectrum of", this.trace),
        this.reading,
        exportMenu(() => this.sheet()),
      ),
      this.canvas,
    );
  }

  offer(traces: readonly Trace[]): void {
    this.traces = traces;
    const first = (start: string): string | undefined => traces.find((it) => it.name.startsWith(start))?.name;
    const usual = first("force_measured") ?? first("force_commanded") ?? traces[0]?.name ?? "";
    const chosen = traces.some((it) => it.name === this.wanted) ? this.wanted : usual;
    setOptions(
      this.trace,
      traces.map((it) => ({ value: it.name, text: inWords(it.name) })),
      chosen,
    );
    this.spectrum = null;
    this.asked = 0;
  }

  /** The stretch has moved; the last one's spectrum stands until the new one's is there. */
  draw(from: number, to: number, rate_hz: number): void {
    this.paint();
    const now = performance.now();
    clearTimeout(this.later);
    if (now - this.asked < every_ms) {
      this.later = window.setTimeout(() => this.draw(from, to, rate_hz), every_ms); // where nothing moves any more
      return;
    }
    this.asked = now;
    const number = this.traces.findIndex((it) => it.name === this.trace.value);
    const rows = Math.min(mostRows, powerOfTwo((to - from) * rate_hz));
    if (number < 0 || rows < 16) return;
    const range = { from: to - rows / rate_hz, to, columns: mostColumns };
    this.answers
      .ask((signal) => this.api.view("/api/live/view", { traces: String(number), ...range }, signal))
      .then((view) => {
        if (!view) return;
        const { factor } = this.drawn();
        const values = Array.from(view.traces[0]?.largest ?? [], (it) => it / factor);
        this.spectrum = view.rowsPerColumn <= 1 ? spectrumOf(values, 1 / rate_hz) : null;
        this.paint();
      }, this.complain);
  }

  private unit(): string {
    return this.traces.find((it) => it.name === this.trace.value)?.unit ?? "";
  }

  /** What amplitudes are drawn in: angles in degrees, as over time. */
  private drawn(): { factor: number; text: string } {
    return unitFor(0, this.unit());
  }

  /** What is drawn, from the first line that is. */
  private sheet(): Sheet {
    if (!this.spectrum) throw new Error("Nothing is drawn yet.");
    const { amplitude, step_hz } = this.spectrum;
    const lines = [...amplitude.keys()].slice(firstLine);
    const name = `amplitude of ${inWords(this.trace.value)}`;
    const drawn = lineOf(
      "",
      lines.map((k) => k * step_hz),
      lines.map((k) => amplitude[k]!),
      { width: 1 },
    );
    const over = {
      curves: [drawn],
      log_x: true,
      log_y: true,
      y_range: rangeOf(peakOf({ step_hz, amplitude }).amplitude),
    };
    return { name, figures: [figureOf("frequency [Hz]", `${name} [${this.drawn().text || "1"}]`, over)] };
  }

  private choose(): void {
    this.wanted = this.trace.value;
    this.spectrum = null;
    this.asked = 0;
    this.changed(this.wanted);
  }

  private paint(): void {
    const { spectrum } = this;
    if (!spectrum || this.root.hidden) return;
    const { amplitude, step_hz } = spectrum;
    const { factor, text: unit } = this.drawn();
    const peak = peakOf(spectrum);
    const [bottom, top] = rangeOf(peak.amplitude);
    const text =
      peak.amplitude < 1e-12
        ? "It does not change."
        : `Largest: ${asDrawn(peak.amplitude * factor, this.unit())} at ${plain(peak.hz, 4)} Hz; lines ${plain(step_hz, 3)} Hz apart`;
    if (this.reading.textContent !== text) this.reading.textContent = text;
    const axes = drawAxes(
      this.canvas,
      { from: firstLine * step_hz, to: step_hz * amplitude.length, unit: "Hz", name: "frequency", logarithmic: true },
      { from: bottom, to: top, unit, name: `amplitude of ${inWords(this.trace.value)}`, logarithmic: true },
    );
    if (!axes) return;
    const { context } = axes;
    clipTo(axes);
    context.strokeStyle = palette().lines[0]!;
    context.lineWidth = 1.5;
    context.beginPath();
    for (let k = firstLine; k < amplitude.length; ++k)
      context.lineTo(axes.x(k * step_hz), axes.y(Math.max(amplitude[k]!, 0.1 * bottom)));
    context.stroke();
    context.restore();
  }
}

/** Of the amplitudes that are drawn: five decades below twice the largest. */
function rangeOf(largest: number): [number, number] {
  const top = Math.max(largest, 1e-9) * 2;
  return [1e-5 * top, top];
}
