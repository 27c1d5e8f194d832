import type { Recording, RecordingInspection } from "../api/recordings";
import type { Workspace } from "../api/workspace";
import { button, element } from "../ui/dom";
import { withUnit } from "../ui/numbers";
import type { Context } from "../ui/view";
import { cyclesOf, FlaggedCycles } from "./cycle_flags";
import { InspectionPanel } from "./inspection_panel";
import { date, length } from "./recording_list";
import { RecordingLoops } from "./recording_loops";
import { RecordingOverlay } from "./recording_overlay";
import { RecordingTime } from "./recording_time";
import { firstTraces, traceChoice } from "./recording_traces";

type Tab = "time" | "loops" | "worth";

/** One recording: over time, and as force against position. Gives back what ends it. */
export function recordingPage(
  context: Context,
  root: HTMLElement,
  recording: Recording,
  workspace: Workspace,
): () => void {
  const { api, complain } = context;
  const name = workspace.recordings.find((it) => it.id === recording.id)?.name ?? recording.id;
  const chosen = firstTraces(recording);
  const time = new RecordingTime(api, complain);
  const loops = new RecordingLoops(api, complain);
  let tab: Tab = "time";
  const show = (): void => {
    if (tab === "time") time.show(overlay.drawn, chosen);
    else if (tab === "loops") loops.show(overlay.drawn);
  };
  const overlay = new RecordingOverlay(api, recording, name, workspace, show, complain);
  const choice = traceChoice(recording.traces, chosen, show);
  const lookAt = (from_s: number, to_s: number): void => {
    open("time");
    time.showAt(from_s - 1, to_s + 1);
  };
  const events = eventList(recording, (at) => lookAt(at, at));
  const flags = new FlaggedCycles(lookAt);
  const worth = new InspectionPanel(lookAt);

  const side = element(
    "aside",
    { class: "recording_side", "aria-label": "What is drawn" },
    choice,
    overlay.root,
    flags.root,
    events,
  );

  const tabs: readonly (readonly [Tab, HTMLButtonElement, HTMLElement])[] = [
    ["time", tabButton("Over time", "time"), time.root],
    ["loops", tabButton("Force against position", "loops"), loops.root],
    ["worth", tabButton("Inspect", "worth"), worth.root],
  ];
  function tabButton(text: string, it: Tab): HTMLButtonElement {
    return button(text, () => open(it), { role: "tab", id: `tab_${it}`, "aria-controls": `panel_${it}` });
  }
  function open(wanted: Tab): void {
    tab = wanted;
    for (const [it, press, panel] of tabs) {
      press.setAttribute("aria-selected", String(it === tab));
      press.tabIndex = it === tab ? 0 : -1;
      panel.hidden = it !== tab;
    }
    choice.hidden = tab !== "time";
    side.hidden = tab === "worth";
    show();
  }
  const list = element(
    "div",
    { class: "tabs", role: "tablist", "aria-label": "Ways to see it" },
    ...tabs.map(([, it]) => it),
  );
  list.addEventListener("keydown", (event) => {
    if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
    const at = tabs.findIndex(([it]) => it === tab) + (event.key === "ArrowLeft" ? tabs.length - 1 : 1);
    open(tabs[at % tabs.length]![0]);
    tabs.find(([it]) => it === tab)?.[1].focus();
  });
  for (const [it, , panel] of tabs) {
    panel.id = `panel_${it}`;
    panel.setAttribute("role", "tabpanel");
    panel.setAttribute("aria-labelledby", `tab_${it}`);
  }

  root.append(
    element(
      "div",
      { class: "recording_head" },
      element("h1", {}, name),
      element("nav", { class: "row", "aria-label": "With this recording" }, ...links(recording.id)),
    ),
    facts(recording),
    element(
      "div",
      { class: "recording_body" },
      element("div", { class: "recording_main" }, list, time.root, loops.root, worth.root),
      side,
    ),
  );
  open("time");
  flags.show(cyclesOf(recording, null));
  const gone = new AbortController();
  inspect(context, recording, gone.signal).then(
    (found) => {
      time.inspected(found);
      flags.show(cyclesOf(recording, found));
      worth.show(found);
    },
    (error: unknown) => {
      if (!gone.signal.aborted) worth.fail(error);
    },
  );
  return () => {
    gone.abort();
    time.end();
    loops.end();
  };
}

/** After what is seen first: it takes a second where there are a million rows. */
async function inspect(context: Context, recording: Recording, gone: AbortSignal): Promise<RecordingInspection> {
  await new Promise((go) => setTimeout(go, 200));
  return context.api.get<RecordingInspection>("/api/recording/inspection", { id: recording.id }, gone);
}

function links(id: string): HTMLElement[] {
  const link = (view: string, text: string): HTMLElement =>
    element("a", { class: "go", href: `#/${view}/${id}` }, text);
  return [
    element("a", { class: "go", href: "#/recordings" }, "All recordings"),
    link("editor", "Draw a law"),
    link("fits", "Fit"),
    link("chart", "Chart"),
  ];
}

function facts(recording: Recording): HTMLElement {
  const fact = (name: string, text: string): HTMLElement | null =>
    text ? element("div", {}, element("dt", {}, name), element("dd", { title: text }, text)) : null;
  const gaps = recording.gaps_in_all;
  return element(
    "dl",
    { class: "facts" },
    fact("Device", recording.device),
    fact("Length", length(recording.seconds)),
    fact("Rows", `${recording.rows.toLocaleString("en-GB")} every ${withUnit(recording.period_s, "s")}`),
    fact("Status", recording.status),
    fact("Recorded", date(recording.created)),
    fact("Gaps", gaps > 0 ? gaps.toLocaleString("en-GB") : "none"),
    fact("By", recording.software),
    fact("From", recording.source),
    fact("History", recording.history),
  );
}

function eventList(recording: Recording, go: (time_s: number) => void): HTMLElement {
  const shown = recording.events.slice(0, 200);
  const more = recording.events_in_all - shown.length;
  return element(
    "section",
    { class: "recording_events" },
    element("h2", {}, `Events (${recording.events_in_all.toLocaleString("en-GB")})`),
    element(
      "ol",
      { class: "event_list" },
      ...shown.map((it) =>
        element(
          "li",
          {},
          button(`${it.time_s.toFixed(3)} s ${it.kind}${it.text ? `: ${it.text}` : ""}`, () => go(it.time_s), {
            class: "plain",
          }),
        ),
      ),
      more > 0 ? element("li", {}, `and ${more.toLocaleString("en-GB")} more`) : null,
    ),
  );
}
