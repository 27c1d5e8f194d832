import { drawn } from "../ui/dom";

// A law is told by a colour and by a shape, so that neither alone has to be seen.

const shapes: readonly ((x: number, y: number, r: number) => string)[] = [
  (x, y, r) => `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`,
  (x, y, r) =>
    polygon(x, y, [
      [-r, -r],
      [r, -r],
      [r, r],
      [-r, r],
    ]),
  (x, y, r) =>
    polygon(x, y, [
      [0, -1.2 * r],
      [1.15 * r, 0.9 * r],
      [-1.15 * r, 0.9 * r],
    ]),
  (x, y, r) =>
    polygon(x, y, [
      [0, -1.35 * r],
      [1.35 * r, 0],
      [0, 1.35 * r],
      [-1.35 * r, 0],
    ]),
  (x, y, r) =>
    polygon(x, y, [
      [0, 1.2 * r],
      [1.15 * r, -0.9 * r],
      [-1.15 * r, -0.9 * r],
    ]),
  (x, y, r) => {
    const w = 0.45 * r;
    const l = 1.25 * r;
    return polygon(x, y, [
      [-w, -l],
      [w, -l],
      [w, -w],
      [l, -w],
      [l, w],
      [w, w],
      [w, l],
      [-w, l],
      [-w, w],
      [-l, w],
      [-l, -w],
      [-w, -w],
    ]);
  },
  (x, y, r) => star(x, y, r, 5),
  (x, y, r) => star(x, y, r, 4),
];
const colours = ["blue", "vermillion", "green", "purple", "orange", "sky"];

function polygon(x: number, y: number, corners: readonly (readonly [number, number])[]): string {
  return `M${corners.map(([dx, dy]) => `${(x + dx).toFixed(1)} ${(y + dy).toFixed(1)}`).join("L")}Z`;
}

function star(x: number, y: number, r: number, tips: number): string {
  const corners = Array.from({ length: 2 * tips }, (_, i): [number, number] => {
    const far = i % 2 === 0 ? 1.4 * r : 0.6 * r;
    const angle = (Math.PI * i) / tips - Math.PI / 2;
    return [far * Math.cos(angle), far * Math.sin(angle)];
  });
  return polygon(x, y, corners);
}

/** The look of the n-th law: its class gives the colour. Colour and shape go round with different periods. */
export function markClass(law: number): string {
  return `mark ${colours[law % colours.length] ?? "blue"}`;
}

export function markPath(law: number, x: number, y: number, radius: number): string {
  return (shapes[law % shapes.length] ?? shapes[0]!)(x, y, radius);
}

/** A mark by itself, for a legend. */
export function markSample(law: number): SVGSVGElement {
  return drawn(
    "svg",
    { class: "sample", viewBox: "0 0 22 22", width: 22, height: 22, "aria-hidden": "true" },
    drawn("path", { class: markClass(law), d: markPath(law, 11, 11, 7) }),
  );
}
