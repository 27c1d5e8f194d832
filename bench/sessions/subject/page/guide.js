// What leads the hand: a target that moves in step with the loop, or a beat. Where it is comes from the server, which
// reads it off the running loop; nothing here knows of samples.
"use strict";

const beat_flash_ms = 120;
const click_s = 0.03;
const click_ahead_s = 0.25; // clicks are handed to Web Audio so early
const clock_lasts_ms = 5000; // then the clocks are compared anew

// How the loop's clock lies to performance.now(): by the answer that took the least time.
class GuideClock {
  constructor() {
    this.best = null;
  }
  take(asked_ms, answered_ms, time_s) {
    const took_ms = answered_ms - asked_ms;
    const is_old = !this.best || answered_ms - this.best.at_ms > clock_lasts_ms;
    if (is_old || took_ms <= this.best.took_ms)
      this.best = { at_ms: answered_ms, took_ms, ahead_ms: 1000 * time_s - (asked_ms + answered_ms) / 2 };
  }
  // Milliseconds on the loop's clock; NaN before the first answer.
  at(now_ms) {
    return this.best ? now_ms + this.best.ahead_ms : NaN;
  }
}

// The beats from one moment to another, on the loop's clock [ms]: those at 0, 1, 2 ... cycles.
function beatsBetween(from_ms, to_ms, cycle_s) {
  const cycle_ms = 1000 * cycle_s;
  const beats = [];
  for (let number = Math.ceil(from_ms / cycle_ms); number * cycle_ms < to_ms; ++number) beats.push(number);
  return beats;
}

class GuidePanel {
  constructor(panel, ask) {
    this.panel = panel;
    this.part = (name) => panel.querySelector(`.${name}`);
    this.ask = ask;
    this.guide = null;
    this.clock = new GuideClock();
    this.asking = false;
    this.moving = false;
    this.clicked = -1; // the last beat that was handed to Web Audio
    this.context = null;
  }
  // `guide` of a view; null: there is none.
  follow(guide, stage) {
    this.guide = guide;
    const is_seen = Boolean(guide) && (stage === "trial" || stage === "ready");
    this.panel.hidden = !is_seen;
    // Its place stays while it does not lead, so that nothing moves about.
    this.panel.classList.toggle("rests", is_seen && !guide.leads);
    this.panel.parentElement.classList.toggle("led", is_seen); // the rest is lower then
    if (!is_seen) return;
    this.part("track").hidden = !guide.target;
    this.part("beat").hidden = guide.target;
    this.part("tool").hidden = !guide.tool;
    this.part("for_target").hidden = !guide.target || !guide.tool;
    this.part("for_target_alone").hidden = !guide.target || guide.tool;
    this.part("for_beat").hidden = guide.target;
    if (guide.leads && !this.moving) {
      this.moving = true;
      requestAnimationFrame(() => this.frame());
    }
  }
  // At a click or a key, before which no browser lets it sound.
  wake() {
    if (!this.guide || !this.guide.clicks) return;
    this.context = this.context || new AudioContext();
    if (this.context.state === "suspended") this.context.resume();
  }
  frame() {
    if (!this.guide || !this.guide.leads || this.panel.hidden) {
      this.moving = false;
      return;
    }
    if (!this.asking) this.look();
    if (!this.guide.target) this.beat();
    requestAnimationFrame(() => this.frame());
  }
  async look() {
    this.asking = true;
    const asked_ms = performance.now();
    try {
      const now = await this.ask();
      if (now) {
        this.clock.take(asked_ms, performance.now(), now.time_s);
        if (this.guide && this.guide.target) this.draw(now);
      }
    } finally {
      this.asking = false;
    }
  }
  draw(now) {
    const place = (name, share) => {
      const mark = this.part(name);
      mark.classList.toggle("unknown", share === null);
      // A tool far outside stays at the edge.
      if (share !== null) mark.style.setProperty("--share", String(Math.min(1.12, Math.max(-0.12, share))));
    };
    place("target", now.target);
    if (this.guide.tool) place("tool", now.tool);
  }
  beat() {
    const now_ms = this.clock.at(performance.now());
    if (Number.isNaN(now_ms)) return;
    const since_ms = now_ms % (1000 * this.guide.cycle_s);
    this.part("beat").classList.toggle("sounds", since_ms >= 0 && since_ms < beat_flash_ms);
    if (!this.guide.clicks || !this.context || this.context.state !== "running") return;
    for (const number of beatsBetween(now_ms, now_ms + 1000 * click_ahead_s, this.guide.cycle_s)) {
      if (number <= this.clicked) continue;
      this.clicked = number;
      this.click(this.context.currentTime + (number * this.guide.cycle_s - now_ms / 1000));
    }
  }
  click(at_s) {
    const tone = this.context.createOscillator();
    const level = this.context.createGain();
    tone.frequency.value = 1000;
    level.gain.setValueAtTime(0.25, at_s);
    level.gain.exponentialRampToValueAtTime(0.001, at_s + click_s);
    tone.connect(level).connect(this.context.destination);
    tone.start(at_s);
    tone.stop(at_s + click_s);
  }
}

if (typeof module !== "undefined") module.exports = { GuideClock, beatsBetween };

globalThis.GuidePanel = GuidePanel; // for page.js
