import { cyclesOf, FlaggedCycles, flaggedInWords } from "../../recordings/cycle_flags";
import { RecordingTime } from "../../recordings/recording_time";
import { firstTraces, traceChoice } from "../../recordings/recording_traces";
import { element } from "../../ui/dom";
import { Popover } from "../../ui/popover";
import type { RecordingTab } from "../../ui/view";
import { eventList } from "../event_list";
import { stateKeys } from "../keys";
import { Overlay } from "../overlay";

/** Any stretch of the recording, with cycles, flags, gaps and events; others laid over it. */
export const timeTab: RecordingTab = {
  name: "time",
  title: "Time",
  mount(root, context, recording) {
    const { state, signal } = context;
    const { about } = recording;
    const usual = [...firstTraces(about)];
    const chosen = new Set(usual);
    const tools = element("div", { class: "tab_tools" });
    let isByHand = false; // what the address asks for is not written into it again
    const moved = (from: number, to: number, whole: boolean): void => {
      if (isByHand) state.set({ [stateKeys.from]: whole ? null : from, [stateKeys.to]: whole ? null : to });
    };
    const time = new RecordingTime(context.api, context.complain, tools, moved, () => recording.reload());
    const overlay = new Overlay(context, recording, () => draw());
    /** Draws what is chosen, over the stretch of the address. */
    const draw = (): void => {
      const [from, to] = [state.number(stateKeys.from), state.number(stateKeys.to)];
      isByHand = false;
      time.show(overlay.drawn, chosen);
      if (from !== null && to !== null && to > from) time.showAt(from, to);
      else time.showAll();
      isByHand = true;
    };
    const traces = element("div", {});
    const take = (): void => {
      const named = state.get(stateKeys.traces)?.split(",") ?? usual;
      chosen.clear();
      for (const it of about.traces) if (named.includes(it.name)) chosen.add(it.name);
      traces.replaceChildren(
        traceChoice(about.traces, chosen, () => {
          const isUsual = usual.length === chosen.size && usual.every((it) => chosen.has(it));
          state.set({ [stateKeys.traces]: isUsual ? null : [...chosen].join(",") }, "push");
          draw();
        }),
      );
    };
    const lookAt = (from_s: number, to_s: number): void => time.showAt(from_s - 1, to_s + 1);
    const flags = new FlaggedCycles(lookAt);
    const cycles = new Popover("Cycles", element("div", {}, flags.root, time.legend), signal);
    const showCycles = (of: ReturnType<typeof cyclesOf>): void => {
      flags.show(of);
      cycles.text = flaggedInWords(of);
    };
    const events = element(
      "div",
      {},
      eventList(about, (at) => lookAt(at, at)),
    );
    tools.append(
      new Popover("Traces", traces, signal).root,
      overlay.popover.root,
      cycles.root,
      new Popover(`Events ${about.events_in_all.toLocaleString("en-GB")}`, events, signal).root,
    );
    root.append(time.root);
    take();
    draw();
    showCycles(cyclesOf(about, null));
    void overlay.follow();
    state.onChange(() => {
      take();
      draw();
      void overlay.follow();
    });
    recording.inspection().then(
      (found) => {
        if (signal.aborted) return;
        time.inspected(found);
        showCycles(cyclesOf(about, found));
      },
      () => {}, // the tab of cycles says why
    );
    return () => time.end();
  },
};
