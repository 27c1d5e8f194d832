#include "verbs/swept_recording.h"

#include <cstdint>

#include <kerf/psychophysics/random.h>

namespace kerf::bench {

std::vector<SweepInput> recording_inputs(const std::string& what_for) {
  using enum SweepInput::Kind;
  return {{.name = "recording", .kind = recording, .what = "Recording " + what_for, .required = true},
          {.name = "axis",
           .kind = text,
           .what = "Axis; where none is named that of the cycles, or the first",
           .standard = ""},
          {.name = "rows",
           .kind = text,
           .what = "Rows that count",
           .among = {"contact", "all"},
           .standard = "contact"},
          {.name = "cycles",
           .kind = text,
           .what = "Cycles that count: good, all, or 2-8,10",
           .standard = "good"}};
}

std::vector<SweepInput> noise_inputs() {
  return {{.name = "noise",
           .what = "Standard deviation of white noise that is added to the force",
           .unit = "N",
           .lower = 0,
           .standard = 0.0},
          {.name = "seed",
           .kind = SweepInput::Kind::whole,
           .what = "Seed of that noise",
           .lower = 0,
           .standard = 1.0}};
}

const schema::Recording& SweptRecording::of(const SweepCell& cell) {
  const std::string& name = cell.text("recording");
  if (name != name_) {
    recording_ = read_(folder_ / name);
    name_ = name;
  }
  const double noise_n = cell.number("noise");
  if (noise_n == 0.0) return recording_;
  noisy_ = recording_;
  psychophysics::Random random(static_cast<std::uint64_t>(cell.number("seed")));
  auto& force = noisy_.force_measured.empty() ? noisy_.force_commanded : noisy_.force_measured;
  for (double& value : force) value += noise_n * random.normal();
  return noisy_;
}

}  // namespace kerf::bench
