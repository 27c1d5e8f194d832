import type { WorkspaceLaw } from "../api/workspace";
import { element, labelled, select, setOptions } from "../ui/dom";
import { designs, protocolText, shownUnit, type DraftLaw, type ProtocolDraft } from "./protocol_draft";

const languages = [
  { value: "en", text: "English" },
  { value: "de", text: "German" },
];

/** What an experiment asks of whom, in fields; it writes the protocol's text. */
export class ProtocolForm {
  readonly root: HTMLElement;
  private readonly fields = new Map<string, HTMLInputElement | HTMLTextAreaElement>();
  private readonly design: HTMLSelectElement;
  private readonly language: HTMLSelectElement;
  private readonly signal: HTMLSelectElement;
  private readonly laws = element("div", { class: "protocol_laws" });
  private readonly lawsHint = element("p", { class: "quiet" });
  private readonly boxes = new Map<string, HTMLInputElement>();
  private readonly units = new Map<string, string>();
  private readonly rows = new Map<string, HTMLElement>();
  private readonly motionUnits: HTMLElement[] = [];

  constructor(private readonly changed: () => void) {
    const told = (): void => {
      this.fit();
      this.changed();
    };
    const field = (key: string, label: string, attributes: Record<string, string | number> = {}): HTMLElement => {
      const node = element("input", { type: "text", maxlength: 200, autocomplete: "off", ...attributes, input: told });
      this.fields.set(key, node);
      return this.row(key, labelled(label, node));
    };
    const number = (key: string, label: string, value: string): HTMLElement =>
      field(key, label, { type: "number", min: 0, step: "any", value });
    const area = (key: string, label: string): HTMLElement => {
      const node = element("textarea", { rows: 2, maxlength: 4000, input: told });
      this.fields.set(key, node);
      return this.row(key, labelled(label, node));
    };
    this.design = select(
      designs.map((it) => ({ value: it.name, text: it.words })),
      "abx",
      () => {
        const { trials, levels = "" } = this.kind;
        this.field("trials").value = String(trials);
        this.field("levels").value = levels;
        told();
      },
    );
    this.language = select(languages, "en", told);
    this.signal = select([], "", told);
    const place = (key: string, label: string, value: string): HTMLElement => {
      const unit = element("span", {}, "mm");
      this.motionUnits.push(unit);
      const node = element("input", { type: "number", step: "any", value, input: told });
      this.fields.set(key, node);
      return element("label", { class: "field" }, element("span", {}, `${label} [`, unit, "]"), node);
    };
    this.root = element(
      "form",
      { class: "protocol_form", submit: (event: Event) => event.preventDefault() },
      labelled("What a trial asks", this.design),
      element("fieldset", {}, element("legend", {}, "Laws that are felt"), this.lawsHint, this.laws),
      this.row("signal", labelled("The signal", this.signal)),
      field("title", "Title, over every trial", { placeholder: "Comparison" }),
      field("question", "Question (empty: the design's)"),
      field("ends", "Words at the two ends, with a comma between", { value: "none, very much" }),
      area("instructions", "Instructions, ahead of the practice"),
      area("consent", "Consent, which has to be agreed to (empty: none)"),
      element(
        "div",
        { class: "row" },
        number("trials", "Trials", "40"),
        number("practice", "Practice", "4"),
        number("break", "A break every … trials", "20"),
      ),
      field("levels", "Levels, as shares of the standard"),
      element(
        "div",
        { class: "row" },
        number("interval", "Each is felt for [s] (empty: the design's)", ""),
        labelled("Language of the subject", this.language),
      ),
      field("device", "Device (empty: it is said when a session begins)"),
      element("div", { class: "row" }, place("from", "Rehearsals move from", ""), place("to", "to", "")),
    );
    this.fit();
  }

  /** Laws of the folder; those that are chosen stay so. */
  offer(laws: readonly WorkspaceLaw[]): void {
    const readable = laws.filter((it) => it.error === "");
    const names = readable.map((it) => it.name);
    if (names.join("\n") === [...this.boxes.keys()].join("\n")) return;
    const chosen = new Set(this.chosen().map((it) => it.name));
    this.boxes.clear();
    for (const { name, position_unit } of readable) {
      this.units.set(name, position_unit);
      this.boxes.set(
        name,
        element("input", {
          type: "checkbox",
          checked: chosen.has(name),
          change: () => {
            this.only(name);
            this.fit();
            this.changed();
          },
        }),
      );
    }
    this.laws.replaceChildren(
      ...[...this.boxes].map(([name, box]) => element("label", { class: "tick" }, box, element("span", {}, name))),
    );
    this.fit();
  }

  set device(uri: string) {
    const field = this.field("device");
    if (field.value === "") field.value = uri;
  }

  text(name: string): string {
    const value = (key: string): string => this.field(key).value;
    const asNumber = (key: string): number => (value(key).trim() === "" ? NaN : Number(value(key)));
    const draft: ProtocolDraft = {
      name,
      title: value("title"),
      design: this.kind,
      laws: this.chosen(),
      signal: this.signal.value,
      question: value("question"),
      instructions: value("instructions"),
      consent: value("consent"),
      ends: value("ends"),
      trials: Math.round(asNumber("trials")) || 0,
      practice: Math.round(asNumber("practice")) || 0,
      levels: value("levels"),
      interval_s: asNumber("interval"),
      breakEvery: Math.round(asNumber("break")) || 0,
      device: value("device"),
      language: this.language.value,
      from: asNumber("from"),
      to: asNumber("to"),
    };
    return protocolText(draft);
  }

  private get kind(): ProtocolDraft["design"] {
    return designs.find((it) => it.name === this.design.value) ?? designs[0]!;
  }

  private field(key: string): HTMLInputElement | HTMLTextAreaElement {
    return this.fields.get(key)!;
  }

  private row(key: string, node: HTMLElement): HTMLElement {
    this.rows.set(key, node);
    return node;
  }

  private chosen(): DraftLaw[] {
    return [...this.boxes]
      .filter(([, box]) => box.checked)
      .map(([name]) => ({ name, unit: this.units.get(name) ?? "m" }));
  }

  /** Where the design takes one law, another takes its place. */
  private only(name: string): void {
    if (this.kind.laws !== "one") return;
    for (const [other, box] of this.boxes) if (other !== name) box.checked = false;
  }

  /** What the design has no use for is not asked. */
  private fit(): void {
    const { kind } = this;
    const laws = this.chosen();
    const show = (key: string, on: boolean): void => {
      this.rows.get(key)!.hidden = !on;
    };
    show("signal", kind.hasSignal === true);
    show("levels", kind.levels !== undefined);
    show("ends", kind.name === "rating");
    const question = this.field("question");
    question.required = kind.asks !== undefined;
    question.placeholder = kind.asks ? `such as: ${kind.asks}` : "";
    this.rows.get("question")!.querySelector("span")!.textContent = kind.asks
      ? "Question (needed: this design has none of its own)"
      : "Question (empty: the design's)";
    setOptions(
      this.signal,
      laws.map((it) => ({ value: it.name, text: it.name })),
      this.signal.value || (laws[laws.length - 1]?.name ?? ""),
    );
    for (const unit of this.motionUnits) unit.textContent = shownUnit(laws);
    const wanted = { one: "One law, the standard", two: "Two laws", some: "Two laws and more: every pair of them" };
    const none = "There is no law in this folder yet: fit one to a recording, or draw it.";
    this.lawsHint.textContent = this.boxes.size > 0 ? `${wanted[kind.laws]}.` : none;
  }
}
