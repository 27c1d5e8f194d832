import type { StabilityFile } from "../../api/results";
import type { Figure } from "../../ui/figure_description";
import { drawn, element } from "../../ui/dom";
import { withUnit } from "../../ui/numbers";
import { cellAt, cellBox } from "../../ui/plot/cells";
import { Plot } from "../../ui/plot/plot";

/** A map's figure; the cell under the cursor, or that the arrow keys lead to, is read out. */
export class StabilityMap {
  readonly root: HTMLElement;
  private readonly plot: Plot;
  private readonly readout = element(
    "p",
    { class: "readout", role: "status" },
    "Point at a cell, or go from cell to cell with the arrow keys.",
  );
  private readonly cursor = drawn("rect", { class: "cursor" });
  private row = -1; // from below
  private column = -1;

  constructor(
    private readonly file: StabilityFile,
    private readonly figure: Figure,
    name: string,
  ) {
    this.plot = new Plot(name, { ownArrows: true, redrawn: () => this.showCursor() });
    const { svg } = this.plot;
    svg.setAttribute("role", "application");
    svg.setAttribute("aria-roledescription", "map; arrow keys go from cell to cell");
    svg.addEventListener("pointermove", (event) => this.under(event));
    svg.addEventListener("keydown", (event) => this.key(event));
    this.root = this.plot.figure();
    this.root.classList.add("map");
    this.plot.reading.replaceWith(this.readout);
    if (figure.cells.x_edges.length === 0) this.readout.textContent = "";
    this.plot.layer.append(this.cursor);
    this.plot.show(figure);
  }

  end(): void {
    this.plot.end();
  }

  private under(event: PointerEvent): void {
    const { plot, figure } = this;
    const at = plot.pointer(event);
    const place = (value: number, edges: readonly number[]): number =>
      edges.findIndex((edge, i) => value >= edge && value <= (edges[i + 1] ?? -Infinity));
    const column = place(plot.xAt(at.x), figure.cells.x_edges);
    const row = place(plot.yAt(at.y), figure.cells.y_edges);
    if (column >= 0 && row >= 0) this.go(row, column);
  }

  private key(event: KeyboardEvent): void {
    const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] }[event.key];
    if (!step || event.shiftKey) return;
    event.preventDefault();
    const { x_edges, y_edges } = this.figure.cells;
    const rows = y_edges.length - 1;
    const columns = x_edges.length - 1;
    if (rows < 1 || columns < 1) return;
    if (this.row < 0) return this.go(Math.floor(rows / 2), Math.floor(columns / 2));
    this.go(
      Math.min(rows - 1, Math.max(0, this.row + (step[0] ?? 0))),
      Math.min(columns - 1, Math.max(0, this.column + (step[1] ?? 0))),
    );
  }

  private go(row: number, column: number): void {
    if (row === this.row && column === this.column) return;
    this.row = row;
    this.column = column;
    this.readout.textContent = cellInWords(this.file, cellAt(this.figure.cells, column, row));
    this.showCursor();
  }

  private showCursor(): void {
    if (this.row < 0) return;
    for (const [name, value] of Object.entries(cellBox(this.figure.cells, this.plot.frame, this.column, this.row)))
      this.cursor.setAttribute(name, String(value));
  }
}

/** "K 4.2 kN/m, B 3.1 N·s/m: comes to rest; theory (the eigenvalues) agrees", of a cell of the file. */
function cellInWords(file: StabilityFile, at: number): string {
  if (!("cells" in file)) return "";
  if (file.study === "plane") {
    const point = file.cells[at];
    if (!point) return "";
    const place = `b/(K T) ${point.viscous.toPrecision(3)}, f_c/(K delta) ${point.coulomb.toPrecision(3)}`;
    return `${place}: ${point.behaviour}; by the lines ${point.region}`;
  }
  const cell = file.cells[at];
  if (!cell) return "";
  const agrees = cell.stable === cell.theory ? "agrees" : "says otherwise";
  if ("K" in cell) {
    const what = cell.stable ? "comes to rest" : "does not come to rest";
    return `K ${withUnit(cell.K, "N/m")}, B ${withUnit(cell.B, "N·s/m")}: ${what}; theory (the eigenvalues) ${agrees}`;
  }
  const what = cell.stable ? "passive" : "gains energy";
  return `rate ${withUnit(cell.rate_hz, "Hz")}, depth ${withUnit(cell.depth_m, "m")}: ${what}; theory (the local stiffness) ${agrees}`;
}
