// Elements without markup in strings: nothing from a file or a person is ever parsed as HTML.

type Child = Node | string | null;
type Attributes = Record<string, string | number | boolean | ((event: never) => void)>;

function fill(node: Element, attributes: Attributes, children: Child[]): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") node.addEventListener(name, value as EventListener);
    else if (value === true) node.setAttribute(name, "");
    else if (value !== false) node.setAttribute(name, String(value));
  }
  for (const child of children) if (child !== null) node.append(child);
}

/** `element("button", { type: "button", click: go }, "Go")`: a function is a listener, the rest are attributes. */
export function element<Name extends keyof HTMLElementTagNameMap>(
  name: Name,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[Name] {
  const node = document.createElement(name);
  fill(node, attributes, children);
  return node;
}

export function drawn<Name extends keyof SVGElementTagNameMap>(
  name: Name,
  attributes: Attributes = {},
  ...children: Child[]
): SVGElementTagNameMap[Name] {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  fill(node, attributes, children);
  return node;
}

/** A labelled control: label and control are bound, the unit stands in the label. */
export function labelled(text: string, control: HTMLElement): HTMLLabelElement {
  return element("label", { class: "field" }, element("span", {}, text), control);
}

export function button(text: string, press: () => void, attributes: Attributes = {}): HTMLButtonElement {
  return element("button", { type: "button", click: press, ...attributes }, text);
}

export interface Option {
  readonly value: string;
  readonly text: string;
  readonly disabled?: boolean;
}

export function select(options: readonly Option[], chosen: string, change: (value: string) => void): HTMLSelectElement {
  const node = element("select", { change: () => change(node.value) });
  setOptions(node, options, chosen);
  return node;
}

/** What is chosen stays so unless told otherwise; where it is not to be had any more, the first one is. */
export function setOptions(node: HTMLSelectElement, options: readonly Option[], chosen = node.value): void {
  const isThere = ({ value, text, disabled = false }: Option, k: number): boolean => {
    const own = node.options[k];
    return own?.value === value && own.textContent === text && own.disabled === disabled;
  };
  // Those that are there stay: the list may be open.
  if (node.options.length !== options.length || !options.every(isThere))
    node.replaceChildren(
      ...options.map(({ value, text, disabled = false }) => element("option", { value, disabled }, text)),
    );
  const wanted = options.find((it) => it.value === chosen && !it.disabled) ?? options[0];
  node.value = wanted?.value ?? "";
}

/** What a column is called, and in a file, where it has its unit. */
export type Head = string | readonly [here: string, file: string];

/** A table with a header row; cells of numberCell() stand as they are. */
export function table(caption: string, heads: readonly Head[], rows: (Node | string)[][]): HTMLTableElement {
  return element(
    "table",
    {},
    element("caption", {}, caption),
    element("thead", {}, element("tr", {}, ...heads.map(headCell))),
    element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map(cellOf)))),
  );
}

/** A cell whose number files have to its last digit, whatever it is rounded to here. */
export function numberCell(text: string, value: number | null | undefined): HTMLTableCellElement {
  const known = value != null && Number.isFinite(value);
  return element("td", { class: "number", "data-value": known ? String(value) : "" }, text);
}

function headCell(head: Head): HTMLTableCellElement {
  if (typeof head === "string") return element("th", { scope: "col" }, head);
  return element("th", { scope: "col", "data-head": head[1] }, head[0]);
}

function cellOf(cell: Node | string): HTMLTableCellElement {
  return cell instanceof HTMLTableCellElement ? cell : element("td", {}, cell);
}
