import FFT from "fft.js";

export interface Spectrum {
  step_hz: number; // from a line to the next; the first is 0 Hz
  amplitude: Float64Array; // in the unit of the values: of a sine its peak
}

/** The largest power of two that is not more. */
export function powerOfTwo(count: number): number {
  return count < 2 ? 0 : 2 ** Math.floor(Math.log2(count));
}

/**
 * Amplitude spectrum of the newest values, as many as a power of two, under a Hann window, without their mean. A value
 * that is missing counts as the one before.
 */
export function spectrumOf(values: ArrayLike<number>, period_s: number): Spectrum | null {
  const count = powerOfTwo(values.length);
  if (count < 16) return null;
  const first = values.length - count;
  const signal = new Array<number>(count);
  let [last, sum] = [0, 0];
  for (let k = 0; k < count; ++k) {
    const value = values[first + k]!;
    if (Number.isFinite(value)) last = value;
    signal[k] = last;
    sum += last;
  }
  const mean = sum / count;
  for (let k = 0; k < count; ++k) signal[k] = (signal[k]! - mean) * (0.5 - 0.5 * Math.cos((2 * Math.PI * k) / count));
  const fft = new FFT(count);
  const lines = fft.createComplexArray();
  fft.realTransform(lines, signal);
  const amplitude = new Float64Array(count / 2);
  // Of a sine of amplitude a half lies at either side, and the window's mean is a half.
  for (let k = 0; k < count / 2; ++k) amplitude[k] = (4 / count) * Math.hypot(lines[2 * k]!, lines[2 * k + 1]!);
  return { step_hz: 1 / (count * period_s), amplitude };
}

/** What lies below is the drift over the stretch, which its window spreads over the first lines. */
export const firstLine = 2;

/** The line with the largest amplitude, but for the first two, which hold drift. */
export function peakOf({ step_hz, amplitude }: Spectrum): { hz: number; amplitude: number } {
  let best = firstLine;
  for (let k = firstLine; k < amplitude.length; ++k) if (amplitude[k]! > amplitude[best]!) best = k;
  return { hz: best * step_hz, amplitude: amplitude[best] ?? 0 };
}
