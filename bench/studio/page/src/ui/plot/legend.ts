import { drawn, element } from "../dom";
import type { Colour, Figure, FigureArea, FigureBand, FigureCurve, FigureMark } from "../figure_description";
import { markPath } from "../marks";
import { groundOf } from "./cells";
import { bandShape, dashOf, isLine, markShape } from "./draw";
import { nodeOf, type Shape } from "./shapes";
import { markNames, markSample } from "./stretch_marks";
import type { Style } from "./style";

/** A sample of what is drawn, so wide and high, from its upper left corner; and what it is called. */
export interface Entry {
  label: string;
  isMark?: boolean; // of a stretch, which all figures of a sheet share
  sample: (x: number, y: number, width: number, height: number, style: Style) => Shape[];
}

const finite = (value: number | null | undefined): boolean => Number.isFinite(value);

/** What of a figure has a name; each once. */
export function entriesOf({ cells, areas = [], bands = [], marks = [], curves, ordered }: Figure): Entry[] {
  const entries: Entry[] = cells.kinds.map((kind) => ({
    label: kind.label,
    sample: (x, y, width, height, style) => groundOf([{ x, y, width, height }], kind, style),
  }));
  for (const area of areas) if (area.label) entries.push({ label: area.label, sample: areaSample(area) });
  for (const curve of curves) {
    if (!curve.label) continue;
    const there = curve.y.some((y, i) => finite(y) && finite(curve.x[i]));
    entries.push({ label: curve.label + (there ? "" : " (nowhere here)"), sample: curveSample(curve) });
  }
  if (ordered) entries.push({ label: ordered, sample: sequenceSample });
  for (const band of bands) if (band.label) entries.push({ label: band.label, sample: bandSample(band) });
  for (const [kind, label] of Object.entries(markNames) as [FigureMark["kind"], string][]) {
    if (!marks.some((it) => it.kind === kind)) continue;
    entries.push({
      label,
      isMark: true,
      sample: (x, y, width, height, style) => markSample(kind, { x, y, width, height }, style),
    });
  }
  return entries.filter((it, i) => entries.findIndex((other) => other.label === it.label) === i);
}

/** The shape in the middle of a sample. */
function shapeOf(colour: Colour, x: number, y: number, style: Style): Shape {
  return {
    kind: "path",
    class: `sample ${colour}`,
    d: markPath(colour, x, y, 0.28 * style.text),
    fill: style.colours[colour],
  };
}

const steps = 8;

/** From the first to the last. */
function sequenceSample(x: number, y: number, width: number, height: number, style: Style): Shape[] {
  return Array.from({ length: steps }, (_, i): Shape => {
    const d = `M${x + (width * i) / steps} ${y + height / 4}h${width / steps}v${height / 2}h${-width / steps}Z`;
    return { kind: "path", class: "sample ordered", d, fill: style.ordered(i / (steps - 1)) };
  });
}

function bandSample({ colour }: FigureBand): Entry["sample"] {
  return (x, y, width, height, style) => [bandShape(`M${x} ${y}h${width}v${height}h${-width}Z`, colour, style)];
}

function areaSample({ colour, extremes, marked }: FigureArea): Entry["sample"] {
  return (x, y, width, height, style) => {
    const fill = style.colours[colour];
    const shape = marked ? [shapeOf(colour, x + width / 2, y + height / 2, style)] : [];
    const d = extremes ? `M${x} ${y + height / 2}h${width}` : `M${x} ${y}h${width}v${height}h${-width}Z`;
    if (extremes)
      return [{ kind: "path", class: `sample ${colour}`, d, stroke: fill, width: 2 * style.lines }, ...shape];
    return [{ kind: "path", class: "area", d, fill, opacity: 0.16, stroke: fill, width: style.hair }];
  };
}

function curveSample(curve: FigureCurve): Entry["sample"] {
  return (x, y, width, height, style) => {
    if (!isLine(curve)) return [markShape(curve, x + width / 2, y + height / 2, style)];
    const line: Shape = {
      kind: "path",
      class: `sample ${curve.colour}`,
      d: `M${x} ${y + height / 2}h${width}`,
      stroke: style.colours[curve.colour],
      width: Math.max(style.hair, style.lines * curve.width),
      ...(curve.dashed ? { dash: dashOf(style) } : {}),
    };
    return curve.marked ? [line, shapeOf(curve.colour, x + width / 2, y + height / 2, style)] : [line];
  };
}

/** The legend beneath a plot. */
export function legendItems(figure: Figure, style: Style): HTMLElement[] {
  return entriesOf(figure).map(({ label, sample }) => {
    const picture = drawn("svg", { viewBox: "0 0 34 22", width: 34, height: 22, "aria-hidden": "true" });
    picture.append(...sample(1, 3, 32, 16, style).map(nodeOf));
    return element("li", {}, picture, element("span", {}, label));
  });
}
