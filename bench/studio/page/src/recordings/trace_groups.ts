import type { Axis, Trace, TraceView } from "../api/recordings";
import { looks } from "../ui/palette";
import type { TimeLine } from "../ui/time/time_line";
import type { PlotOrder } from "../ui/time/time_stack";

const titles: Record<Trace["group"], string> = {
  position: "Position",
  velocity: "Velocity",
  force: "Force",
  timing: "Timing",
  channel: "Channel",
};

/** "position theta" -> "theta": the axis that a trace is of; empty for none. */
export function axisOf(trace: Trace, axes: readonly Axis[]): string {
  return axes.find((it) => trace.name.endsWith(` ${it.name}`))?.name ?? "";
}

/** "force_commanded x" -> "force commanded x"; an axis that is called as its quantity is named once. */
export function inWords(name: string): string {
  return name.replaceAll("_", " ").replace(/(^| )(\w+) \2$/, "$1$2");
}

/** "position theta", and "position" of an axis of that name. */
export function namedOnce(quantity: string, axis: string): string {
  return quantity === axis ? quantity : `${quantity} ${axis}`;
}

export function emptyLine(trace: Trace, look: number): TimeLine {
  return {
    name: inWords(trace.name),
    unit: trace.unit,
    look: look % looks.length,
    time: new Float64Array(0),
    smallest: new Float64Array(0),
    largest: new Float64Array(0),
    shift_s: 0,
    step_s: 1,
    middle_s: 0,
  };
}

/** Traces of one group and unit share a plot; `lines` are in the order of `traces`. */
export function plotsOf(traces: readonly Trace[], lines: readonly TimeLine[], logarithmic = false): PlotOrder[] {
  const orders = new Map<string, PlotOrder>();
  traces.forEach((trace, k) => {
    const line = lines[k];
    if (!line) return;
    const key = `${trace.group} ${trace.unit}`;
    const order = orders.get(key) ?? {
      title: titles[trace.group],
      lines: [],
      logarithmic: logarithmic && trace.group === "timing",
    };
    line.look = order.lines.length % looks.length;
    order.lines.push(line);
    orders.set(key, order);
  });
  return [...orders.values()];
}

/** Puts one trace of an answer into its line. */
export function takeView(line: TimeLine, view: TraceView, trace: number, period_s: number): void {
  const found = view.traces[trace];
  if (!found) return;
  line.time = view.time;
  line.smallest = found.smallest;
  line.largest = found.largest;
  line.step_s = view.rowsPerColumn * period_s;
  line.middle_s = Math.max(0, view.rowsPerColumn - 1) * 0.5 * period_s;
}
