import type { LawView } from "../api/results";
import { button, element, table } from "../ui/dom";
import { plain, withUnit } from "../ui/numbers";
import type { Context } from "../ui/view";
import { figureOf, lineOf } from "../ui/figure_description";
import { Plot } from "../ui/plot/plot";

const maxShown = 24;

/** Lets the running loop render a law; what came of it stands in the notice. */
export async function feel(context: Context, id: string, name: string): Promise<void> {
  try {
    await context.api.post("/api/live/feel", { law: id });
    context.say(`${name} is rendered now. Escape makes the force zero.`);
  } catch (error) {
    context.complain(error);
  }
}

export function feelButton(context: Context, id: string, name: string): HTMLButtonElement {
  return button("Feel it now", () => void feel(context, id, name), { class: "feel" });
}

function optionsInWords(law: LawView): string {
  const parts = Object.entries(law.options).map(
    ([name, value]) => `${name} ${typeof value === "number" ? plain(value) : String(value)}`,
  );
  return parts.join(", ");
}

function parameterTable(law: LawView): HTMLElement {
  const rows = law.parameters
    .slice(0, maxShown)
    .map((it) => [
      element("div", {}, it.name, element("p", { class: "quiet" }, it.meaning)),
      it.value.toPrecision(5) + (it.std_error === null ? "" : ` ± ${it.std_error.toPrecision(2)}`),
      it.unit === "1" ? "" : it.unit,
    ]);
  const more = law.parameters.length - maxShown;
  const of = table("Parameters", ["name", "value ± standard error", "unit"], rows);
  return element(
    "div",
    { class: "scrolled", tabindex: 0, role: "region", "aria-label": "Parameters of the law" },
    of,
    more > 0 ? element("p", { class: "quiet" }, `and ${more} more, in the file`) : null,
  );
}

/** One law: what it is, its curve, its parameters, and a way to feel it. Takes no room until one is open. */
export class LawPanel {
  readonly root = element("section", { class: "card law", "aria-label": "Law", hidden: true });
  private plot: Plot | null = null;
  private shown = "";

  constructor(private readonly context: Context) {}

  end(): void {
    this.plot?.end();
    this.plot = null;
  }

  /** `title` in the words of the page that opens it. */
  async open(id: string, title: string): Promise<void> {
    this.shown = id;
    try {
      const law = await this.context.api.get<LawView>("/api/law", { id });
      if (this.shown === id) this.show(id, law, title);
    } catch (error) {
      this.context.complain(error);
    }
  }

  private show(id: string, law: LawView, title: string): void {
    this.end();
    const unit = law.position_unit;
    const text = element(
      "details",
      {},
      element("summary", {}, "The law file"),
      element("pre", { tabindex: 0 }, law.toml),
    );
    this.root.replaceChildren(
      element("div", { class: "head" }, element("h2", {}, title), feelButton(this.context, id, title)),
      element("p", { class: "equation" }, law.equation),
      element(
        "p",
        { class: "quiet" },
        `${law.name} · axis ${law.axis || "–"}${law.parameters.length > 0 ? ` · ${law.parameters.length} parameters` : ""}`,
      ),
    );
    const options = optionsInWords(law);
    if (options) this.root.append(element("p", { class: "quiet" }, options));
    if (law.curve.penetration.length > 0) {
      const { penetration, closing, opening, speed, range } = law.curve;
      this.plot = new Plot(`Force of ${title} over penetration`);
      this.plot.show(
        figureOf(`penetration [${unit}]`, `force [${law.force_unit}]`, {
          curves: [
            lineOf("in", penetration, closing, { dashed: true, width: 2.5 }),
            lineOf("out", penetration, opening, { dashed: true, width: 1.25 }),
          ],
          notes: [`In and out at ${withUnit(speed, `${unit}/s`)}, to ${range}.`],
        }),
      );
      this.root.append(
        this.plot.figure(),
        element("p", { class: "quiet" }, `In and out at ${withUnit(speed, `${unit}/s`)}, to ${range}.`),
      );
    } else {
      this.root.append(element("p", { class: "quiet" }, law.curve.range));
    }
    this.root.append(parameterTable(law), text);
    this.root.hidden = false;
  }
}
