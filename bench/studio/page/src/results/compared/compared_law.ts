import type { Residuals } from "../../api/results";
import type { Colour } from "../../ui/figure_description";

/** A law beside others, over the same recording. */
export interface ComparedLaw {
  model: string;
  colour: Colour;
  residuals: Residuals;
}

/** Laws have the colours of the table, in its order; what was measured is black. */
export const lawColours: readonly Colour[] = ["blue", "vermillion", "green", "purple", "orange", "sky"];
export const atMostCompared = lawColours.length;
