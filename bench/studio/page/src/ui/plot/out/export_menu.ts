import { button, element, labelled, select } from "../../dom";
import { csvOf, figureColumns, tableColumns } from "./csv_file";
import { download, fileName } from "./download";
import { pngOf } from "./png_file";
import { columns, printed, type Column, type Sheet } from "./sheet";
import { svgOf } from "./svg_file";

let column: Column = "one"; // as it was chosen last

/** A menu that hands a plot out as SVG, PNG or CSV; `sheet` is asked when one of them is pressed. */
export function exportMenu(sheet: () => Sheet | Promise<Sheet>): HTMLElement {
  const width = select(
    Object.entries(columns).map(([value, { text }]) => ({ value, text })),
    column,
    (value) => (column = value as Column),
  );
  const svg = async (): Promise<void> => {
    const of = await sheet();
    download(svgOf(printed(of, column)), fileName(of.name, "svg"), "image/svg+xml");
  };
  const png = async (): Promise<void> => {
    const of = await sheet();
    download(await pngOf(printed(of, column)), fileName(of.name, "png"));
  };
  const csv = async (): Promise<void> => {
    const of = await sheet();
    download(csvOf(figureColumns(of.figures)), fileName(of.name, "csv"), "text/csv");
  };
  const about =
    "As shown now, letters of 8 pt. A picture has all that is drawn, a table its numbers in the units of the axes.";
  return menu(
    "Save plot",
    { SVG: svg, PNG: png, CSV: csv },
    labelled("Width", width),
    element("p", { class: "quiet" }, about),
  );
}

/** A menu that hands a table out as CSV. */
export function tableMenu(table: HTMLTableElement, name: string): HTMLElement {
  return button("Save CSV", () => download(csvOf(tableColumns(table)), fileName(name, "csv"), "text/csv"), {
    class: "small",
    "aria-label": `Save CSV of the table ${name}`,
  });
}

/** A button that opens what can be had; closed by a press elsewhere, or when one was taken. */
export function menu(
  title: string,
  kinds: Record<string, () => void | Promise<void>>,
  ...more: HTMLElement[]
): HTMLElement {
  const said = element("p", { role: "status" });
  const take = (make: () => void | Promise<void>) => async (): Promise<void> => {
    said.textContent = "";
    try {
      await make();
      details.open = false;
    } catch (error) {
      said.textContent = error instanceof Error ? error.message : String(error);
    }
  };
  const body = element(
    "div",
    { tabindex: -1 }, // as in a Popover
    ...more,
    element(
      "div",
      { class: "kinds" },
      ...Object.entries(kinds).map(([name, make]) => button(name, () => void take(make)())),
    ),
    said,
  );
  const details = element("details", { class: "out" }, element("summary", {}, title), body);
  details.addEventListener("toggle", () => {
    body.classList.remove("rightwards");
    const edge = details.closest("main")?.getBoundingClientRect().left ?? 0;
    body.classList.toggle("rightwards", body.getBoundingClientRect().left < edge);
  });
  details.addEventListener("focusout", ({ relatedTarget }) => {
    if (relatedTarget instanceof Node && !details.contains(relatedTarget)) setTimeout(() => (details.open = false));
  });
  return details;
}
