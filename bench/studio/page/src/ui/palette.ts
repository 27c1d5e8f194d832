// Colours of what is drawn on a canvas: those of the style sheet, in light and dark.

export interface Palette {
  ink: string;
  soft: string;
  line: string;
  grid: string;
  card: string;
  lines: readonly string[]; // told apart by those who are colour-blind; and each has a dash of its own
}

/** In pixels of the page; the first is a plain line. */
export const dashes: readonly (readonly number[])[] = [[], [9, 4], [2.5, 3], [10, 3, 2.5, 3], [5, 2.5], [14, 3]];
export const looks = dashes.length;

const names = ["--blue", "--vermillion", "--green", "--purple", "--orange", "--sky"];
const dark = matchMedia("(prefers-color-scheme: dark)");
let current: Palette | null = null;

export function palette(): Palette {
  if (current) return current;
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string): string => style.getPropertyValue(name).trim();
  current = {
    ink: colour("--ink"),
    soft: colour("--soft"),
    line: colour("--line"),
    grid: colour("--grid"),
    card: colour("--card"),
    lines: names.map(colour),
  };
  return current;
}

/** Calls whenever light becomes dark or back; gives back what ends that. */
export function onColours(changed: () => void): () => void {
  const again = (): void => {
    current = null;
    changed();
  };
  dark.addEventListener("change", again);
  return () => dark.removeEventListener("change", again);
}
