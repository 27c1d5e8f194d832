import type { StabilityFile } from "../api";
import type { AxisOptions, PlotLine } from "../ui/xy_plot";
import { withUnit } from "../ui/numbers";

/** One trial of a map. */
export interface MapCell {
  stable: boolean;
  theory: boolean;
}

/** A level of the device itself, across the map. */
export interface DeviceLine {
  label: string;
  y?: number;
  x?: number;
}

/** A map of either kind, as a grid over x (columns) and y (rows), both increasing. */
export interface MapModel {
  x: { axis: AxisOptions; values: number[]; name: string; unit: string };
  y: { axis: AxisOptions; values: number[]; name: string; unit: string };
  cells: MapCell[][]; // [row][column]
  boundaries: (PlotLine & { label: string })[];
  device: DeviceLine[];
  words: { stable: string; unstable: string; theory: string };
}

const numbersOf = (values: Iterable<number>): number[] => [...new Set(values)].sort((a, b) => a - b);

/** A grid of the cells, whatever their order in the file. */
function grid<Cell extends MapCell>(
  cells: readonly Cell[],
  xs: number[],
  ys: number[],
  x: (cell: Cell) => number,
  y: (cell: Cell) => number,
): MapCell[][] {
  const column = new Map(xs.map((value, i) => [value, i]));
  const row = new Map(ys.map((value, i) => [value, i]));
  const rows: MapCell[][] = ys.map(() => []);
  for (const cell of cells) rows[row.get(y(cell)) ?? 0]![column.get(x(cell)) ?? 0] = cell;
  return rows;
}

/** Where a boundary lies beyond the map it is not drawn. */
function within(values: number[], [lower, upper]: [number, number]): (number | null)[] {
  return values.map((it) => (it > lower * 1.0001 && it < upper * 0.9999 ? it : null));
}

/** Walls: damping across, stiffness up; a law: depth across, rate up. */
export function mapModel(file: StabilityFile): MapModel {
  if (file.study === "wall") {
    const xs = numbersOf(file.cells.map((it) => it.B));
    const ys = numbersOf(file.cells.map((it) => it.K));
    const range: [number, number] = [ys[0] ?? 1, ys[ys.length - 1] ?? 2];
    const damping = file.boundaries.map((it) => it.B);
    const line = (label: string, kind: string, values: number[]): PlotLine & { label: string } => {
      const y = within(values, range);
      const drawn = y.filter((it) => it !== null).length;
      const where = drawn === 0 ? " (nowhere on this map)" : drawn === 1 ? " (at one damping alone)" : "";
      return { label: label + where, class: kind, x: damping, y };
    };
    const of = file.boundaries;
    return {
      x: { axis: { label: "damping of the wall B [N·s/m]" }, values: xs, name: "B", unit: "N·s/m" },
      y: { axis: { label: "stiffness of the wall K [N/m]", logarithmic: true }, values: ys, name: "K", unit: "N/m" },
      cells: grid(
        file.cells,
        xs,
        ys,
        (it) => it.B,
        (it) => it.K,
      ),
      boundaries: [
        line(
          "simulated, as it is",
          "simulated",
          of.map((it) => it.simulated),
        ),
        line(
          "eigenvalues",
          "eigenvalues",
          of.map((it) => it.eigenvalues),
        ),
        line(
          "passive, with filter and delay",
          "passive",
          of.map((it) => it.passive),
        ),
        line(
          "Colgate and Schenkel",
          "colgate_schenkel",
          of.map((it) => it.colgate_schenkel),
        ),
      ],
      device: [
        {
          label: `passive without damping: ${withUnit(file.on.passive_stiffness_n_per_m, "N/m")}`,
          y: file.on.passive_stiffness_n_per_m,
        },
        {
          label: `the device's own damping: ${withUnit(file.on.damping_n_s_per_m, "N·s/m")}`,
          x: file.on.damping_n_s_per_m,
        },
      ],
      words: { stable: "comes to rest", unstable: "does not come to rest", theory: "the eigenvalues" },
    };
  }
  const xs = numbersOf(file.cells.map((it) => it.depth_m));
  const ys = numbersOf(file.cells.map((it) => it.rate_hz));
  const cells = grid(
    file.cells,
    xs,
    ys,
    (it) => it.depth_m,
    (it) => it.rate_hz,
  );
  const ends = cells.map((row) => row.findIndex((it) => !it.theory)); // depth at which theory gives up
  const theory: PlotLine & { label: string } = {
    label: "local stiffness = passive stiffness",
    class: "eigenvalues",
    x: ends.map((at) => (at <= 0 ? null : ((xs[at - 1] ?? 0) + (xs[at] ?? 0)) / 2)),
    y: ys,
  };
  return {
    x: { axis: { label: "depth, in travel of the device [m]" }, values: xs, name: "depth", unit: "m" },
    y: { axis: { label: "sampling rate [Hz]", logarithmic: true }, values: ys, name: "rate", unit: "Hz" },
    cells,
    boundaries: [theory],
    device: [
      { label: `this device: ${withUnit(file.on.rate_hz, "Hz")}`, y: file.on.rate_hz },
      { label: `asked for: ${withUnit(file.range.depth_m, "m")}`, x: file.range.depth_m },
    ],
    words: { stable: "passive", unstable: "gains energy", theory: "the local stiffness" },
  };
}

/** "K 4.2 kN/m, B 3.1 N·s/m: comes to rest; the eigenvalues agree". */
export function cellInWords(map: MapModel, row: number, column: number): string {
  const cell = map.cells[row]?.[column];
  if (!cell) return "";
  const x = `${map.x.name} ${withUnit(map.x.values[column], map.x.unit)}`;
  const y = `${map.y.name} ${withUnit(map.y.values[row], map.y.unit)}`;
  const what = cell.stable ? map.words.stable : map.words.unstable;
  const agrees = cell.stable === cell.theory ? "agrees" : "says otherwise";
  return `${y}, ${x}: ${what}; theory (${map.words.theory}) ${agrees}`;
}

/** Edges of cells: half-way between their middles, on the scale that they are drawn on. */
export function edgesOf(values: readonly number[], logarithmic: boolean): number[] {
  const between = (a: number, b: number): number => (logarithmic ? Math.sqrt(a * b) : (a + b) / 2);
  const inner = values.slice(1).map((value, i) => between(values[i] ?? value, value));
  return [values[0] ?? 0, ...inner, values[values.length - 1] ?? 1];
}
