import "./editor.css";

import type { EditorCurve, Knots } from "../api/editor";
import type { Recording } from "../api/recordings";
import type { Workspace } from "../api/workspace";
import { Canvas } from "../editor/canvas";
import { chooser } from "../editor/panels/chooser";
import { Drawing } from "../editor/drawing";
import { FeelPanel } from "../editor/panels/feel_panel";
import { Figures } from "../editor/panels/figures";
import { History } from "../editor/history";
import { keepDrawing, keptDrawing } from "../editor/kept_drawing";
import { isUndo, takeKeys } from "../editor/keys";
import { KnotTable } from "../editor/panels/knot_table";
import { startKnots } from "../editor/knots";
import { takePointer } from "../editor/pointer";
import { savePanel } from "../editor/panels/save_panel";
import { startFrom } from "../editor/panels/start_from";
import { optima, toolbar } from "../editor/panels/tools";
import { stateKeys } from "../recording/keys";
import { element, labelled, select } from "../ui/dom";
import { Latest } from "../ui/latest";
import type { Context, OpenRecording, View } from "../ui/view";

// What was drawn stays, whatever is looked at in between: its steps while the page does, where it ended for longer.
const drafts = new Map<string, History<Knots>>();

const keys =
  "Click on the plot to add a breakpoint, drag one to move it. Keys on the plot: arrows move the cursor, Home and End to " +
  "the ends, Space onto the law, Enter or A adds. On a breakpoint: arrows move it, Shift ten times as far, Alt a tenth, " +
  "A adds one beside it, Delete removes it. Ctrl+Z takes back, Ctrl+Shift+Z does it again.";

const nameOf = (curve: EditorCurve): string => `${curve.recording}/${curve.axis}`;

function draftOf(curve: EditorCurve): History<Knots> {
  const name = nameOf(curve);
  const draft = drafts.get(name) ?? begunDraft(curve);
  drafts.set(name, draft);
  return draft;
}

/** As it was left in this browser, one step after the line that any drawing begins with. */
function begunDraft(curve: EditorCurve): History<Knots> {
  const draft = new History(startKnots(curve));
  const kept = keptDrawing(nameOf(curve));
  if (kept) draft.record(kept);
  return draft;
}

function stemOf(name: string): string {
  const stem = (name.split("/").pop() ?? "")
    .replace(/\.h5$/, "")
    .replace(/[^A-Za-z0-9_.-]/g, "_")
    .slice(0, 70);
  return /^[A-Za-z0-9]/.test(stem) ? `${stem}_drawn` : "drawn";
}

interface Opened {
  recording: Recording;
  workspace: Workspace;
  axis: number;
  curve: EditorCurve;
}

/** The editor of one axis; gives back what ends it. */
function edit(
  root: HTMLElement,
  context: Context,
  { recording, workspace, axis, curve }: Opened,
  change: (axis: number) => void,
): () => void {
  const name = workspace.recordings.find((it) => it.id === curve.recording)?.name ?? "recording";
  const drawing = new Drawing(curve, draftOf(curve));
  const canvas = new Canvas(drawing);
  const live = element("p", { class: "read_out", role: "status" });
  let pause = 0;
  const announce = (text: string): void => {
    clearTimeout(pause);
    pause = window.setTimeout(() => (live.textContent = text), 300);
  };
  const settled = (): void => canvas.fit();
  const figures = new Figures(drawing, announce);
  const numbers = new KnotTable(drawing, settled, context.complain);
  const feel = new FeelPanel(context, drawing, axis);
  const tools = toolbar(context, drawing, canvas, axis, settled);
  takePointer(drawing, canvas, settled, context.complain);
  takeKeys(drawing, canvas, { settled, announce, refuse: context.complain });
  let drawn = drawing.knots;
  drawing.onChange(() => {
    if (drawn !== drawing.knots) keepDrawing(nameOf(curve), (drawn = drawing.knots));
    figures.show();
    canvas.showWorst(figures.error);
    numbers.show();
    tools.show();
    feel.changed();
  });
  const steps = (event: KeyboardEvent): void => {
    const step = isUndo(event);
    if (!step) return;
    event.preventDefault();
    drawing[step]();
    settled();
  };
  addEventListener("keydown", steps);

  const axes = recording.axes.map((it, i) => ({ value: String(i), text: it.name }));
  const choice = select(axes, String(axis), (value) => {
    choice.value = String(axis); // until there is a curve of the other one
    change(Number(value));
  });
  const found = curve.segmented_here ? ", found here: the recording is not segmented" : "";
  const cycles = `${curve.cycles} ${curve.cycles === 1 ? "cycle" : "cycles"}${found}`;
  tools.root.append(
    recording.axes.length > 1 ? element("div", { class: "axis_choice" }, labelled("Axis", choice)) : "",
    element("p", { class: "quiet" }, cycles),
  );
  canvas.plot.svg.setAttribute("aria-describedby", "editor_keys");
  root.append(
    tools.root,
    element(
      "div",
      { class: "sheet" },
      element(
        "div",
        { class: "plot card" },
        canvas.plot.svg,
        element("div", { class: "plot_bar" }, legend(), canvas.plot.menu()),
      ),
      element(
        "div",
        { class: "side card" },
        figures.table,
        optima(context, drawing, axis, settled),
        startFrom(context, drawing, settled),
        feel.root,
        savePanel(context, drawing, axis, stemOf(name)),
      ),
    ),
    element("p", { class: "quiet keys", id: "editor_keys" }, keys),
    numbers.root,
    live,
  );
  drawing.changed();
  return () => {
    removeEventListener("keydown", steps);
    clearTimeout(pause);
    figures.end();
    feel.end();
    canvas.end();
  };
}

function legend(): HTMLElement {
  const entries: [string, string][] = [
    ["closing", "averaged closing"],
    ["opening", "averaged opening"],
    ["law", "law, closing"],
    ["law thin", "law, opening"],
  ];
  return element(
    "ul",
    { class: "legend" },
    ...entries.map(([look, text]) => element("li", {}, element("span", { class: `swatch ${look}` }), text)),
  );
}

/** The editor of a recording, in a tab of its page; gives back what ends it. */
export function editorOf(root: HTMLElement, context: Context, recording: OpenRecording): () => void {
  const latest = new Latest(context.signal);
  let end = (): void => {};
  const load = async (asked: number | null, byHand = false): Promise<void> => {
    const axis = asked ?? recording.about.cycles?.axis ?? 0;
    try {
      const curve = await latest.ask((signal) =>
        context.api.get<EditorCurve>("/api/editor/curve", { id: recording.id, axis }, signal),
      );
      if (!curve) return;
      end();
      root.replaceChildren();
      const { about, workspace } = recording;
      end = edit(root, context, { recording: about, workspace, axis, curve }, (other) => {
        context.state.set({ [stateKeys.axis]: other }, "push");
        void load(other, true);
      });
      if (byHand) root.querySelector<HTMLSelectElement>(".axis_choice select")?.focus();
    } catch (error) {
      root.replaceChildren(element("p", { class: "empty" }, error instanceof Error ? error.message : String(error)));
    }
  };
  root.append(element("p", { class: "empty", role: "status" }, "The averaged cycle is being made …"));
  void load(context.state.number(stateKeys.axis));
  return () => end();
}

/** Which recording is drawn over; a recording's own page has the editor. */
export const editor: View = {
  name: "editor",
  title: "Segment editor",
  mount(root, context) {
    chooser(root, context).then(() => context.signal.aborted || context.focusHead(), context.complain);
    return () => {};
  },
};
