// Colours of what is drawn on a canvas: those of the style sheet, in light and dark.

export interface Palette {
  ink: string;
  soft: string;
  line: string;
  grid: string;
  card: string;
  lines: readonly string[]; // told apart by those who are colour-blind; and each has a mark of its own
  figure: Readonly<Record<string, string>>; // of figures, by name
}

/** Names of what is drawn in turn; marks.ts has a shape for each. */
export const looks = ["blue", "vermillion", "green", "purple", "orange", "sky"] as const;

const ofFigures = [...looks, "yellow", "grey", "sky_cell", "orange_cell", "hatch"];
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
    lines: looks.map((it) => colour(`--${it}`)),
    figure: Object.fromEntries(ofFigures.map((it) => [it, colour(`--${it}`)])),
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
