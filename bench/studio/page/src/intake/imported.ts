import type { Recording, RecordingInspection } from "../api/recordings";
import { RecordingTime } from "../recordings/recording_time";
import { firstTraces } from "../recordings/recording_traces";
import { element } from "../ui/dom";
import { Latest } from "../ui/latest";
import { plain } from "../ui/numbers";
import type { Context } from "../ui/view";
import type { TakenFile } from "./taken_file";

const shownLines = 200;

/** What has become of a file: in words, its warnings and left out lines, and the data with what `inspect` flags. */
export class Imported {
  readonly root = element("section", { class: "imported", "aria-label": "What was imported", hidden: true });
  private readonly words = element("div", { class: "imported_words" });
  private readonly frame = element("div", { class: "imported_plot" });
  private readonly latest: Latest;
  private time: RecordingTime | null = null;
  private shown = "";

  constructor(private readonly context: Context) {
    this.latest = new Latest(context.signal);
    this.root.append(this.words, this.frame);
    context.signal.addEventListener("abort", () => this.time?.end());
  }

  show(file: TakenFile | null): void {
    const result = file?.result ?? null;
    this.root.hidden = !result;
    if (!result || result.recording === this.shown) return;
    this.shown = result.recording;
    const { about } = result;
    const { bad_line_numbers: bad, misplaced_line_numbers: misplaced } = about;
    this.words.replaceChildren(
      element(
        "h2",
        {},
        `${result.name}: ${about.samples.toLocaleString("en-GB")} samples over ${plain(about.duration_s, 5)} s`,
      ),
      element("a", { class: "go firm", href: `#/recording/${result.recording}/time` }, "Open it"),
      ...(about.warnings.length > 0
        ? [
            element(
              "ul",
              { class: "warnings" },
              ...about.warnings.map((it) =>
                element("li", {}, element("span", { "aria-hidden": "true" }, "⚠"), element("span", {}, it)),
              ),
            ),
          ]
        : [element("p", { class: "quiet" }, "Nothing was left out, and nothing is doubted.")]),
      ...lines("No data", bad),
      ...lines("Whose time repeats or goes back", misplaced),
    );
    void this.draw(result.recording, result.name);
  }

  private async draw(id: string, name: string): Promise<void> {
    const { api, complain } = this.context;
    this.time?.end();
    this.time = null;
    this.frame.replaceChildren();
    try {
      const about = await this.latest.ask((signal) => api.get<Recording>("/api/recording", { id }, signal));
      if (!about) return;
      const time = (this.time = new RecordingTime(api, complain, element("div", {})));
      this.frame.replaceChildren(time.root);
      time.show([{ recording: about, name, shift_s: 0 }], firstTraces(about));
      const found = await this.latest.ask((signal) =>
        api.get<RecordingInspection>("/api/recording/inspection", { id }, signal),
      );
      if (found) time.inspected(found);
    } catch (error) {
      complain(error);
    }
  }
}

function lines(what: string, numbers: readonly number[]): HTMLElement[] {
  if (numbers.length === 0) return [];
  const more = numbers.length > shownLines ? ` and ${numbers.length - shownLines} more` : "";
  return [
    element(
      "details",
      {},
      element("summary", {}, `${what}: ${numbers.length.toLocaleString("en-GB")} lines left out`),
      element("p", { class: "quiet" }, `Lines ${numbers.slice(0, shownLines).join(", ")}${more}`),
    ),
  ];
}
