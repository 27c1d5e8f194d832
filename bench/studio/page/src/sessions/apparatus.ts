import type { ApparatusItem } from "../api/workspace";
import { element } from "../ui/dom";

/** What was said of the set-up: an item that nobody touched is not in it, so that it stays unknown. */
export function apparatusFields(items: readonly ApparatusItem[]): {
  root: HTMLElement | null;
  given: () => Record<string, boolean>;
} {
  const said = new Map<string, boolean>();
  if (items.length === 0) return { root: null, given: () => ({}) };
  const box = (item: ApparatusItem): HTMLElement => {
    const state = element("output", { class: "quiet" }, "not said");
    const tick = element("input", {
      type: "checkbox",
      change: () => {
        said.set(item.name, tick.checked);
        state.textContent = tick.checked ? "yes" : "no";
      },
    });
    tick.indeterminate = true;
    return element("label", { class: "tick" }, tick, element("span", {}, `${item.name}: ${item.what}`), state);
  };
  return {
    root: element(
      "fieldset",
      { class: "apparatus" },
      element("legend", {}, "The set-up: one press for yes, two for no"),
      ...items.map(box),
    ),
    given: () => Object.fromEntries(said),
  };
}
