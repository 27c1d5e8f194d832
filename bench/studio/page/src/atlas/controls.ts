import type { Sweep, SweepFilter } from "../api/sweeps";
import { button, element, labelled, select } from "../ui/dom";
import { filtered, results, statistics, variedInputs, withUnitOf, type Choice } from "./question";

/** What is looked at, to be chosen; `changed` is told of every choice. */
export function controls(sweep: Sweep, choice: Choice, changed: (choice: Choice) => void): HTMLElement {
  const { table } = choice;
  const columns = table.columns
    .filter((it) => !it.input || it.texts.length !== 1)
    .map((it) => ({ value: it.name, text: withUnitOf(it.name, it.unit) }));
  const inputs = variedInputs(table).map((it) => ({ value: it.name, text: withUnitOf(it.name, it.unit) }));
  const none = { value: "", text: "–" };
  const by = (place: number): HTMLElement =>
    select(
      [none, ...inputs.filter((it) => it.value !== choice.x && it.value !== choice.y)],
      choice.by[place] ?? "",
      (name) => {
        const next = [...choice.by];
        next[place] = name;
        changed({ ...choice, by: next.filter((it, i) => it && next.indexOf(it) === i) });
      },
    );
  const of = results(table).map((it) => ({ value: it.name, text: withUnitOf(it.name, it.unit) }));
  const share = element("input", {
    type: "text",
    value: choice.share,
    placeholder: "damping_lower <= 12 & damping_upper >= 12",
    spellcheck: "false",
    change: () => changed({ ...choice, share: share.value.trim() }),
  });
  return element(
    "form",
    { class: "row atlas_controls", "aria-label": "What is drawn", submit: (event: Event) => event.preventDefault() },
    sweep.tables.length > 1
      ? labelled(
          "Table",
          select(
            sweep.tables.map((it) => ({ value: it.name, text: it.name })),
            table.name,
            (name) => changed({ ...choice, table: sweep.tables.find((it) => it.name === name) ?? table }),
          ),
        )
      : null,
    labelled(
      "Across",
      select(columns, choice.x, (x) => changed({ ...choice, x })),
    ),
    labelled(
      "Up",
      select(columns, choice.y, (y) => changed({ ...choice, y })),
    ),
    labelled("Beside each other", by(0)),
    choice.by.length > 0 ? labelled("Below each other", by(1)) : null,
    labelled(
      "Colour",
      select(of, choice.of, (name) => changed({ ...choice, of: name, share: "" })),
    ),
    labelled(
      "Of the cells behind a tile",
      select(
        statistics.map((it) => ({ value: it, text: it })),
        choice.statistic,
        (statistic) => changed({ ...choice, statistic, share: "" }),
      ),
    ),
    labelled("or the share of cells with", share),
  );
}

/** The filters that are on, each to be changed by hand or taken off; and a way to add one. */
export function filterPanel(choice: Choice, changed: (choice: Choice) => void): HTMLElement {
  const set = (column: string, filter: SweepFilter | null): void => {
    changed(filtered(choice, column, filter));
  };
  const lines = Object.entries(choice.where).map(([name, filter]) => line(choice, name, filter, set));
  const free = choice.table.columns.filter((it) => !(it.name in choice.where) && (!it.input || it.texts.length !== 1));
  const add = select(
    [{ value: "", text: "Filter by …" }, ...free.map((it) => ({ value: it.name, text: it.name }))],
    "",
    (name) => {
      const column = free.find((it) => it.name === name);
      if (column) set(name, column.texts.length > 0 ? [...column.texts] : [null, null]);
    },
  );
  add.setAttribute("aria-label", "Filter by a column");
  return element(
    "section",
    { class: "filters", "aria-label": "Filters" },
    element("h2", {}, "Filters"),
    ...lines,
    element(
      "div",
      { class: "row" },
      add,
      lines.length > 0 ? button("No filter", () => changed({ ...choice, where: {} })) : null,
    ),
  );
}

function line(
  choice: Choice,
  name: string,
  filter: SweepFilter,
  set: (column: string, filter: SweepFilter | null) => void,
): HTMLElement {
  const column = choice.table.columns.find((it) => it.name === name);
  const off = button("×", () => set(name, null), { "aria-label": `No filter by ${name}` });
  if (column && column.texts.length > 0) {
    const chosen = new Set(filter.filter((it): it is string => typeof it === "string"));
    const boxes = column.texts.map((text) => {
      const box = element("input", {
        type: "checkbox",
        checked: chosen.has(text),
        change: () => {
          if (box.checked) chosen.add(text);
          else chosen.delete(text);
          if (chosen.size > 0)
            set(
              name,
              column.texts.filter((it) => chosen.has(it)),
            );
        },
      });
      return element("label", { class: "value" }, box, text || "–");
    });
    const count = `${chosen.size} of ${column.texts.length}`;
    return element(
      "div",
      { class: "filter" },
      element("details", {}, element("summary", {}, `${withUnitOf(name, column.unit)}: ${count}`), ...boxes),
      off,
    );
  }
  const bounds = [filter[0] ?? null, filter[1] ?? null].map((it) => (typeof it === "number" ? it : null));
  const field = (place: 0 | 1): HTMLInputElement => {
    const input = element("input", {
      type: "number",
      step: "any",
      value: bounds[place] === null ? "" : String(Number((bounds[place] ?? 0).toPrecision(4))),
      change: () => {
        bounds[place] = input.value === "" ? null : input.valueAsNumber;
        set(name, [bounds[0] ?? null, bounds[1] ?? null]);
      },
    });
    return input;
  };
  const unit = column?.unit ?? "1";
  return element(
    "div",
    { class: "filter" },
    labelled(`${withUnitOf(name, unit)}, from`, field(0)),
    labelled("to", field(1)),
    off,
  );
}
