import type { LineKind, Preview, PreviewColumn, PreviewLine } from "../api/intake";
import { element, select, setOptions } from "../ui/dom";
import {
  choicesOf,
  columnsOfForm,
  isContinued,
  isPlain,
  mapOf,
  ownChannel,
  siblingsOf,
  spatialChannels,
  usualChannels,
  type Choice,
} from "./mapping";
import { UnitField } from "./unit_field";

const words: Record<LineKind, string> = {
  remark: "remark",
  names: "names",
  units: "units",
  data: "",
  no_data: "left out: no data",
  misplaced: "left out: its time repeats or goes back",
  empty: "empty",
};

const usualForm = "quaternion xyzw";

/** The first lines of a file, with what each column becomes above it, and what is left out marked at its line. */
export class PreviewTable {
  readonly root = element("div", { class: "preview" });
  private columns = ""; // what the head is of: it is built anew only where that changes, so that focus stays
  private choices: Choice[] = [];
  private channels: HTMLSelectElement[] = [];
  private units: UnitField[] = [];
  private readonly head = element("tr", {});
  private readonly body = element("tbody");
  private readonly further = element("div", {});

  constructor(private readonly changed: (map: string) => void) {}

  show(preview: Preview, map: string): void {
    const columns = JSON.stringify(preview.columns);
    if (columns !== this.columns) this.build(preview);
    this.columns = columns;
    this.choices = choicesOf(preview, map);
    const plain = isPlain(preview, map);
    this.choices.forEach((choice, k) => {
      const [channel, unit] = [this.channels[k]!, this.units[k]!];
      const isPart = isContinued(choice.channel);
      offer(channel, choice.channel);
      channel.disabled = !plain || isPart;
      // Of y and z as of x.
      const units = preview.units[choice.channel.replace(/\.[yz]$/, ".x")] ?? preview.units.own ?? [];
      unit.show(choice.unit, units, { disabled: !plain, needsFrame: /^(force|torque)\./.test(choice.channel) });
      unit.root.hidden = choice.channel === "" || isPart || preview.columns[k]!.stamps;
    });
    const width = preview.columns.length;
    this.body.replaceChildren(...preview.lines.map((line) => row(line, width, this.choices)));
    this.further.replaceChildren(...this.irregular(preview));
  }

  clear(): void {
    this.columns = "";
    this.root.replaceChildren();
  }

  private build(preview: Preview): void {
    this.channels = [];
    this.units = [];
    this.head.replaceChildren(
      element("th", { scope: "col", class: "number" }, "Line"),
      ...preview.columns.map((column, k) => element("th", { scope: "col" }, this.cell(column, k))),
      element("th", { scope: "col" }, element("span", { class: "unseen" }, "What the line is")),
    );
    this.root.replaceChildren(
      element(
        "div",
        { class: "preview_scroll", tabindex: 0, role: "region", "aria-label": "First lines of the file" },
        element("table", {}, element("thead", {}, this.head), this.body),
      ),
      this.further,
    );
  }

  private cell(column: PreviewColumn, k: number): HTMLElement {
    const name = column.name || `column ${column.number}`;
    const channel = select([], "", (value) => this.choose(k, value, column));
    channel.setAttribute("aria-label", `What column ${column.number}, ${name}, becomes`);
    channel.className = "channel";
    const unit = new UnitField(column, (text) => this.chooseUnit(k, text));
    this.channels[k] = channel;
    this.units[k] = unit;
    const said = saidOfUnit(column);
    return element(
      "div",
      { class: "preview_column" },
      element("span", { class: "preview_name", title: column.heading }, `${column.number} ${column.name}`),
      element("span", { class: "quiet" }, said),
      channel,
      unit.root,
    );
  }

