import type {
  Colour,
  Figure,
  FigureArea,
  FigureCurve,
  FigureLabel,
  FigureMarker,
  Numbers,
} from "../figure_description";
import { crossPath, markPath } from "../marks";
import { looks } from "../palette";
import { cellShapes } from "./cells";
import { axesOf, type Frame } from "./frame";
import { px, type Shape } from "./shapes";
import { marksOf } from "./stretch_marks";
import type { Style } from "./style";

/** A figure in its frame, from below to above; ground and curves are cut off at the frame. */
export interface DrawnFigure {
  ground: Shape[];
  axes: Shape[];
  curves: Shape[];
  over: Shape[];
}

const finite = (value: number | null | undefined): value is number => Number.isFinite(value);

export function draw(figure: Figure, frame: Frame, style: Style, timeAxis = true): DrawnFigure {
  const levels = levelsOf(figure, frame, style);
  const uprights = figure.vertical.flatMap((it) => uprightOf(it, frame, style));
  const markers = [...levels, ...uprights];
  const marks = marksOf(figure.marks ?? [], frame, style);
  return {
    ground: [
      ...bandsOf(figure, frame, style),
      ...marks.under,
      ...cellShapes(figure.cells, frame, style),
      ...(figure.areas ?? []).filter((it) => !it.extremes).map((it) => areaShape(it, frame, style)),
      ...markers.filter((it) => it.kind === "path"),
    ],
    axes: axesOf(figure, frame, style, timeAxis),
    curves: [
      ...(figure.areas ?? []).filter((it) => it.extremes).map((it) => areaShape(it, frame, style)),
      ...figure.curves.filter((it) => isLine(it)).map((it) => curveShape(it, frame, style)),
      ...(figure.areas ?? [])
        .filter((it) => it.marked)
        .flatMap((it) => shapesAlong(it.colour, it.x, it.high, frame, style)),
      ...figure.curves.filter((it) => it.marked).flatMap((it) => shapesAlong(it.colour, it.x, it.y, frame, style)),
      ...figure.curves.filter((it) => !isLine(it) && it.of.length === 0).flatMap((it) => pointsOf(it, frame, style)),
      ...marks.over,
    ],
    over: [...markers.filter((it) => it.kind === "text"), ...figure.labels.flatMap((it) => labelOf(it, frame, style))],
  };
}

export function isLine({ mark }: FigureCurve): boolean {
  return mark === "line" || mark === "steps" || mark === "boxes";
}

/** In the drawing's lengths: long for a law, short for what is drawn faintly beside it. */
export function dashOf(style: Style): readonly number[] {
  return [0.7 * style.text, 0.45 * style.text];
}

function curveShape(curve: FigureCurve, frame: Frame, style: Style): Shape {
  const colour = curve.order === undefined ? style.colours[curve.colour] : style.ordered(curve.order);
  const kind = `curve ${curve.colour}${curve.name ? ` ${curve.name.replace(/\W+/g, "_")}` : ""}`;
  if (curve.mark === "boxes")
    return { kind: "path", class: kind, d: boxPath(curve, frame), fill: colour, opacity: 0.6 };
  return {
    kind: "path",
    class: kind,
    d: linePath(curve.x, curve.y, frame, curve.mark === "steps"),
    stroke: colour,
    width: Math.max(style.hair, style.lines * curve.width),
    round: !curve.dashed,
    ...(curve.dashed ? { dash: dashOf(style) } : {}),
  };
}

/** A line; what is not finite breaks it, and one point by itself is a dot. */
export function linePath(x: Numbers, y: Numbers, frame: Pick<Frame, "x" | "y">, steps = false): string {
  let path = "";
  let length = 0; // of the stretch so far
  for (let i = 0; i < x.length; ++i) {
    const at = x[i] == null ? NaN : frame.x.at(x[i]!);
    const value = y[i] == null ? NaN : frame.y.at(y[i]!);
    if (!finite(at) || !finite(value)) {
      if (length === 1) path += "h0.01";
      length = 0;
      continue;
    }
    if (length > 0 && steps) path += `H${px(at)}V${px(value)}`;
    else path += `${length > 0 ? "L" : "M"}${px(at)} ${px(value)}`;
    ++length;
  }
  return length === 1 ? `${path}h0.01` : path;
}

