import { drawn } from "../../ui/dom";

/** From top to bottom, in pixels below the upper end of the axis. */
export type Stretch = readonly [number, number];

const halfWidth = 12;
const halfHandle = 3;

/**
 * A stretch of an upright axis: dragged out anew, pulled along, or taken by one of its ends; a press beside it takes it
 * away. `moved` is told once the pointer is let go, null: of no stretch.
 */
export function brush(
  height: number,
  chosen: Stretch | null,
  moved: (stretch: Stretch | null) => void,
): readonly SVGRectElement[] {
  const rect = (name: string): SVGRectElement => drawn("rect", { class: name, x: -halfWidth, width: 2 * halfWidth });
  const [overlay, selection, upper, lower] = [rect("overlay"), rect("selection"), rect("handle"), rect("handle")];
  let stretch = chosen;
  let drag: ((to: number) => Stretch) | null = null;

  const place = (it: SVGRectElement, from: number, to: number): void => {
    it.setAttribute("y", String(from));
    it.setAttribute("height", String(to - from));
  };
  const show = (): void => {
    for (const it of [selection, upper, lower]) it.setAttribute("visibility", stretch ? "visible" : "hidden");
    if (!stretch) return;
    place(selection, ...stretch);
    place(upper, stretch[0] - halfHandle, stretch[0] + halfHandle);
    place(lower, stretch[1] - halfHandle, stretch[1] + halfHandle);
  };
  const within = (y: number, room = height): number => Math.min(room, Math.max(0, y));
  const at = (event: PointerEvent): number => {
    const box = overlay.getBoundingClientRect();
    return within(((event.clientY - box.top) / Math.max(1, box.height)) * height);
  };
  const from = (fixed: number) => (to: number) => (to < fixed ? ([to, fixed] as const) : ([fixed, to] as const));
  const along =
    ([top, bottom]: Stretch, begin: number) =>
    (to: number) => {
      const moved = within(top + to - begin, height - (bottom - top));
      return [moved, moved + bottom - top] as const;
    };

  const press = (event: PointerEvent): void => {
    if (event.button !== 0 || drag) return;
    event.preventDefault(); // no text is marked
    const { target } = event;
    const before = stretch;
    const begin = at(event);
    if (before && target === selection) drag = along(before, begin);
    else if (before && target === upper) drag = from(before[1]);
    else if (before && target === lower) drag = from(before[0]);
    else drag = from(begin);
    overlay.setPointerCapture(event.pointerId);
    const move = (next: PointerEvent): void => {
      stretch = drag?.(at(next)) ?? null;
      show();
    };
    const end = ({ type }: PointerEvent): void => {
      drag = null;
      for (const [name, listener] of listeners) overlay.removeEventListener(name, listener);
      if (type === "pointercancel") stretch = before;
      else if (target === overlay && (!stretch || stretch === before || stretch[1] - stretch[0] < 1)) stretch = null;
      show();
      if (stretch !== before) moved(stretch);
    };
    const listeners = [
      ["pointermove", move],
      ["pointerup", end],
      ["pointercancel", end],
    ] as const;
    for (const [name, listener] of listeners) overlay.addEventListener(name, listener);
  };
  place(overlay, 0, height);
  const all = [overlay, selection, upper, lower];
  for (const it of all) it.addEventListener("pointerdown", press);
  show();
  return all;
}
