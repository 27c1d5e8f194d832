// What is used of d3-brush and d3-selection, which come without types.

declare module "d3-selection" {
  export interface Selection {
    call: (what: unknown, ...more: unknown[]) => Selection;
  }
  export function select(node: Element): Selection;
}
declare module "d3-brush" {
  export interface BrushEvent {
    selection: [number, number] | null;
    sourceEvent: Event | null; // null: by the program
  }
  export interface Brush {
    (selection: unknown): void;
    extent: (extent: [[number, number], [number, number]]) => Brush;
    on: (type: "end", listener: (event: BrushEvent) => void) => Brush;
    move: unknown;
  }
  export function brushY(): Brush;
}
