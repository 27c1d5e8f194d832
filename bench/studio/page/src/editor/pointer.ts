import type { Canvas } from "./canvas";
import type { Drawing } from "./drawing";
import { Handles } from "./handles";
import { maxKnots } from "./knots";

/** A press on the plot adds a breakpoint and holds it, one on a breakpoint holds that; a hold is one step back. */
export function takePointer(
  drawing: Drawing,
  canvas: Canvas,
  dropped: () => void,
  refuse: (why: string) => void,
): void {
  const { svg } = canvas.plot;
  let drags = 0;
  let held: { pointer: number; index: number; off: { x: number; y: number } } | null = null;

  svg.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || held) return;
    const at = canvas.plot.pointer(event);
    const handle = Handles.of(event.target);
    if (!handle && !canvas.isInFrame(at)) return;
    event.preventDefault();
    const tag = `drag ${++drags}`;
    let off = { x: 0, y: 0 };
    if (handle) {
      drawing.choose(handle.index, handle.branch);
      const { position, force, knots } = drawing;
      off = {
        x: canvas.plot.x(knots.penetration[handle.index]! * position.perUnit) - at.x,
        y: canvas.plot.y(knots[handle.branch][handle.index]! * force.perUnit) - at.y,
      };
    }
    const index = handle ? handle.index : drawing.add(canvas.spotAt(at), tag);
    if (index < 0)
      return refuse(
        `There is no room for another breakpoint here: a law takes up to ${maxKnots}, apart from each other.`,
      );
    canvas.handles.focus(index, drawing.branch);
    held = { pointer: event.pointerId, index, off };
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener("pointermove", (event) => {
    if (held?.pointer !== event.pointerId) return;
    const at = canvas.plot.pointer(event);
    drawing.move(held.index, canvas.spotAt({ x: at.x + held.off.x, y: at.y + held.off.y }), `drag ${drags}`);
  });
  const drop = (event: PointerEvent): void => {
    if (held?.pointer !== event.pointerId) return;
    held = null;
    dropped();
  };
  svg.addEventListener("pointerup", drop);
  svg.addEventListener("pointercancel", drop);
}
