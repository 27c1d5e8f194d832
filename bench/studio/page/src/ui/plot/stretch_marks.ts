import type { FigureMark } from "../figure_description";
import { hatch, type Box } from "./cells";
import type { Frame } from "./frame";
import { px, widthOf, type Shape } from "./shapes";
import type { Style } from "./style";

type Kind = FigureMark["kind"];

/** As the legend says them, in its order. */
export const markNames: Record<Kind, string> = {
  closing: "closing",
  opening: "opening",
  gap: "no rows",
  event: "event",
  cycle: "cycle",
  flagged: "flagged cycle",
  clipped: "clipped rows",
};

/** What lies under the lines and what lies over them, as the page's canvas has it (ui/time): told by shape, not by colour alone. */
export function marksOf(marks: readonly FigureMark[], frame: Frame, style: Style): { under: Shape[]; over: Shape[] } {
  const [under, over]: [Shape[], Shape[]] = [[], []];
  const texts: Shape[] = [];
  for (const { kind, begin, end, texts: words } of marks) {
    const from = Math.max(frame.left, frame.x.at(begin));
    const to = Math.min(frame.right, frame.x.at(end));
    if (!(from <= to)) continue;
    const box = { x: from, y: frame.top, width: to - from, height: frame.bottom - frame.top };
    (kind === "event" || kind === "cycle" ? over : under).push(...markSample(kind, box, style));
    texts.push(...textIn(kind, box, words, style));
  }
  return { under, over: [...over, ...texts] };
}

/** A mark that fills a box; one of no width is a line. Also a sample of the legend. */
export function markSample(kind: Kind, box: Box, style: Style): Shape[] {
  const { x, y, width, height } = box;
  const strip = Math.min(0.35 * style.text, 0.4 * height);
  const { blue, orange, vermillion } = style.colours;
  const filled = (d: string, fill: string, opacity = 1): Shape => ({
    kind: "path",
    class: `marked ${kind}`,
    d,
    fill,
    opacity,
  });
  const stroked = (d: string, stroke: string, more: object = {}): Shape => {
    return { kind: "path", class: `marked ${kind}`, d, stroke, width: style.frame, ...more };
  };
  const hatched = (stroke: string, step: number): Shape =>
    stroked(hatch(box, step * style.text), stroke, { width: style.hair });
  switch (kind) {
    case "closing":
      return [filled(rectangle(box), blue, 0.1), filled(rectangle({ ...box, height: strip }), blue)];
    case "opening":
      return [
        filled(rectangle(box), orange, 0.1),
        filled(stripes({ ...box, height: strip }, 0.5 * style.text), orange),
      ];
    case "gap":
      return [filled(rectangle(box), style.grid), hatched(style.soft, 0.8)];
    case "cycle": {
      const [up, inset] = [Math.min(0.5 * style.text, height), Math.min(style.frame, 0.25 * width)];
      const foot = y + height - style.frame;
      const d = `M${px(x + inset)} ${px(foot - up)}V${px(foot)}H${px(x + width - inset)}V${px(foot - up)}`;
      return [stroked(d, style.ink)];
    }
    case "flagged":
      return [
        filled(rectangle(box), vermillion, 0.12),
        hatched(vermillion, 1.1),
        filled(rectangle({ ...box, y: y + height - 1.6 * strip, height: 1.6 * strip }), vermillion),
      ];
    case "clipped": {
      const wide = Math.max(width, 0.5 * style.text);
      const block = { x: x + 0.5 * (width - wide), y, width: wide, height: Math.min(0.9 * style.text, 0.4 * height) };
      return [
        filled(rectangle(box), style.ink, 0.2),
        filled(rectangle(block), style.ink),
        stroked(`M${px(x)} ${px(y)}v${px(height)}M${px(x + width)} ${px(y)}v${px(height)}`, style.ink, {
          width: style.hair,
        }),
      ];
    }
    case "event": {
      const [at, flag] = [x + 0.5 * width, 0.6 * style.text];
      const d = `M${px(at)} ${px(y)}l${px(flag)} ${px(0.5 * flag)}l${px(-flag)} ${px(0.5 * flag)}Z`;
      const dash = [0.2 * style.text, 0.2 * style.text];
      return [stroked(`M${px(at)} ${px(y)}v${px(height)}`, style.ink, { dash }), filled(d, style.ink)];
    }
  }
}

/** Phases are named along the top, what is wrong with a cycle along the bottom. */
function textIn(kind: Kind, { x, y, width, height }: Box, words: readonly string[], style: Style): Shape[] {
  const { text: size, font } = style;
  const text = words.find((it) => it && widthOf(it, size, font) + 0.8 * size < width);
  if (text === undefined) return [];
  const base = kind === "flagged" ? y + height - 0.9 * size : y + 1.5 * size;
  return [
    {
      kind: "text",
      class: "note",
      text,
      x: x + 0.4 * size,
      y: base,
      size,
      colour: style.ink,
      anchor: "start",
      halo: style.card,
    },
  ];
}

function rectangle({ x, y, width, height }: Box): string {
  return `M${px(x)} ${px(y)}h${px(width)}v${px(height)}h${px(-width)}Z`;
}

function stripes({ x, y, width, height }: Box, step: number): string {
  let path = "";
  for (let at = x; at < x + width; at += 1.6 * step)
    path += rectangle({ x: at, y, width: Math.min(step, x + width - at), height });
  return path;
}
