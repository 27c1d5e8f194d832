import type { Figure, FigureCurve } from "../figure_description";
import { isLine } from "./draw";
import type { Frame } from "./frame";

/** A point of a figure's curve. */
export interface Found {
  curve: FigureCurve;
  at: number; // its place in the curve
}

const shown = (frame: Frame, { curve, at }: Found): { x: number; y: number } | null => {
  const [x, y] = [curve.x[at], curve.y[at]];
  if (x == null || y == null) return null;
  const place = { x: frame.x.at(x), y: frame.y.at(y) };
  const inside =
    place.x >= frame.left - 0.5 &&
    place.x <= frame.right + 0.5 &&
    place.y >= frame.top - 0.5 &&
    place.y <= frame.bottom + 0.5;
  return inside ? place : null; // not what is not finite either
};

/** Where it is drawn; null: nowhere in the frame. */
export { shown as placeOf };

/** The point nearest to a place of the plot, within a reach. */
export function nearest(figure: Figure, frame: Frame, x: number, y: number, reach: number): Found | null {
  let found: Found | null = null;
  let least = reach;
  for (const curve of figure.curves) {
    for (let at = 0; at < curve.x.length; ++at) {
      const place = shown(frame, { curve, at });
      if (!place) continue;
      const far = Math.hypot(place.x - x, place.y - y);
      if (far < least) [found, least] = [{ curve, at }, far];
    }
  }
  return found;
}

/** The next point of a curve that is seen, so many pixels of it further on where they lie close. */
export function along(frame: Frame, from: Found, way: 1 | -1): Found {
  const begin = shown(frame, from);
  let last = from;
  for (let at = from.at + way; at >= 0 && at < from.curve.x.length; at += way) {
    const next = { curve: from.curve, at };
    const place = shown(frame, next);
    if (!place) continue;
    last = next;
    if (!begin || Math.hypot(place.x - begin.x, place.y - begin.y) >= (isLine(from.curve) ? 4 : 0.01)) break;
  }
  return last;
}

/** The first point that is seen, of a curve or of those after it. */
export function first(figure: Figure, frame: Frame, from = 0): Found | null {
  for (let k = 0; k < figure.curves.length; ++k) {
    const curve = figure.curves[(from + k) % figure.curves.length]!;
    for (let at = 0; at < curve.x.length; ++at) if (shown(frame, { curve, at })) return { curve, at };
  }
  return null;
}

/** The point of the curve before or after that lies nearest above or below. */
export function beside(figure: Figure, frame: Frame, from: Found, way: 1 | -1): Found {
  const { curves } = figure;
  const x = from.curve.x[from.at];
  const own = curves.indexOf(from.curve);
  for (let k = 1; k < curves.length; ++k) {
    const curve = curves[(own + k * way + curves.length * k) % curves.length]!;
    let best: Found | null = null;
    let least = Infinity;
    for (let at = 0; at < curve.x.length; ++at) {
      const place = shown(frame, { curve, at });
      const far = place && x != null ? Math.abs(place.x - frame.x.at(x)) : Infinity;
      if (far < least) [best, least] = [{ curve, at }, far];
    }
    if (best) return best;
  }
  return from;
}
