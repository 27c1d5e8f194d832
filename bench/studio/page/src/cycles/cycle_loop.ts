import type { CycleView } from "../api/cycles";
import type { Axis } from "../api/recordings";
import { namedOnce } from "../recordings/trace_groups";
import { element } from "../ui/dom";
import { figureOf, lineOf, type FigureCurve } from "../ui/figure_description";
import { Plot } from "../ui/plot/plot";
import { scaledFor } from "../ui/plot/scaled";

/** Force against position: the chosen cycle on the averages of those there are. */
export class CycleLoop {
  readonly root = element("div", { class: "loops_frame cycle_loop" });
  private readonly plot: Plot;

  constructor(recording: string) {
    this.plot = new Plot(`Cycles of ${recording}`);
    this.root.append(this.plot.figure());
  }

  show(view: CycleView, axis: Axis): void {
    const curves: FigureCurve[] = [];
    if (view.average) {
      const { position, closing, opening } = view.average;
      curves.push(
        lineOf("mean, closing", position, closing, { colour: "grey", width: 3 }),
        lineOf("mean, opening", position, opening, { colour: "grey", width: 1.25 }),
      );
    }
    if (view.loop) {
      const { cycle, position, force } = view.loop;
      curves.push(lineOf(`cycle ${cycle}`, position, force, { colour: "blue", width: 1.5, marked: true }));
    }
    const x = scaledFor(
      namedOnce("position", axis.name),
      axis.position_unit,
      curves.map((it) => it.x),
    );
    const y = scaledFor(
      namedOnce("force", axis.name),
      axis.force_unit,
      curves.map((it) => it.y),
    );
    const drawn = curves.map((it) => ({ ...it, x: x.of(it.x), y: y.of(it.y) }));
    this.plot.show(figureOf(x.label, y.label, { curves: drawn }));
  }

  end(): void {
    this.plot.end();
  }
}
