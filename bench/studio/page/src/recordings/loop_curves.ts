import type { Loops } from "../api/recordings";
import { lineOf, type FigureCurve } from "../ui/figure_description";
import { looks } from "../ui/palette";

export type Kind = "all" | "one" | "average";

/**
 * Lines of one of several recordings: solid, since they were measured; closing thick, opening thin. One laid over others
 * (`look` > 0) is its average where they show all cycles.
 */
export function loopCurves(loops: Loops, kind: Kind, look: number, recording: string): FigureCurve[] {
  const colour = looks[look % looks.length]!;
  const marked = recording !== "";
  const of = (what: string): string => [recording, what].filter(Boolean).join(", ");
  if (loops.whole)
    return [lineOf(recording, loops.whole.position, loops.whole.force, { colour, width: 1, name: of("all rows") })];
  const { position, closing, opening } = loops.average;
  if (kind === "average" || (kind === "all" && look > 0)) {
    // Beside others a recording has one colour; by itself closing is blue and opening red, as in reports.
    const named = (what: string): { marked: boolean; name: string } => ({ marked, name: of(what) });
    return [
      lineOf(of("closing"), position, closing, { colour, width: 2.75, ...named("closing") }),
      lineOf(of("opening"), position, opening, {
        colour: marked ? colour : "vermillion",
        width: 1.25,
        ...named("opening"),
      }),
    ];
  }
  const width = kind === "one" ? 2 : 1;
  const last = loops.loops.length - 1;
  const isOrdered = kind === "all" && !marked && last > 0;
  return loops.loops.map((it, k) =>
    lineOf(k === 0 ? recording : "", it.position, it.force, {
      colour,
      width,
      name: of(`cycle ${it.cycle}`),
      ...(isOrdered ? { order: k / last } : {}),
    }),
  );
}

/** What the colours of cycles at once mean; empty where they mean nothing. */
export function orderInWords(curves: readonly FigureCurve[]): string {
  const ordered = curves.filter((it) => it.order !== undefined);
  return ordered.length === 0 ? "" : `${ordered[0]!.name} to ${ordered[ordered.length - 1]!.name}, in their order`;
}
