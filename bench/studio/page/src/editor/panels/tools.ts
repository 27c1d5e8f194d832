import type { Knots, LawError } from "../../api/editor";
import type { Loops } from "../../api/recordings";
import { button, element, labelled, select } from "../../ui/dom";
import type { Context } from "../../ui/view";
import type { Canvas } from "../canvas";
import type { Drawing } from "../drawing";

/** A button that stays in or out. */
function toggle(text: string, pressed: boolean, set: (on: boolean) => void): HTMLButtonElement {
  const node = button(
    text,
    () => {
      const on = node.getAttribute("aria-pressed") !== "true";
      node.setAttribute("aria-pressed", String(on));
      set(on);
    },
    { "aria-pressed": String(pressed) },
  );
  return node;
}

/** What stands above the plot: steps back and forth, branches, and what is shown. */
export function toolbar(
  context: Context,
  drawing: Drawing,
  canvas: Canvas,
  axis: number,
  settled: () => void,
): { root: HTMLElement; show: () => void } {
  const back =
    (step: () => void): (() => void) =>
    () => {
      step();
      settled();
    };
  const undo = button(
    "Undo",
    back(() => drawing.undo()),
    { title: "Ctrl+Z", "aria-keyshortcuts": "Control+Z" },
  );
  const redo = button(
    "Redo",
    back(() => drawing.redo()),
    { title: "Ctrl+Shift+Z", "aria-keyshortcuts": "Control+Shift+Z Control+Y" },
  );
  const remove = button(
    "Remove",
    back(() => void drawing.remove(drawing.selected)),
    { title: "Delete", "aria-label": "Remove the chosen breakpoint" },
  );
  const own = toggle("Opening as its own branch", drawing.hasOpening, (on) => {
    drawing.ownOpening(on);
    settled();
  });
  const branch = select(
    [
      { value: "closing", text: "closing" },
      { value: "opening", text: "opening" },
    ],
    drawing.branch,
    (value) => {
      drawing.selected = -1;
      drawing.branch = value === "opening" ? "opening" : "closing";
      drawing.changed();
    },
  );
  const band = toggle("JND band", drawing.band, (on) => {
    drawing.band = on;
    drawing.changed();
  });
  const cycles = toggle(
    "Single cycles",
    false,
    (on) => void showCycles(context, drawing, canvas, axis, on).catch(context.complain),
  );
  const show = (): void => {
    undo.disabled = !drawing.history.canUndo;
    redo.disabled = !drawing.history.canRedo;
    remove.disabled = drawing.selected < 0 || drawing.knots.penetration.length <= 2;
    own.setAttribute("aria-pressed", String(drawing.hasOpening));
    branch.value = drawing.branch;
    branch.disabled = !drawing.hasOpening;
  };
  return {
    root: element(
      "div",
      { class: "tools", role: "toolbar", "aria-label": "Drawing" },
      undo,
      redo,
      remove,
      labelled("Draw on", branch),
      own,
      band,
      cycles,
    ),
    show,
  };
}

async function showCycles(
  context: Context,
  drawing: Drawing,
  canvas: Canvas,
  axis: number,
  on: boolean,
): Promise<void> {
  if (!on) return canvas.showCycles(null);
  const loops = await context.api.get<Loops>("/api/recording/loops", {
    id: drawing.curve.recording,
    axis,
    first: 1,
    count: 30,
  });
  canvas.showCycles(loops);
}

/** What the server works out: the best breakpoints for a number of segments, the best forces at those drawn. */
export function optima(context: Context, drawing: Drawing, axis: number, settled: () => void): HTMLElement {
  const counts = Array.from({ length: 12 }, (_, i) => ({ value: String(i + 1), text: String(i + 1) }));
  const count = select(counts, "5", () => {});
  const take = async (path: string, asked: object): Promise<void> => {
    const before = drawing.knots;
    try {
      const { knots } = await context.api.post<{ knots: Knots; error: LawError }>(path, {
        recording: drawing.curve.recording,
        axis,
        ...asked,
      });
      if (drawing.knots !== before) throw new Error("The drawing has changed meanwhile; ask again.");
      drawing.selected = -1;
      drawing.set(knots);
      settled();
    } catch (error) {
      context.complain(error);
    }
  };
  const best = button(
    "Fill in the best",
    () => void take("/api/editor/best", { segments: Number(count.value), loop: drawing.hasOpening }),
    {
      title: "The breakpoints with the least error for so many segments",
    },
  );
  const forces = button("Best forces here", () => void take("/api/editor/forces", { knots: drawing.knots }), {
    title: "The forces with the least error at the penetrations that are drawn",
  });
  return element("div", { class: "optima" }, labelled("Segments", count), best, forces);
}
