import { drawn } from "../dom";

/** What a drawing is made of, the same on the screen, in a file and on a canvas. Lengths as the drawing's own. */
export type Shape =
  | {
      kind: "path";
      d: string;
      class: string;
      stroke?: string;
      width?: number;
      dash?: readonly number[];
      round?: boolean;
      fill?: string;
      opacity?: number; // of the fill
    }
  | {
      kind: "text";
      text: string;
      x: number;
      y: number; // of its base line
      class: string;
      size: number;
      colour: string;
      anchor: "start" | "middle" | "end";
      bold?: boolean;
      upwards?: boolean; // turned by a quarter to the left, about its place
      halo?: string; // round its letters
    };

/** With so many digits as are seen. */
export const px = (value: number): string => String(Math.round(100 * value) / 100);

function attributesOf(shape: Shape): Record<string, string | number> {
  if (shape.kind === "path") {
    const { d, stroke, width, dash, fill, opacity, round } = shape;
    return {
      class: shape.class,
      d,
      fill: fill ?? "none",
      ...(opacity === undefined ? {} : { "fill-opacity": opacity }),
      ...(stroke === undefined ? {} : { stroke, "stroke-width": px(width ?? 1) }),
      ...(dash?.length ? { "stroke-dasharray": dash.map(px).join(" ") } : {}),
      ...(round ? { "stroke-linejoin": "round", "stroke-linecap": "round" } : {}),
    };
  }
  const { x, y, size, colour, anchor, bold, upwards, halo } = shape;
  return {
    class: shape.class,
    x: px(x),
    y: px(y),
    fill: colour,
    "font-size": px(size),
    "text-anchor": anchor,
    ...(bold ? { "font-weight": 600 } : {}),
    ...(upwards ? { transform: `rotate(-90 ${px(x)} ${px(y)})` } : {}),
    ...(halo ? { stroke: halo, "stroke-width": px(0.28 * size), "paint-order": "stroke" } : {}),
  };
}

/** As an element of the page. */
export function nodeOf(shape: Shape): SVGElement {
  return shape.kind === "path" ? drawn("path", attributesOf(shape)) : drawn("text", attributesOf(shape), shape.text);
}

const entities: Record<string, string> = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" };

/** As text of an XML file, which has no control characters. */
export function escaped(text: string): string {
  return text
    .replace(/[\p{Cc}\p{Cs}\p{Noncharacter_Code_Point}]/gu, " ")
    .replace(/[&<>"]/g, (it) => entities[it] ?? it);
}

/** As a line of a file; classes are the page's. */
export function markupOf(shape: Shape): string {
  const attributes = Object.entries(attributesOf(shape))
    .filter(([name]) => name !== "class")
    .map(([name, value]) => ` ${name}="${escaped(String(value))}"`)
    .join("");
  return shape.kind === "path" ? `<path${attributes}/>` : `<text${attributes}>${escaped(shape.text)}</text>`;
}

/** On a canvas whose lengths are the drawing's own. */
export function paint(context: CanvasRenderingContext2D, shape: Shape, font: string): void {
  context.save();
  if (shape.kind === "path") {
    const path = new Path2D(shape.d);
    context.lineJoin = shape.round ? "round" : "miter";
    context.lineCap = shape.round ? "round" : "butt";
    if (shape.fill && shape.fill !== "none") {
      context.fillStyle = shape.fill;
      context.globalAlpha = shape.opacity ?? 1;
      context.fill(path);
      context.globalAlpha = 1;
    }
    if (shape.stroke) {
      context.strokeStyle = shape.stroke;
      context.lineWidth = shape.width ?? 1;
      context.setLineDash([...(shape.dash ?? [])]);
      context.stroke(path);
    }
  } else {
    context.translate(shape.x, shape.y);
    if (shape.upwards) context.rotate(-Math.PI / 2);
    context.font = `${shape.bold ? "600 " : ""}${shape.size}px ${font}`;
    context.textAlign = shape.anchor === "middle" ? "center" : shape.anchor;
    if (shape.halo) {
      context.strokeStyle = shape.halo;
      context.lineWidth = 0.28 * shape.size;
      context.lineJoin = "round";
      context.strokeText(shape.text, 0, 0);
    }
    context.fillStyle = shape.colour;
    context.fillText(shape.text, 0, 0);
  }
  context.restore();
}

let ruler: CanvasRenderingContext2D | null = null;

/** How wide a text is. */
export function widthOf(text: string, size: number, font: string, bold = false): number {
  ruler ??= document.createElement("canvas").getContext("2d");
  if (!ruler) return 0.55 * size * text.length;
  ruler.font = `${bold ? "600 " : ""}100px ${font}`;
  return (ruler.measureText(text).width * size) / 100;
}