  private choose(k: number, value: string, column: PreviewColumn): void {
    const { choices } = this;
    for (const [other, choice] of choices.entries()) {
      if (other !== k && choice.channel === value && value !== "own") choice.channel = ""; // a channel is one column's
    }
    const taken = [...usualChannels, ...spatialChannels, ...choices.map((it) => it.channel)];
    const channel = value === "own" ? ownChannel(column.name, column.number, taken) : value;
    const unit = value === "own" && !column.unit ? "1" : "";
    choices[k] = { channel, unit: value === "orientation" ? usualForm : unit };
    if (value.endsWith(".x")) {
      // y and z stand beside x most often.
      const siblings = siblingsOf(value);
      const isFree = (at: number): boolean => choices[at]?.channel === "";
      const isNamed = (it: string): boolean => choices.some(({ channel }) => channel === it);
      if (siblings.every((it, i) => isFree(k + 1 + i) && !isNamed(it)))
        siblings.forEach((it, i) => (choices[k + 1 + i] = { channel: it, unit: "" }));
    }
    this.takeOrientation();
    this.changed(mapOf(choices));
  }

  private chooseUnit(k: number, unit: string): void {
    const { channel, unit: before } = this.choices[k]!;
    const siblings = siblingsOf(channel);
    for (const choice of this.choices)
      if (siblings.includes(choice.channel) && choice.unit === before) choice.unit = unit; // as one, until told apart
    this.choices[k]!.unit = unit;
    this.takeOrientation();
    this.changed(mapOf(this.choices));
  }

  /** An orientation has as many columns as its form. */
  private takeOrientation(): void {
    const { choices } = this;
    for (const choice of choices) if (isContinued(choice.channel)) choice.channel = "";
    const first = choices.findIndex((it) => it.channel === "orientation");
    if (first < 0) return;
    const last = Math.min(first + columnsOfForm(choices[first]!.unit), choices.length);
    for (let k = first + 1; k < last; ++k) choices[k] = { channel: `orientation.${k - first + 1}`, unit: "" };
  }

  private irregular(preview: Preview): HTMLElement[] {
    if (preview.irregular.length === 0) return [];
    return [
      element("h3", {}, "Further lines that are left out"),
      element(
        "ol",
        { class: "irregular" },
        ...preview.irregular.map((line) =>
          element("li", {}, `Line ${line.number}: ${words[line.kind]}: ${line.fields.join("  ")}`),
        ),
      ),
    ];
  }
}

function row(line: PreviewLine, width: number, choices: readonly Choice[]): HTMLElement {
  const said = words[line.kind];
  const isLeftOut = line.kind === "no_data" || line.kind === "misplaced";
  const fields =
    line.kind === "remark"
      ? [element("td", { colspan: width }, line.fields[0] ?? "")]
      : Array.from({ length: width }, (_, k) =>
          element("td", { class: choices[k]?.channel ? "taken" : "left" }, line.fields[k] ?? ""),
        );
  const beyond = line.kind !== "remark" && line.fields.length > width ? ` ${line.fields.slice(width).join("  ")}` : "";
  return element(
    "tr",
    { class: `line_${line.kind}` },
    element("th", { scope: "row", class: "number" }, `${isLeftOut ? "✕ " : ""}${line.number}`),
    ...fields,
    element("td", { class: "line_said" }, `${said}${beyond}`),
  );
}

/** The usual channels, and the one that is chosen. */
function offer(node: HTMLSelectElement, chosen: string): void {
  const usual = ["", ...usualChannels, "own", ...spatialChannels];
  const values = usual.includes(chosen) ? usual : [...usual, chosen];
  const texts: Record<string, string> = {
    "": "– left out –",
    own: "a channel of its own",
    orientation: "orientation, from here",
  };
  setOptions(
    node,
    values.map((it) => ({ value: it, text: texts[it] ?? it })),
    chosen,
  );
}

function saidOfUnit({ stamps, unit, unknown_unit }: PreviewColumn): string {
  if (stamps) return "time stamps";
  if (unit) return `[${unit}]`;
  return unknown_unit ? `[${unknown_unit}]: how many are one unit?` : "no unit in the file";
}
