import { cyclesOf, FlaggedCycles } from "../../recordings/cycle_flags";
import { RecordingTime } from "../../recordings/recording_time";
import { firstTraces, traceChoice } from "../../recordings/recording_traces";
import { element } from "../../ui/dom";
import type { RecordingTab } from "../../ui/view";
import { eventList } from "../event_list";
import { stateKeys } from "../keys";
import { Overlay } from "../overlay";

/** Any stretch of the recording, with cycles, flags, gaps and events; others laid over it. */
export const timeTab: RecordingTab = {
  name: "time",
  title: "Time",
  mount(root, context, recording) {
    const { state } = context;
    const { about } = recording;
    const chosen = new Set(state.get(stateKeys.traces)?.split(",") ?? firstTraces(about));
    const time = new RecordingTime(context.api, context.complain, (from, to, whole) =>
      state.set({ [stateKeys.from]: whole ? null : from, [stateKeys.to]: whole ? null : to }),
    );
    const overlay = new Overlay(context, recording, () => time.show(overlay.drawn, chosen));
    const choice = traceChoice(about.traces, chosen, () => {
      const usual = [...firstTraces(about)];
      const isUsual = usual.length === chosen.size && usual.every((it) => chosen.has(it));
      state.set({ [stateKeys.traces]: isUsual ? null : [...chosen].join(",") }, "push");
      time.show(overlay.drawn, chosen);
    });
    const look = (): void => {
      const [from, to] = [state.number(stateKeys.from), state.number(stateKeys.to)];
      if (from !== null && to !== null && to > from) time.showAt(from, to);
      else time.showAll();
    };
    const lookAt = (from_s: number, to_s: number): void => time.showAt(from_s - 1, to_s + 1);
    const flags = new FlaggedCycles(lookAt);
    root.append(
      element(
        "div",
        { class: "recording_body" },
        element("div", { class: "recording_main" }, time.root),
        element(
          "aside",
          { class: "recording_side", "aria-label": "What is drawn" },
          choice,
          overlay.root,
          flags.root,
          eventList(about, (at) => lookAt(at, at)),
        ),
      ),
    );
    time.show(overlay.drawn, chosen);
    look();
    flags.show(cyclesOf(about, null));
    void overlay.follow();
    context.state.onChange(() => {
      look();
      void overlay.follow();
    });
    recording.inspection().then(
      (found) => {
        if (context.signal.aborted) return;
        time.inspected(found);
        flags.show(cyclesOf(about, found));
      },
      () => {}, // the tab of cycles says why
    );
    return () => time.end();
  },
};
