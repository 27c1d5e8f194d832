import type { InspectedCycle, InspectedSignal, Inspection, RecordingInspection } from "../api/recordings";
import { button, element, numberCell } from "../ui/dom";
import { counted, plain, withUnit } from "../ui/numbers";
import { tableMenu } from "../ui/plot/out/export_menu";
import { inPageWords } from "../ui/page_words";

const mostCycles = 300;

/** What a recording is worth, as kerf inspect says it: warnings, then signals, times, cycles. */
export class InspectionPanel {
  readonly root = element("div", { class: "inspection" }, element("p", { role: "status" }, "It is being looked at …"));

  constructor(private readonly go: (from_s: number, to_s: number) => void) {}

  show(found: RecordingInspection): void {
    const { inspection } = found;
    if (!inspection) this.root.replaceChildren(element("p", {}, found.why_none));
    else
      this.root.replaceChildren(
        warnings(inspection),
        scrolled(signals(inspection)),
        times(inspection),
        scrolled(this.cycles(inspection)),
      );
  }

  fail(error: unknown): void {
    const why = error instanceof Error ? error.message : String(error);
    this.root.replaceChildren(element("p", { class: "wrong" }, `It could not be looked at: ${why}`));
  }

  private cycles(inspection: Inspection): HTMLElement {
    const { cycles } = inspection;
    if (!cycles) return element("p", {}, "No cycles are known.");
    const found = cycles.stored ? "stored in the recording" : "found now, not stored";
    const more = cycles.list.length > mostCycles ? `; the first ${mostCycles}` : "";
    return tableOf(
      "cycles",
      `${counted(cycles.list.length, "cycle")}, ${found}; good: ${cycles.good || "none"}${more}`,
      [
        ...["Cycle", "Begin [s]", "Wait [s]", "Closing [s]", "Hold [s]", "Opening [s]"],
        ...[`Peak [${cycles.force_unit}]`, `Work [${cycles.work_unit}]`, "Flags"],
      ],
      cycles.list.slice(0, mostCycles).map((it) => this.row(it)),
    );
  }

  private row(it: InspectedCycle): HTMLElement {
    const press = (): void => this.go(it.begin_s, it.begin_s + it.duration_s);
    const said = it.flags.map((flag) => `${flag.kind.replace("_", " ")}: ${flag.reason}`);
    if (it.accepted !== null) said.push(`accepted: ${it.accepted}`);
    const numbers = [it.begin_s, it.wait_s, it.closing_s, it.hold_s, it.opening_s, it.peak, it.work];
    return element(
      "tr",
      { class: it.good ? "" : "flagged" },
      element(
        "th",
        { scope: "row", "data-value": it.number },
        button(`${it.good ? "" : "⚑ "}${it.number}`, press, { class: "link", "aria-label": `Show cycle ${it.number}` }),
      ),
      ...numbers.map(number),
      element("td", {}, said.join("; ")),
    );
  }
}

function scrolled(content: HTMLElement): HTMLElement {
  const save = content instanceof HTMLTableElement ? tableMenu(content, content.className) : null;
  return element("div", {}, element("div", { class: "scrolled" }, content), save);
}

function tableOf(name: string, caption: string, heads: readonly string[], rows: HTMLElement[]): HTMLElement {
  return element(
    "table",
    { class: name },
    element("caption", {}, caption),
    element("thead", {}, element("tr", {}, ...heads.map((it) => element("th", { scope: "col" }, it)))),
    element("tbody", {}, ...rows),
  );
}

/** With all its digits where the pointer rests. */
function number(value: number | null | undefined): HTMLElement {
  const cell = numberCell(plain(value, 4), value);
  cell.title = value == null ? "not known" : String(value);
  return cell;
}

function warnings(inspection: Inspection): HTMLElement {
  if (inspection.warnings.length === 0) return element("p", { class: "warnings" }, "✓ Nothing to warn of.");
  return element(
    "ul",
    { class: "warnings", "aria-label": "Warnings" },
    ...inspection.warnings.map((it) =>
      element("li", {}, element("span", { "aria-hidden": "true" }, "⚠ "), element("span", {}, inPageWords(it))),
    ),
  );
}

function signals(inspection: Inspection): HTMLElement {
  const heads = ["Signal", "Unit", "Least", "Most", "Quantum", "Noise", "Idle", "Contact", "Zeros [%]", "Dead zone"];
  return tableOf(
    "signals",
    `Signals; noise of all rows, of idle ones and in contact; contact is told along ${inspection.axis}`,
    [...heads, "Clipped", "Outliers", "Drift"],
    Object.entries(inspection.signals).map(([name, it]) => signalRow(name, it, inspection.rows)),
  );
}

function signalRow(name: string, it: InspectedSignal, rows: number): HTMLElement {
  const clipped = clippedIn(it);
  const text = (words: string, wrong: boolean): HTMLElement => element("td", { class: wrong ? "wrong" : "" }, words);
  return element(
    "tr",
    {},
    element("th", { scope: "row" }, name),
    element("td", {}, it.unit),
    number(it.least.value),
    number(it.most.value),
    number(it.quantum),
    number(it.noise),
    number(it.noise_idle),
    number(it.noise_contact),
    number(rows > 0 ? (100 * it.zeros.rows) / rows : null),
    text(
      it.dead_zone ? `below ${plain(it.zeros.nearest)}` : it.dead_zone === false ? "no" : "–",
      it.dead_zone === true,
    ),
    text(clipped || "no", clipped !== "" && !clipped.endsWith("?")),
    number(it.outliers),
    number(it.drift?.over_all),
  );
}

/** "high, 99 rows"; with a question mark where it may be a hold. */
function clippedIn(it: InspectedSignal): string {
  const ends = [
    ["low", it.least],
    ["high", it.most],
  ] as const;
  return ends
    .filter(([, end]) => end.clipped !== false)
    .map(([which, end]) => (end.clipped ? `${which}, ${end.rows} rows` : `${which}?`))
    .join("; ");
}

function times(inspection: Inspection): HTMLElement {
  const { sampling, contact, lag, rows } = inspection;
  const fact = (name: string, text: string): HTMLElement =>
    element("div", {}, element("dt", {}, name), element("dd", {}, text));
  const seconds = (value: number | null): string => withUnit(value, "s", 4);
  const share = contact && rows > 0 ? ` (${plain((100 * contact.rows) / rows)} %)` : "";
  return element(
    "dl",
    { class: "facts" },
    fact("Rows", `${rows} over ${seconds(sampling.duration_s)}`),
    fact("True rate", withUnit(sampling.true_rate_hz, "Hz", 5)),
    fact("Usual step", seconds(sampling.period_s)),
    fact("Steps", `${seconds(sampling.shortest_step_s)} to ${seconds(sampling.longest_step_s)}`),
    fact("Jitter", seconds(sampling.jitter_s)),
    fact("Stamps by", seconds(sampling.resolution_s)),
    fact("Gaps", String(sampling.gaps)),
    fact(
      "Times that repeat, go back, are no number",
      [sampling.repeated, sampling.backward, sampling.not_finite].join(", "),
    ),
    fact(
      "In contact",
      contact ? `${contact.rows} rows${share}, in stretches: ${contact.stretches.length}` : "not known",
    ),
    fact("Lag of the force", lag ? `${seconds(lag.seconds)} (correlation ${plain(lag.correlation)})` : "not known"),
  );
}
