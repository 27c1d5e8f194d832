import type { Recording, Trace } from "../api/recordings";

/** Which axis of another recording an axis is laid over: that of its name, or the only one; -1: none, or of another unit. */
export function axisOver(own: Recording, axis: number, other: Recording): number {
  const { name, position_unit } = own.axes[axis] ?? { name: "", position_unit: "" };
  const same = other.axes.findIndex((it) => it.name === name);
  const found = same < 0 && own.axes.length === 1 && other.axes.length === 1 ? 0 : same;
  return other.axes[found]?.position_unit === position_unit ? found : -1;
}

/** The same of a trace: of axes that are called unlike, "position theta" and "position x" are a pair. */
export function traceOver(own: Recording, trace: Trace, other: Recording): number {
  const place = (name: string): number => other.traces.findIndex((it) => it.name === name && it.unit === trace.unit);
  const same = place(trace.name);
  if (same >= 0 || own.axes.length !== 1 || other.axes.length !== 1) return same;
  const ending = ` ${own.axes[0]!.name}`;
  return trace.name.endsWith(ending) ? place(`${trace.name.slice(0, -ending.length)} ${other.axes[0]!.name}`) : -1;
}

/** Why nothing of a recording can be drawn over another; empty where something can. */
export function whyNotOver(own: Recording, other: Recording): string {
  if (own.traces.some((trace) => trace.name !== "time" && traceOver(own, trace, other) >= 0)) return "";
  const axes = (it: Recording): string =>
    it.axes.map(({ name, position_unit, force_unit }) => `${name} [${position_unit}, ${force_unit}]`).join(", ");
  return `it has no trace of the same name and unit (${axes(other)} beside ${axes(own)})`;
}