/** Shapes along a line, of each colour at places of its own. */
function shapesAlong(colour: Colour, x: Numbers, y: Numbers, frame: Frame, style: Style): Shape[] {
  const order: readonly string[] = looks;
  const every = 9 * style.text;
  const first = frame.left + (0.3 + Math.max(0, order.indexOf(colour)) / order.length) * every;
  const shapes: Shape[] = [];
  let before = NaN;
  for (let i = 0; i < x.length; ++i) {
    const [at, up] = [x[i] == null ? NaN : frame.x.at(x[i]!), y[i] == null ? NaN : frame.y.at(y[i]!)];
    if (!finite(at) || !finite(up)) continue;
    // Lines may go back: a shape where one of the places is passed either way.
    const passed = finite(before) && Math.floor((before - first) / every) !== Math.floor((at - first) / every);
    before = at;
    if (!passed || !within(at, frame.x.pixels)) continue;
    shapes.push({
      kind: "path",
      class: `along ${colour}`,
      d: markPath(colour, at, up, 0.28 * style.text),
      fill: style.colours[colour],
      stroke: style.card,
      width: style.hair,
    });
  }
  return shapes;
}

/** Bars from the axis up, as wide as they stand apart. */
function boxPath({ x, y }: FigureCurve, frame: Frame): string {
  const at = x.map((it) => (it === null ? NaN : frame.x.at(it)));
  const apart = Math.min(
    ...at
      .slice(1)
      .map((it, i) => Math.abs(it - at[i]!))
      .filter((it) => it > 0),
    frame.right - frame.left,
  );
  return at
    .map((middle, i) => {
      const value = y[i];
      const top = value == null ? NaN : frame.y.at(value);
      if (!finite(middle) || !finite(top)) return "";
      return `M${px(middle - 0.4 * apart)} ${px(frame.bottom)}V${px(top)}h${px(0.8 * apart)}V${px(frame.bottom)}Z`;
    })
    .join("");
}

function areaShape({ x, low, high, colour, extremes, name }: FigureArea, frame: Frame, style: Style): Shape {
  let path = "";
  let begin = 0;
  const flush = (end: number): void => {
    if (end - begin < 1) return;
    const at = (i: number, of: Numbers): string => `${px(frame.x.at(x[i]!))} ${px(frame.y.at(of[i]!))}`;
    const points: string[] = [];
    for (let i = begin; i < end; ++i) points.push(at(i, high));
    for (let i = end - 1; i >= begin; --i) points.push(at(i, low));
    path += `M${points.join("L")}Z`;
  };
  for (let i = 0; i < x.length; ++i) {
    if (finite(x[i]) && finite(low[i]) && finite(high[i])) continue;
    flush(i);
    begin = i + 1;
  }
  flush(x.length);
  const fill = style.colours[colour];
  const kind = `${extremes ? "extremes" : "area"} ${colour}${name ? ` ${name}` : ""}`;
  if (extremes)
    return {
      kind: "path",
      class: kind,
      d: path,
      fill,
      stroke: fill,
      width: Math.max(style.hair, 1.2 * style.lines),
      round: true,
    };
  return { kind: "path", class: kind, d: path, fill, opacity: 0.16, stroke: fill, width: style.hair };
}

function bandsOf({ bands = [] }: Figure, frame: Frame, style: Style): Shape[] {
  return bands.flatMap(({ begin, end, colour }): Shape[] => {
    if (begin === null || end === null) return [];
    const [from, to] = [frame.x.at(begin), frame.x.at(end)].map((it) =>
      Math.min(frame.right, Math.max(frame.left, it)),
    );
    const d = `M${px(from!)} ${px(frame.top)}H${px(to!)}V${px(frame.bottom)}H${px(from!)}Z`;
    return [bandShape(d, colour, style)];
  });
}

export function bandShape(d: string, colour: Colour, style: Style): Shape {
  return { kind: "path", class: `band ${colour}`, d, fill: style.colours[colour], opacity: 0.16 };
}

/** The mark of a point, larger than others by so much. */
export function markShape(curve: FigureCurve, x: number, y: number, style: Style, larger = 0): Shape {
  const radius = style.marks * curve.width + larger;
  const crosses = curve.mark === "crosses";
  const d = crosses ? crossPath(x, y, radius) : markPath(curve.colour, x, y, radius);
  return markedAs(curve, d, style);
}

function markedAs(curve: FigureCurve, d: string, style: Style): Shape {
  const colour = style.colours[curve.colour];
  const kind = `mark ${curve.mark} ${curve.colour}`;
  const hollow = curve.mark !== "points";
  return hollow
    ? { kind: "path", class: kind, d, stroke: colour, width: Math.max(style.hair, 2 * style.lines) }
    : { kind: "path", class: kind, d, fill: colour, stroke: style.card, width: style.hair };
}

