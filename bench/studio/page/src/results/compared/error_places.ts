import type { Residuals } from "../../api/results";
import { stateKeys } from "../../recording/keys";
import { writeAddress } from "../../shell/address";
import { element } from "../../ui/dom";
import { plain } from "../../ui/numbers";

const phases: Record<string, string> = {
  closing: "closing",
  opening: "opening",
  open_to_close: "open, before it closes",
  close_to_open: "closed, before it opens",
};

/** The rows that say so: where the error lies, each a link to them in the tab of time. */
export function errorPlaces(recording: string, of: Residuals): HTMLElement | null {
  if (of.places.length === 0) return null;
  const links = of.places.map((it, k) => {
    const room = 0.15 * (it.to_s - it.from_s) + 0.01;
    const address = writeAddress({
      view: "recording",
      id: recording,
      tab: "time",
      state: { [stateKeys.from]: String(it.from_s - room), [stateKeys.to]: String(it.to_s + room) },
    });
    const where =
      it.cycle === undefined
        ? `${plain(it.from_s, 4)} to ${plain(it.to_s, 4)} s`
        : `cycle ${it.cycle}, ${phases[it.phase ?? ""] ?? it.phase}`;
    const much = `${plain(100 * it.share, 2)} % of the squared error, ${plain(it.rmse / of.jnd_n, 2)} JND`;
    return element(
      "li",
      {},
      element("a", { href: address }, where),
      ` (${much})${k + 1 < of.places.length ? "," : "."}`,
    );
  });
  const together = of.places.reduce((sum, it) => sum + it.share, 0);
  const spread = "It is spread over the recording; the largest shares are in";
  return element(
    "ul",
    { class: "places", "aria-label": "Where the error lies" },
    element("li", {}, together < 0.5 ? spread : "It lies in"),
    ...links,
  );
}
