#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "laws/law_file.h"
#include "laws/sampled_motion.h"

namespace kerf::bench {

/// Stays in one place.
struct Rest {
  double at = 0.0;
};
/// To and fro with minimum jerk, a pause before every stroke.
struct StrokesToAndFro {
  double from = 0.0;
  double to = 0.0;
  double stroke_s = 0.4;
  double pause_s = 0.1;
};
/// x = centre + amplitude sin(2 pi f t + phase)
struct Sine {
  double centre = 0.0;
  double amplitude = 0.0;
  double frequency_hz = 1.0;
  double phase_rad = 0.0;
};
/// Rests, goes at constant speed, holds, and goes back if there is time for it.
struct RampAndHold {
  double from = 0.0;
  double to = 0.0;
  double start_s = 0.1;
  double ramp_s = 0.2;
  double hold_s = 0.4;
};

/// What one axis of a motion does. Positions in the axis' own unit.
struct ScriptedAxis {
  std::size_t axis = 0;  ///< of the law's
  std::variant<Rest, StrokesToAndFro, Sine, RampAndHold> script;
};

/// A motion that laws are rendered along, which no force disturbs: that of a recording, of a scene's script,
/// or one given axis by axis.
struct MotionSource {
  std::filesystem::path recording;
  std::filesystem::path scene;
  std::vector<ScriptedAxis> axes;
  double rate_hz = 1000.0;        ///< of what is scripted; a recording has its own
  std::optional<double> seconds;  ///< of one given axis by axis without it 1; of the others all there is
};

/// The motion on the axes of a law, in their own frame. @throws std::invalid_argument: a recording without
/// the law's axes, in other units or with a sample that is not finite; a scene without a script.
[[nodiscard]] SampledMotion sampled(const MotionSource& source, const LawFile& law);
/// The same on axes by their names, without a law. @throws also for a scene, whose tool is placed by a law.
[[nodiscard]] SampledMotion sampled(const MotionSource& source, const std::vector<models::LawAxis>& axes);

}  // namespace kerf::bench
