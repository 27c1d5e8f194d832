import type { DrawerRecording, Study } from "../api/studies";
import { element } from "../ui/dom";
import type { Figure } from "../ui/figure_description";
import type { Context } from "../ui/view";
import { Plot } from "../ui/plot/plot";

const atMost = 60;

/** Every recording of a drawer as a small picture: force over penetration, what counts, is flagged and is idle. */
export class StudyPictures {
  readonly root: HTMLElement;
  private readonly plots: Plot[] = [];
  private readonly gone = new AbortController();

  constructor(
    private readonly context: Context,
    private readonly study: Study,
  ) {
    const computed = study.drawer.filter((it) => it.failure === null && it.flagged !== null);
    const shown = computed.slice(0, atMost);
    const boxes = shown.map((it) => ({ it, box: element("div", { class: "small_box" }) }));
    this.root = element(
      "section",
      { class: "pictures", "aria-label": "The recordings, drawn" },
      legend(),
      element("ul", { class: "small_plots" }, ...boxes.map(({ it, box }) => picture(it, box))),
      computed.length > atMost ? element("p", { class: "quiet" }, `The first ${atMost}; the report has all.`) : null,
    );
    void this.fetch(boxes);
  }

  end(): void {
    this.gone.abort();
    for (const it of this.plots) it.end();
  }

  /** One after the other: a page that asks for something else meanwhile is not held up. */
  private async fetch(boxes: readonly { it: DrawerRecording; box: HTMLElement }[]): Promise<void> {
    for (const { it, box } of boxes) {
      try {
        const asked = { id: this.study.id, name: it.name };
        const figure = await this.context.api.get<Figure>("/api/study/drawn", asked, this.gone.signal);
        const counts = figure.curves.map((curve) => `${curve.x.length} ${curve.label}`).join(", ");
        const name = `${it.name}: ${figure.y_label} over ${figure.x_label}; points: ${counts}`;
        const plot = new Plot(name, { small: true, file: it.name });
        this.plots.push(plot);
        plot.svg.classList.add("small_plot");
        plot.show(figure);
        box.replaceChildren(plot.svg, plot.menu());
        box.title = `${figure.y_label} over ${figure.x_label}`;
      } catch (error) {
        if (this.gone.signal.aborted) return;
        box.textContent = error instanceof Error ? error.message : String(error);
      }
    }
  }
}

function picture(it: DrawerRecording, box: HTMLElement): HTMLElement {
  const name = it.id === null ? it.name : element("a", { href: `#/recordings/${it.id}` }, it.name);
  return element(
    "li",
    { class: it.counts === false && !it.blank ? "left_out" : "" },
    element("p", { class: "small_name" }, name),
    box,
    element("p", { class: "quiet" }, standing(it)),
  );
}

/** "9 of 12 cycles good", "a blank", "left out: doubted". */
export function standing(it: DrawerRecording): string {
  const cycles = it.cycles === null ? "" : `${it.good_cycles ?? "?"} of ${it.cycles} cycles good`;
  if (it.blank) return `blank; ${cycles}`;
  if (it.counts === false) return `left out${it.doubts.length > 0 ? ", doubted" : ""}; ${cycles}`;
  return cycles;
}

function legend(): HTMLElement {
  const item = (name: string, text: string): HTMLElement =>
    element("li", {}, element("span", { class: `point ${name}`, "aria-hidden": "true" }), text);
  return element(
    "ul",
    { class: "small_legend", "aria-label": "What the points mean" },
    element("li", {}, "Resisting force over penetration:"),
    item("counts", "counts"),
    item("left_out", "of a recording that is left out"),
    item("flagged", "of a flagged cycle"),
    item("idle", "idle"),
  );
}
