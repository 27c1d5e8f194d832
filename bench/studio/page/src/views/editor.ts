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
import { isUndo, takeKeys } from "../editor/keys";
import { KnotTable } from "../editor/panels/knot_table";
import { startKnots } from "../editor/knots";
import { takePointer } from "../editor/pointer";
import { savePanel } from "../editor/panels/save_panel";
import { startFrom } from "../editor/panels/start_from";
import { optima, toolbar } from "../editor/panels/tools";
import { element, labelled, select } from "../ui/dom";
import type { Context, View } from "../ui/view";

// What was drawn stays while the page does, whatever is looked at in between.
const drafts = new Map<string, History<Knots>>();

const keys =
  "Click on the plot to add a breakpoint, drag one to move it. Keys on the plot: arrows move the cursor, Home and End to " +
  "the ends, Space onto the law, Enter or A adds. On a breakpoint: arrows move it, Shift ten times as far, Alt a tenth, " +
  "A adds one beside it, Delete removes it. Ctrl+Z takes back, Ctrl+Shift+Z does it again.";

function draftOf(curve: EditorCurve): History<Knots> {
  const name = `${curve.recording}/${curve.axis}`;
  const draft = drafts.get(name) ?? new History(startKnots(curve));
  drafts.set(name, draft);
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
  drawing.onChange(() => {
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
  canvas.plot.svg.setAttribute("aria-describedby", "editor_keys");
  root.append(
    element(
      "div",
      { class: "heading" },
      element("h1", {}, name),
      element("p", { class: "quiet" }, cycles),
      labelled("Axis", choice),
      element("a", { href: "#/editor" }, "Other recording"),
    ),
    tools.root,
    element(
      "div",
      { class: "sheet" },
      element("div", { class: "plot card" }, canvas.plot.svg, legend()),
      element(
        "div",
        { class: "side card" },
        figures.table,
        optima(context, drawing, axis, settled),
        startFrom(context, drawing, workspace, settled),
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
    ["law dashed", "law, opening"],
  ];
  return element(
    "ul",
    { class: "legend" },
    ...entries.map(([look, text]) => element("li", {}, element("span", { class: `swatch ${look}` }), text)),
  );
}

async function open(context: Context, id: string, asked: number | null): Promise<Opened> {
  const { api } = context;
  const [recording, workspace] = await Promise.all([
    api.get<Recording>("/api/recording", { id }),
    api.get<Workspace>("/api/workspace"),
  ]);
  const axis = asked ?? recording.cycles?.axis ?? 0;
  return { recording, workspace, axis, curve: await api.get<EditorCurve>("/api/editor/curve", { id, axis }) };
}

export const editor: View = {
  name: "editor",
  title: "Segment editor",
  mount(root, context) {
    let end = (): void => {};
    let asked = 0; // what was asked for last; older answers come too late
    const { id } = context.place;
    const load = async (axis: number | null): Promise<void> => {
      const mine = ++asked;
      try {
        if (id === "") {
          await chooser(root, context);
          return context.focusHead();
        }
        const opened = await open(context, id, axis);
        if (mine !== asked) return;
        end();
        root.replaceChildren();
        end = edit(root, context, opened, (other) => void load(other));
        if (axis === null) context.focusHead();
        else root.querySelector<HTMLSelectElement>(".heading select")?.focus();
      } catch (error) {
        if (mine !== asked) return;
        context.complain(error);
        if (root.childElementCount === 0) {
          root.append(
            element("h1", {}, "Segment editor"),
            element("p", {}, element("a", { href: "#/editor" }, "Choose a recording")),
          );
        }
      }
    };
    void load(null);
    return () => {
      ++asked;
      end();
    };
  },
};
