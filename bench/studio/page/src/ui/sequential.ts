// Viridis: lighter all the way, for every kind of colour vision and in grey.

type Rgb = readonly [number, number, number];

const viridis: readonly Rgb[] = [
  [68, 1, 84],
  [72, 40, 120],
  [62, 73, 137],
  [49, 104, 142],
  [38, 130, 142],
  [31, 158, 137],
  [53, 183, 121],
  [110, 206, 88],
  [181, 222, 43],
  [253, 231, 37],
];

/** At a share of the scale from 0 to 1. */
export function colourAt(share: number): string {
  const place = Math.min(Math.max(share, 0), 1) * (viridis.length - 1);
  const below = Math.min(Math.floor(place), viridis.length - 2);
  const part = place - below;
  const mixed = [0, 1, 2].map((channel) => {
    const [from, to] = [viridis[below]?.[channel] ?? 0, viridis[below + 1]?.[channel] ?? 0];
    return Math.round(from * (1 - part) + to * part)
      .toString(16)
      .padStart(2, "0");
  });
  return `#${mixed.join("")}`;
}

const dark = matchMedia("(prefers-color-scheme: dark)");

/** The part of the scale that has a contrast of 3:1 or more to the page's ground, as lines need it. */
const onWhite: readonly [number, number] = [0, 0.58];
const onDark: readonly [number, number] = [0.38, 1];

function within([from, to]: readonly [number, number], share: number): string {
  return colourAt(from + (to - from) * share);
}

/** The colour of a line by its place in an order, from 0 to 1: on the page as it is now, and in print. */
export const orderedOnScreen = (share: number): string => within(dark.matches ? onDark : onWhite, share);
export const orderedInPrint = (share: number): string => within(onWhite, share);
