import { outline } from "../frame";
import { escaped, markupOf, px } from "../shapes";
import { printStyle } from "../style";
import { pointsOf, type Printed } from "./sheet";

/** A printed sheet as an SVG file of its true size, with no more than SVG 1.1, so that every editor takes it. */
export function svgOf({ title, notes, width, height, parts }: Printed): string {
  const mm = (points: number): string => px(points / pointsOf(1));
  const size = `width="${mm(width)}mm" height="${mm(height)}mm" viewBox="0 0 ${px(width)} ${px(height)}"`;
  const lines = [
    '<?xml version="1.0" encoding="UTF-8"?>',
    `<svg xmlns="http://www.w3.org/2000/svg" ${size} font-family="${escaped(printStyle.font)}">`,
    `<title>${escaped(title)}</title>`,
    `<desc>${escaped([...notes, "Drawn by Kerf studio."].join(" "))}</desc>`,
    `<rect width="${px(width)}" height="${px(height)}" fill="#ffffff"/>`,
  ];
  parts.forEach(({ shapes, clip, down }, i) => {
    if (shapes.length === 0) return;
    if (clip) lines.push(`<clipPath id="frame_${i}"><path d="${outline(clip)}"/></clipPath>`);
    lines.push(`<g transform="translate(0 ${px(down)})">`);
    if (clip) lines.push(`<g clip-path="url(#frame_${i})">`);
    lines.push(...shapes.map(markupOf));
    lines.push(clip ? "</g></g>" : "</g>");
  });
  return `${lines.join("\n")}\n</svg>\n`;
}
