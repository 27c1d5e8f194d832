/** An axis that can be brushed, in pixels from its top. */
export interface BrushAxis {
  group: SVGGElement;
  height: number;
  moved: (range: [number, number] | null) => void;
}
/** Gives back what moves the brush without telling. */
export type Brushes = (axis: BrushAxis) => (range: [number, number] | null) => void;

/** parallel.js, once. */
let loading: Promise<Brushes> | null = null;
export function loadBrushes(token: string): Promise<Brushes> {
  loading ??= new Promise((done, fail) => {
    const script = document.createElement("script");
    script.src = `/parallel.js?token=${token}`;
    script.onload = () => {
      const found = (window as { kerfBrushes?: Brushes }).kerfBrushes;
      if (found) done(found);
      else fail(new Error("The part of the page that brushes axes could not be loaded."));
    };
    script.onerror = () => {
      loading = null;
      fail(new Error("The studio does not answer. Is 'kerf studio' still running?"));
    };
    document.head.append(script);
  });
  return loading;
}