const manyMarks = 400; // from here on they are one path: nobody points at one

function pointsOf(curve: FigureCurve, frame: Frame, style: Style): Shape[] {
  const places: [number, number][] = [];
  curve.x.forEach((it, i) => {
    const value = curve.y[i];
    const [x, y] = [it === null ? NaN : frame.x.at(it), value == null ? NaN : frame.y.at(value)];
    if (within(x, frame.x.pixels) && within(y, frame.y.pixels)) places.push([x, y]);
  });
  if (places.length <= manyMarks) return places.map(([x, y]) => markShape(curve, x, y, style));
  const radius = style.marks * curve.width;
  const path = (x: number, y: number): string =>
    curve.mark === "crosses"
      ? crossPath(x, y, radius)
      : `M${px(x - radius)} ${px(y - radius)}h${px(2 * radius)}v${px(2 * radius)}h${px(-2 * radius)}Z`;
  const colour = style.colours[curve.colour];
  const d = places.map(([x, y]) => path(x, y)).join("");
  const all = { kind: "path", class: `mark ${curve.mark} ${curve.colour}`, d } as const;
  return [curve.mark === "points" ? { ...all, fill: colour } : { ...all, stroke: colour, width: style.frame }];
}

function within(value: number, [lower, upper]: readonly [number, number]): boolean {
  return value >= lower - 0.01 && value <= upper + 0.01; // not of what is not finite
}

export function note(text: string, x: number, y: number, anchor: "start" | "end", style: Style): Shape {
  return { kind: "text", class: "note", text, x, y, size: style.text, colour: style.ink, anchor, halo: style.card };
}

function labelOf({ x, y, text, left, text_x, text_y }: FigureLabel, frame: Frame, style: Style): Shape[] {
  const [from_x, from_y] = [frame.x.at(x), frame.y.at(y)];
  if (!within(from_x, frame.x.pixels) || !within(from_y, frame.y.pixels)) return [];
  const anchor = left ? "end" : "start";
  const side = left ? -1 : 1;
  if (!finite(text_x) || !finite(text_y)) {
    const [dx, dy] = [0.6 * style.text, left ? 1.4 * style.text : -0.6 * style.text];
    return [note(text, from_x + side * dx, from_y + dy, anchor, style)];
  }
  const [to_x, to_y] = [frame.x.at(text_x), frame.y.at(text_y)];
  const d = `M${px(from_x)} ${px(from_y)}L${px(to_x)} ${px(to_y)}`;
  return [
    { kind: "path", class: "leader", d, stroke: style.soft, width: style.hair },
    note(text, to_x + 0.2 * side * style.text, to_y + 0.3 * style.text, anchor, style),
  ];
}

/** Lines across, each with its text above it, or below where another is near. */
function levelsOf(figure: Figure, frame: Frame, style: Style): Shape[] {
  const shown = figure.horizontal.filter((it) => it.at !== null && within(frame.y.at(it.at), frame.y.pixels));
  const heights = shown.map((it) => frame.y.at(it.at!));
  return shown.flatMap(({ label }, i): Shape[] => {
    const y = heights[i]!;
    const crowded = [frame.top, ...heights].some((it) => it < y && y - it < 1.5 * style.text);
    const d = `M${px(frame.left)} ${px(y)}H${px(frame.right)}`;
    const dash = [0.2 * style.text, 0.35 * style.text];
    return [
      { kind: "path", class: "marker level", d, stroke: style.soft, width: 2 * style.frame, dash },
      note(label, frame.right - style.gap, y + (crowded ? 1.2 : -0.4) * style.text, "end", style),
    ];
  });
}

function uprightOf({ at, label, label_after }: FigureMarker, frame: Frame, style: Style): Shape[] {
  const x = at === null ? NaN : frame.x.at(at);
  if (!within(x, frame.x.pixels)) return [];
  const d = `M${px(x)} ${px(frame.bottom)}V${px(frame.top)}`;
  const dash = [0.55 * style.text, 0.35 * style.text];
  const y = frame.bottom + 0.7 * (frame.top - frame.bottom);
  const side = label_after ? 1 : -1;
  return [
    { kind: "path", class: "marker upright", d, stroke: style.colours.vermillion, width: 2 * style.frame, dash },
    note(label, x + side * style.gap, y, label_after ? "start" : "end", style),
  ];
}
