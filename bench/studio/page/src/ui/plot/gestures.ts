/** A place of a plot in shares of its width and height, from the left and from below. */
export interface Place {
  x: number;
  y: number;
}
export type Along = "x" | "y" | "both";

/** A picture that pointers and keys move: a plot, or several with one time axis. */
export interface Movable {
  /** Only the cursor moves; whoever zooms is told. */
  readonly fixed: boolean;
  box: () => { left: number; top: number; width: number; height: number }; // in the window, without axes
  point: (at: Place | null) => void;
  pan: (right: number, up: number) => void; // by shares of what is shown
  zoom: (factor: number, at: Place | null, along: Along) => void; // null: about the cursor, or the middle
  showPart: (from: Place, to: Place) => void;
  whole: () => void;
  /** The cursor to its next place in a direction, or to an end. */
  step: (to: "left" | "right" | "up" | "down" | "begin" | "end") => void;
  /** What is being dragged out; null: no more. */
  selecting: (from: Place | null, to: Place | null) => void;
  /** Whether a wheel that turns over it is meant for it rather than for the page. */
  takesWheel: () => boolean;
  /** Whether a press here is not for the picture, such as on a mark that can be opened. */
  isTaken?: (event: PointerEvent) => boolean;
}

/**
 * Pointers on a picture: the wheel zooms about where it points (beside an axis along that axis), a mouse drags out what
 * to show (with Shift it pulls the picture), a finger pulls, two fingers zoom; a double click shows all.
 */
export function gestures(over: Element & GlobalEventHandlers, picture: Movable): void {
  const held = new Map<number, { x: number; y: number }>(); // each pointer that is down
  let begin: Place | null = null; // where a stretch begins to be dragged out

  const placeOf = ({ clientX, clientY }: { clientX: number; clientY: number }): Place => {
    const { left, top, width, height } = picture.box();
    return { x: (clientX - left) / Math.max(1, width), y: 1 - (clientY - top) / Math.max(1, height) };
  };
  const inside = (at: Place): boolean => at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1;

  over.addEventListener("pointerdown", (event: PointerEvent) => {
    if (event.button !== 0 || picture.fixed || picture.isTaken?.(event) || !inside(placeOf(event))) return;
    over.setPointerCapture(event.pointerId);
    held.set(event.pointerId, { x: event.clientX, y: event.clientY });
    begin = event.pointerType === "mouse" && !event.shiftKey && held.size === 1 ? placeOf(event) : null;
  });
  over.addEventListener("pointermove", (event: PointerEvent) => {
    const before = held.get(event.pointerId);
    if (before && begin) picture.selecting(begin, placeOf(event));
    else if (before) move(event, before);
    if (!before || begin) picture.point(placeOf(event));
  });
  const move = (event: PointerEvent, before: { x: number; y: number }): void => {
    const { width, height } = picture.box();
    const other = [...held].find(([id]) => id !== event.pointerId)?.[1];
    held.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (!other) {
      picture.pan((before.x - event.clientX) / Math.max(1, width), (event.clientY - before.y) / Math.max(1, height));
      return;
    }
    const far = (at: { x: number; y: number }): number => Math.max(10, Math.hypot(at.x - other.x, at.y - other.y));
    const factor = far(before) / far({ x: event.clientX, y: event.clientY });
    picture.zoom(factor, placeOf({ clientX: other.x, clientY: other.y }), "both");
  };
  const release = (event: PointerEvent): void => {
    if (!held.delete(event.pointerId)) return;
    const { width, height } = picture.box();
    const to = placeOf(event);
    const wide = begin ? Math.hypot((to.x - begin.x) * width, (to.y - begin.y) * height) : 0;
    if (begin && event.type === "pointerup" && wide >= 4) picture.showPart(begin, to);
    begin = null;
    picture.selecting(null, null);
  };
  over.addEventListener("pointerup", release);
  over.addEventListener("pointercancel", release);
  over.addEventListener("pointerleave", (event: PointerEvent) => {
    if (event.pointerType === "mouse" && held.size === 0) picture.point(null);
  });
  over.addEventListener(
    "wheel",
    (event: WheelEvent) => {
      if ((event.ctrlKey && event.deltaMode !== 0) || !(picture.takesWheel() || event.ctrlKey)) return;
      event.preventDefault();
      const lines = event.deltaMode === 0 ? event.deltaY / 100 : event.deltaY / 3;
      const at = placeOf(event);
      if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) picture.pan(event.deltaX / 600, 0);
      else picture.zoom(1.25 ** lines, at, at.x < 0 ? "y" : at.y < 0 ? "x" : "both");
    },
    { passive: false },
  );
  over.addEventListener("dblclick", () => picture.whole());
}

const arrows = { ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down" } as const;
const ways = { left: [-1, 0], right: [1, 0], up: [0, 1], down: [0, -1] } as const;

/** Keys of a picture that has the focus; true if it was one of them. `cursor`: arrows alone move the cursor. */
export function pictureKey(event: KeyboardEvent, picture: Movable, cursor = true): boolean {
  if (event.ctrlKey || event.altKey || event.metaKey) return false;
  const { key } = event;
  if (key in arrows) {
    const way = arrows[key as keyof typeof arrows];
    const [right, up] = ways[way];
    if (event.shiftKey) picture.pan(0.2 * right, 0.2 * up);
    else if (cursor) picture.step(way);
    else return false;
  } else if (key === "PageUp" || key === "PageDown") picture.pan(key === "PageUp" ? -0.9 : 0.9, 0);
  else if (key === "Home" || key === "End") picture.step(key === "Home" ? "begin" : "end");
  else if (key === "0") picture.whole();
  else if (key === "+" || key === "=") picture.zoom(0.5, null, "both");
  else if (key === "-" || key === "−") picture.zoom(2, null, "both");
  else return false;
  event.preventDefault();
  return true;
}
