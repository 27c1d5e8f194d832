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

export function select(
  options: readonly { value: string; text: string }[],
  chosen: string,
  change: (value: string) => void,
): HTMLSelectElement {
  const node = element(
    "select",
    { change: () => change(node.value) },
    ...options.map((it) => element("option", { value: it.value, selected: it.value === chosen }, it.text)),
  );
  return node;
}

/** A table with a header row; numbers are right-aligned by the class "number". */
export function table(caption: string, heads: string[], rows: (Node | string)[][]): HTMLTableElement {
  return element(
    "table",
    {},
    element("caption", {}, caption),
    element("thead", {}, element("tr", {}, ...heads.map((it) => element("th", { scope: "col" }, it)))),
    element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map((cell) => element("td", {}, cell))))),
  );
}
