import type { LawError } from "../../api/editor";
import { element } from "../../ui/dom";
import { plain } from "../../ui/numbers";
import type { Drawing } from "../drawing";
import { lawError } from "../error";
import { inUnits } from "../scale";

/** The error of what is drawn, as a table of fixed size, and read out after a pause of half a second. */
export class Figures {
  readonly table: HTMLTableElement;
  error: LawError | null = null;
  private readonly cells = ["rmse", "rmse_jnd", "worst", "worst_jnd", "worst_at", "jnd", "segments"].map((it) =>
    element("td", { class: "number", id: `error_${it}` }),
  );
  private waiting = 0;
  private told: unknown = null;

  constructor(
    private readonly drawing: Drawing,
    private readonly announce: (text: string) => void,
  ) {
    const heads = ["Error (rms)", "in JNDs", "Worst", "in JNDs there", "at", "JND of its rms force", "Segments"];
    this.table = element(
      "table",
      { class: "figures" },
      element(
        "caption",
        {},
        "Law against averaged cycle, without what cycles differ by (the tab Fits, and its JND: over every row in contact)",
      ),
      element(
        "tbody",
        {},
        ...heads.map((it, i) => element("tr", {}, element("th", { scope: "row" }, it), this.cells[i]!)),
      ),
    );
    this.told = drawing.knots;
  }

  end(): void {
    clearTimeout(this.waiting);
  }

  show(): void {
    const { curve, knots, force, position, segments } = this.drawing;
    const error = lawError(curve, knots);
    this.error = error;
    const texts = error
      ? [
          inUnits(error.rmse_n, force),
          `${plain(error.rmse_jnd)} JND`,
          inUnits(error.worst_n, force),
          `${plain(error.worst_jnd)} JND`,
          `${inUnits(error.worst_penetration, position)}, ${error.worst_branch}`,
          inUnits(error.jnd_n, force),
          String(segments),
        ]
      : ["–", "–", "–", "–", "–", "–", String(segments)];
    texts.forEach((text, i) => (this.cells[i]!.textContent = text));
    if (this.told === knots) return;
    this.told = knots;
    clearTimeout(this.waiting);
    this.waiting = window.setTimeout(() => {
      this.announce(
        `Error ${texts[0]}, ${texts[1]}; worst ${texts[2]} at ${texts[4]}; ${segments} ${segments === 1 ? "segment" : "segments"}`,
      );
    }, 500);
  }
}
