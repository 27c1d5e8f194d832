// A file of its own, parallel.js, which the page of a sweep loads when it has parallel coordinates to show.

import { brushY, type BrushEvent } from "d3-brush";
import { select } from "d3-selection";

import type { BrushAxis, Brushes } from "./brush_axis";

/** Puts a brush on an axis from y = 0 to `height`; `moved` is told of what a person has brushed, null: nothing. */
const brushes: Brushes = (axis: BrushAxis): ((range: [number, number] | null) => void) => {
  const brush = brushY()
    .extent([
      [-12, 0],
      [12, axis.height],
    ])
    .on("end", (event: BrushEvent) => {
      if (event.sourceEvent) axis.moved(event.selection);
    });
  const group = select(axis.group);
  group.call(brush);
  return (range) => {
    group.call(brush.move, range);
  };
};

declare global {
  interface Window {
    kerfBrushes?: Brushes;
  }
}
window.kerfBrushes = brushes;
