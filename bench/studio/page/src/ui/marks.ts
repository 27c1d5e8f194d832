import type { Colour } from "./figure_description";

// What is told by a colour is told by a shape as well, so that neither alone has to be seen.

type Shape = (x: number, y: number, r: number) => string;

const disc: Shape = (x, y, r) => `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`;

const shapes: Record<Colour, Shape> = {
  black: disc,
  blue: disc,
  vermillion: (x, y, r) =>
    polygon(x, y, [
      [-r, -r],
      [r, -r],
      [r, r],
      [-r, r],
    ]),
  green: (x, y, r) =>
    polygon(x, y, [
      [0, -1.2 * r],
      [1.15 * r, 0.9 * r],
      [-1.15 * r, 0.9 * r],
    ]),
  purple: (x, y, r) =>
    polygon(x, y, [
      [0, -1.35 * r],
      [1.35 * r, 0],
      [0, 1.35 * r],
      [-1.35 * r, 0],
    ]),
  orange: (x, y, r) =>
    polygon(x, y, [
      [0, 1.2 * r],
      [1.15 * r, -0.9 * r],
      [-1.15 * r, -0.9 * r],
    ]),
  sky: (x, y, r) => {
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
  grey: (x, y, r) => star(x, y, r, 5),
  yellow: (x, y, r) => star(x, y, r, 4),
};

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

export function markPath(colour: Colour, x: number, y: number, radius: number): string {
  return shapes[colour](x, y, radius);
}

export function crossPath(x: number, y: number, r: number): string {
  return `M${x - r} ${y - r}L${x + r} ${y + r}M${x - r} ${y + r}L${x + r} ${y - r}`;
}
