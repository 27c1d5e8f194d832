import type { Canvas } from "./canvas";
import type { Drawing } from "./drawing";
import { Handles, nameOf } from "./handles";
import { fewestKnots, forceAt, maxKnots, type Branch } from "./knots";
import { inUnits } from "./scale";

const arrows: Record<string, { x: number; y: number }> = {
  ArrowLeft: { x: -1, y: 0 },
  ArrowRight: { x: 1, y: 0 },
  ArrowUp: { x: 0, y: 1 },
  ArrowDown: { x: 0, y: -1 },
};

interface Told {
  /** After a change that is not part of a drag. */
  settled: () => void;
  /** Read out, not shown. */
  announce: (text: string) => void;
  refuse: (why: string) => void;
}

/** Undo and redo from anywhere on the page but a field that has an undo of its own. */
export function isUndo(event: KeyboardEvent): "undo" | "redo" | null {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return null;
  if (event.target instanceof HTMLInputElement) return null;
  const key = event.key.toLowerCase();
  if (key === "z") return event.shiftKey ? "redo" : "undo";
  return key === "y" && !event.shiftKey ? "redo" : null;
}

/** Everything that the pointer does, by keys: the cursor of the plot, and the breakpoint that has the focus. */
export function takeKeys(drawing: Drawing, canvas: Canvas, told: Told): void {
  const noRoom = `There is no room for another breakpoint: a law takes up to ${maxKnots}, apart from each other.`;

  let stays = 0; // nudges of one stay at a breakpoint are one step back

  const step = (event: KeyboardEvent): { x: number; y: number } | null => {
    const arrow = arrows[event.key];
    if (!arrow) return null;
    const pixels = event.shiftKey ? 10 : event.altKey ? 0.1 : 1;
    return { x: arrow.x * pixels * canvas.pixel.x, y: arrow.y * pixels * canvas.pixel.y };
  };

  const moveCursor = (event: KeyboardEvent): boolean => {
    const by = step(event);
    const { x } = canvas.plot.limits;
    if (by) canvas.cursor = canvas.within({ x: canvas.cursor.x + by.x, y: canvas.cursor.y + by.y });
    else if (event.key === "Home") canvas.cursor = { x: x[0], y: canvas.cursor.y };
    else if (event.key === "End") canvas.cursor = { x: x[1], y: canvas.cursor.y };
    else if (event.key === " ") canvas.cursorOnLaw();
    else return false;
    canvas.draw();
    const spot = canvas.cursorSpot();
    told.announce(`Cursor ${inUnits(spot.penetration, drawing.position)}, ${inUnits(spot.force, drawing.force)}`);
    return true;
  };

  const addAtCursor = (): void => {
    const index = drawing.add(canvas.cursorSpot());
    if (index < 0) return told.refuse(noRoom);
    told.settled();
    told.announce(`Added: ${nameOf(drawing, index, drawing.branch)}`);
  };

  /** Half way to the next one, on the line. */
  const addBeside = (index: number, branch: Branch): void => {
    const at = drawing.knots.penetration;
    const from = Math.min(index, at.length - 2);
    const penetration = 0.5 * (at[from]! + at[from + 1]!);
    const added = drawing.add({ penetration, force: forceAt(drawing.knots, branch, penetration), branch });
    if (added < 0) return told.refuse(noRoom);
    canvas.handles.focus(added, branch);
    told.settled();
  };

  const onKnot = (event: KeyboardEvent, index: number, branch: Branch): boolean => {
    const by = step(event);
    if (by) {
      const { knots, position, force } = drawing;
      const to = canvas.within({
        x: knots.penetration[index]! * position.perUnit + by.x,
        y: knots[branch][index]! * force.perUnit + by.y,
      });
      const spot = {
        penetration: by.x === 0 ? knots.penetration[index]! : to.x / position.perUnit,
        force: by.y === 0 ? knots[branch][index]! : to.y / force.perUnit,
        branch,
      };
      drawing.move(index, spot, `nudge ${stays}`);
      told.settled();
    } else if (event.key === "Delete" || event.key === "Backspace") {
      if (!drawing.remove(index)) told.refuse(`A law keeps ${fewestKnots} breakpoints.`);
      canvas.handles.focus(drawing.selected, branch);
      told.settled();
    } else if (event.key === "a" || event.key === "Insert") {
      addBeside(index, branch);
    } else {
      return false;
    }
    return true;
  };

  canvas.plot.svg.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey) return;
    const handle = Handles.of(event.target);
    let done: boolean;
    if (handle) {
      done = onKnot(event, handle.index, handle.branch);
    } else {
      done = ["Enter", "a", "Insert"].includes(event.key);
      if (done) addAtCursor();
      else done = moveCursor(event);
    }
    if (done) event.preventDefault();
  });
  canvas.plot.svg.addEventListener("focusin", (event) => {
    const handle = Handles.of(event.target);
    ++stays;
    if (handle) drawing.choose(handle.index, handle.branch);
  });
}
