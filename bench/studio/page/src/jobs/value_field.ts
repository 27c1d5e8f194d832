import type { OfferedNames, VerbValue } from "../api/jobs";
import { element, select } from "../ui/dom";

/** One value of a verb: its control, and what it says. */
export interface ValueField {
  readonly root: HTMLElement;
  /** undefined: nothing is given. */
  value: () => unknown;
  set: (value: unknown) => void;
}

let fields = 0; // for ids, which no two may share

/** The name that it has on the page: "--blank-speeds" is "blank speeds". */
export function plainName(name: string): string {
  return name.replace(/^-+/, "").replaceAll("-", " ").toLowerCase();
}

/** What the program says, with its options by the names that the forms have: "--subjects" is “subjects”. */
export function inPageWords(said: string): string {
  return said.replace(/(?<![\w'"“-])(?:--[a-z][a-z-]*|-o\b)/g, (it) => `“${it === "-o" ? "output" : plainName(it)}”`);
}

/** The files, or folders, that suit a value. */
export function namesFor(value: VerbValue, names: OfferedNames): string[] {
  if (value.kind === "folder") return names.folders;
  return names.files.filter((name) => value.words.some((ending) => name.endsWith(ending)));
}

function framed(value: VerbValue, control: HTMLElement): HTMLElement {
  const id = `value_${++fields}`;
  control.id = id;
  control.setAttribute("aria-describedby", `${id}_about`);
  return element(
    "div",
    { class: "value_field" },
    element("label", { for: id }, plainName(value.name), value.required ? element("b", {}, " needed") : null),
    control,
    element("p", { id: `${id}_about`, class: "quiet" }, inPageWords(value.label)),
  );
}

function flag(value: VerbValue): ValueField {
  const box = element("input", { type: "checkbox" });
  return {
    root: framed(value, box),
    value: () => (box.checked ? true : undefined),
    set: (to) => (box.checked = to === true),
  };
}

function typed(value: VerbValue, standard: string): ValueField {
  const input = element("input", {
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    placeholder: standard,
    inputmode: value.kind === "number" ? "decimal" : "text",
  });
  const given = (): string => input.value.trim();
  const several = (): string[] => given().split(/\s+/);
  return {
    root: framed(value, input),
    value: () => (given() === "" ? undefined : value.repeated && value.kind === "number" ? several() : given()),
    set: (to) => (input.value = Array.isArray(to) ? to.join(" ") : typeof to === "string" ? to : ""),
  };
}

function one(value: VerbValue, choices: readonly string[], none: string): ValueField {
  const list = select(
    [{ value: "", text: none }, ...choices.map((it) => ({ value: it, text: it }))],
    value.required && choices.length === 1 ? choices[0]! : "",
    () => {},
  );
  return {
    root: framed(value, list),
    value: () => list.value || undefined,
    set: (to) => (list.value = typeof to === "string" ? to : ""),
  };
}

/** Several of a list, with a box each; of a long one what was not set is folded away. */
function several(value: VerbValue, choices: readonly string[]): ValueField {
  const isLong = choices.length > 8;
  const boxes = choices.map((name) => element("input", { type: "checkbox", value: name }));
  const labels = boxes.map((box, k) => element("label", { class: "tick" }, box, choices[k]!));
  const front = element("div", { class: "value_boxes" });
  const others = element("div", { class: "value_boxes" });
  const count = element("summary");
  const fold = element("details", {}, count, others);
  const id = `value_${++fields}`;
  const root = element(
    "fieldset",
    { class: "value_field", "aria-describedby": `${id}_about` },
    element("legend", {}, plainName(value.name), value.required ? element("b", {}, " needed") : null),
    front,
    fold,
    choices.length === 0 ? element("p", {}, "There is none in this folder.") : null,
    element("p", { id: `${id}_about`, class: "quiet" }, inPageWords(value.label)),
  );
  const chosen = (): string[] => boxes.filter((it) => it.checked).map((it) => it.value);
  const lay = (): void => {
    const isInFront = (k: number): boolean => !isLong || chosen().length === 0 || boxes[k]!.checked;
    front.replaceChildren(...labels.filter((_, k) => isInFront(k)));
    others.replaceChildren(...labels.filter((_, k) => !isInFront(k)));
    fold.hidden = others.childElementCount === 0;
    count.textContent = `${others.childElementCount} more`;
  };
  lay();
  return {
    root,
    value: () => (chosen().length > 0 ? chosen() : undefined),
    set: (to) => {
      for (const it of boxes) it.checked = Array.isArray(to) ? to.includes(it.value) : to === it.value;
      lay();
    },
  };
}

function standardText(value: VerbValue): string {
  if (value.standard) return value.standard;
  if (value.kind === "output") return value.words[0] === "" ? "a new folder" : `a new name${value.words.join(" or ")}`;
  return value.kind === "device" ? "sim:scissors" : "";
}

/** The control for a value. */
export function valueField(value: VerbValue, names: OfferedNames): ValueField {
  switch (value.kind) {
    case "flag":
      return flag(value);
    case "choice":
      return one(value, value.words, value.standard || "as it is");
    case "file":
    case "folder": {
      const choices = namesFor(value, names);
      return value.repeated
        ? several(value, choices)
        : one(value, choices, choices.length > 0 ? "none" : "there is none");
    }
    default:
      return typed(value, standardText(value));
  }
}
