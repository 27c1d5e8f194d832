import type { TimeRange } from "./time_range";

/**
 * Pointers on a plot: the wheel zooms about where it points, a mouse drags out the stretch to show (with Shift it
 * pulls the picture), a finger pulls, two fingers zoom; a double click shows all.
 */
export function timeGestures(over: HTMLElement, range: TimeRange): void {
  const held = new Map<number, number>(); // x of each pointer that is down
  const mark = document.createElement("div");
  mark.className = "time_select";
  mark.hidden = true;
  over.append(mark);
  let begin: number | null = null; // where a stretch begins to be dragged out

  const box = (): DOMRect => over.getBoundingClientRect();
  const timeAt = (x: number): number => {
    const { left, width } = box();
    return range.from + ((x - left) / Math.max(1, width)) * range.span;
  };
  const select = (x: number): void => {
    if (begin === null) return;
    const { left, width } = box();
    const from = Math.max(0, Math.min(begin, x) - left);
    const to = Math.min(width, Math.max(begin, x) - left);
    mark.hidden = to - from < 4;
    mark.style.left = `${from}px`;
    mark.style.width = `${to - from}px`;
  };

  over.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || range.following) return;
    over.setPointerCapture(event.pointerId);
    held.set(event.pointerId, event.clientX);
    begin = event.pointerType === "mouse" && !event.shiftKey && held.size === 1 ? event.clientX : null;
  });
  over.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (before === undefined) return range.point(timeAt(event.clientX));
    if (begin !== null) {
      select(event.clientX);
      return range.point(timeAt(event.clientX));
    }
    const xs = [...held.entries()];
    held.set(event.pointerId, event.clientX);
    if (xs.length === 1) range.panBy(((before - event.clientX) / Math.max(1, box().width)) * range.span);
    if (xs.length === 2) {
      const other = xs.find(([id]) => id !== event.pointerId)?.[1] ?? before;
      const apart = Math.max(10, Math.abs(event.clientX - other));
      range.zoom(Math.max(10, Math.abs(before - other)) / apart, timeAt(other));
    }
  });
  const release = (event: PointerEvent): void => {
    if (!held.delete(event.pointerId)) return;
    if (begin !== null && event.type === "pointerup" && Math.abs(event.clientX - begin) >= 4) {
      const [a, b] = [timeAt(begin), timeAt(event.clientX)];
      range.show(Math.min(a, b), Math.max(a, b));
    }
    begin = null;
    mark.hidden = true;
  };
  over.addEventListener("pointerup", release);
  over.addEventListener("pointercancel", release);
  over.addEventListener("pointerleave", (event) => {
    if (event.pointerType === "mouse" && held.size === 0) range.point(null);
  });
  over.addEventListener("wheel", (event) => {
    if (event.ctrlKey && event.deltaMode !== 0) return;
    event.preventDefault();
    const lines = event.deltaMode === 0 ? event.deltaY / 100 : event.deltaY / 3;
    if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) range.pan(event.deltaX / 600);
    else range.zoom(1.25 ** lines, timeAt(event.clientX));
  });
  over.addEventListener("dblclick", () => range.whole());
}

/** Keys of a plot that has the focus; true if it was one of them. */
export function timeKey(event: KeyboardEvent, range: TimeRange): boolean {
  if (event.ctrlKey || event.altKey || event.metaKey) return false;
  const left = event.key === "ArrowLeft";
  if (left || event.key === "ArrowRight") {
    if (event.shiftKey) range.pan(left ? -0.2 : 0.2);
    else step(range, left ? -1 : 1);
  } else if (event.key === "PageUp" || event.key === "PageDown") range.pan(event.key === "PageUp" ? -0.9 : 0.9);
  else if (event.key === "Home") range.point(range.from);
  else if (event.key === "End") range.point(range.to);
  else if (event.key === "0") range.whole();
  else if (event.key === "+" || event.key === "=") range.zoom(0.5);
  else if (event.key === "-" || event.key === "−") range.zoom(2);
  else return false;
  event.preventDefault();
  return true;
}

/** The cursor by a two-hundredth of what is shown; at the edge the picture moves on. */
function step(range: TimeRange, direction: number): void {
  if (range.cursor === null) return range.point((range.from + range.to) / 2);
  const by = (direction * range.span) / 200;
  const next = range.cursor + by;
  if (next < range.from || next > range.to) range.panBy(20 * by);
  range.point(next);
}
