// Noise that masks the device, the same samples on every machine. Web Audio plays it in a loop.
"use strict";

// Linear congruential generator of 32 bits (Numerical Recipes), from -1 to 1.
function randomValues(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2147483648 - 1;
  };
}

// White, or pink by Voss and McCartney: row k of 16 is drawn anew every 2^k samples, and their sum falls by 3 dB an
// octave. Its mean is 0 and its root mean square 1.
function noiseSamples(kind, length, seed = 1) {
  const next = randomValues(seed);
  const samples = new Float32Array(length);
  const rows = Array.from({ length: 16 }, next);
  let sum = 0;
  let squares = 0;
  for (let i = 0; i < length; ++i) {
    let value = next();
    if (kind === "pink") {
      const row = i === 0 ? 15 : Math.min(15, 31 - Math.clz32(i & -i));
      rows[row] = next();
      for (const one of rows) value += one;
    }
    samples[i] = value;
    sum += value;
    squares += value * value;
  }
  const mean = sum / length;
  const rms = Math.sqrt(squares / length - mean * mean);
  for (let i = 0; i < length; ++i) samples[i] = (samples[i] - mean) / rms;
  return samples;
}

const noise_s = 20; // of the loop

// Plays at a level in dB of full scale (rms); a browser lets it sound after a click or a key only.
class NoisePlayer {
  constructor(kind) {
    this.context = new AudioContext();
    const length = Math.round(noise_s * this.context.sampleRate);
    const buffer = this.context.createBuffer(1, length, this.context.sampleRate);
    buffer.copyToChannel(noiseSamples(kind, length), 0);
    this.gain = this.context.createGain();
    this.gain.gain.value = 0;
    const source = this.context.createBufferSource();
    source.buffer = buffer;
    source.loop = true;
    source.connect(this.gain).connect(this.context.destination);
    source.start();
  }
  wake() {
    if (this.context.state === "suspended") this.context.resume();
  }
  get sounds() {
    return this.context.state === "running";
  }
  play(level_db) {
    this.gain.gain.setTargetAtTime(10 ** (level_db / 20), this.context.currentTime, 0.05);
  }
  stop() {
    this.gain.gain.setTargetAtTime(0, this.context.currentTime, 0.05);
  }
}

if (typeof module !== "undefined") module.exports = { noiseSamples };

globalThis.NoisePlayer = NoisePlayer; // for page.js
