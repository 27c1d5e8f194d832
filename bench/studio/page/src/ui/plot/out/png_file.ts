import { outline } from "../frame";
import { paint } from "../shapes";
import { printStyle } from "../style";
import type { Printed } from "./sheet";

export const dotsPerInch = 600;

/** A printed sheet as a PNG of 600 dots an inch, which the file says, as well as what its numbers are. */
export async function pngOf(sheet: Printed): Promise<Blob> {
  const scale = dotsPerInch / 72;
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(sheet.width * scale);
  canvas.height = Math.round(sheet.height * scale);
  const context = canvas.getContext("2d");
  if (!context) throw new Error("the browser gives no canvas of this size");
  context.fillStyle = printStyle.card;
  context.fillRect(0, 0, canvas.width, canvas.height);
  for (const { shapes, clip, down } of sheet.parts) {
    context.save();
    context.scale(scale, scale);
    context.translate(0, down);
    if (clip) context.clip(new Path2D(outline(clip)));
    for (const shape of shapes) paint(context, shape, printStyle.font);
    context.restore();
  }
  const drawn = await new Promise<Blob | null>((done) => canvas.toBlob(done, "image/png"));
  if (!drawn) throw new Error("the browser could not make a PNG of this size");
  const text = [sheet.title, ...sheet.notes].join(". ");
  return withFacts(new Uint8Array(await drawn.arrayBuffer()), text);
}

/** With its size and a description in chunks of their own, behind the head. */
function withFacts(png: Uint8Array, text: string): Blob {
  const perMetre = Math.round(dotsPerInch / 0.0254);
  const size = new DataView(new ArrayBuffer(9));
  size.setUint32(0, perMetre);
  size.setUint32(4, perMetre);
  size.setUint8(8, 1); // metres
  // Keyword, no compression, no language, no keyword of that language.
  const description = new TextEncoder().encode(`Description\0\0\0\0\0${text}`);
  const head = 8 + 25; // the signature and IHDR
  const parts = [
    png.slice(0, head),
    chunk("pHYs", new Uint8Array(size.buffer)),
    chunk("iTXt", description),
    png.slice(head),
  ];
  return new Blob(parts, { type: "image/png" });
}

function chunk(name: string, data: Uint8Array): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(12 + data.length);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, data.length);
  bytes.set(new TextEncoder().encode(name), 4);
  bytes.set(data, 8);
  view.setUint32(8 + data.length, crc32(bytes.subarray(4, 8 + data.length)));
  return bytes;
}

function crc32(bytes: Uint8Array): number {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return (crc ^ 0xffffffff) >>> 0;
}
