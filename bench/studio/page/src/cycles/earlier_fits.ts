import type { FitOfCycles } from "../api/cycles";
import { resultName } from "../results/names";
import { resultsOf } from "../results/of_recording/files";
import { element } from "../ui/dom";
import { Latest } from "../ui/latest";
import type { Context, OpenRecording } from "../ui/view";

/** The fits of this recording that are of cycles which it has no more. */
export class EarlierFits {
  readonly root = element("ul", {
    class: "warnings earlier_fits",
    "aria-label": "Fits of earlier cycles",
    hidden: true,
  });
  private readonly latest: Latest;
  private now = "";

  constructor(
    private readonly context: Context,
    private readonly recording: OpenRecording,
  ) {
    this.latest = new Latest(context.signal);
  }

  /** Looks again where what it depends on (the cycles, the fit that is shown) is another. */
  show(now: string): void {
    if (now === this.now) return;
    this.now = now;
    void this.look();
  }

  private async look(): Promise<void> {
    const { recording } = this;
    const { api, folder } = this.context;
    const found = await this.latest
      .ask(async (signal) => {
        const workspace = await folder();
        const fits = resultsOf(workspace, recording, ["fit"]);
        return Promise.all(
          fits.map(async (fit) => {
            const ask = { id: recording.id, fit: fit.id };
            return { fit, of: await api.get<FitOfCycles>("/api/cycles/fit", ask, signal).catch(() => null) };
          }),
        );
      })
      .catch(() => undefined);
    const earlier = (found ?? []).filter((it) => it.of?.earlier);
    this.root.hidden = earlier.length === 0;
    this.root.replaceChildren(
      ...earlier.map(({ fit, of }) =>
        element(
          "li",
          {},
          element("span", { "aria-hidden": "true" }, "⚠"),
          element("span", {}, `${resultName(fit)}: ${of!.why}`),
        ),
      ),
    );
  }
}
