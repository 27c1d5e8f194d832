#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

// What leads the hand of a subject, the same for every sample. It runs with the clock of the loop, from the
// beginning of a run, and every trial that it leads begins with one of its cycles.

namespace kerf::bench {

enum class GuideKind : std::uint8_t {
  metronome,  ///< a beat, seen and heard
  strokes,    ///< a target that goes to and fro with minimum jerk, a pause before every stroke
  sine,       ///< a target that goes to and fro as a sine, from one end
};
enum class GuideWhen : std::uint8_t { both, practice, trials };

/// A virtual coupling to the target that the hand feels, in the units of the laws' axis:
///
///     F = k (x_t - x) + b (v_t - v),   held between -F_max and F_max
struct FeltGuide {
  double stiffness = 0.0;  ///< k, > 0
  double damping = 0.0;    ///< b, >= 0
  double limit = 0.0;      ///< F_max, > 0
};

struct GuideTarget {
  double position = 0.0;
  double speed = 0.0;
};

/// [guide] of a protocol.
struct GuidedMotion {
  GuideKind kind = GuideKind::metronome;
  double beat_s = 1.0;  ///< of a metronome
  bool clicks = true;   ///< a metronome is heard too
  double from = 0.0;    ///< of a target, where its cycle begins, on the laws' axis
  double to = 0.0;
  double stroke_s = 0.8;
  double pause_s = 0.25;
  double frequency_hz = 0.0;  ///< of a sine
  bool shows_tool = true;     ///< beside the target
  std::optional<FeltGuide> felt;
  GuideWhen when = GuideWhen::both;
  std::string position_unit;  ///< of the laws' axis; empty of a metronome
  std::string force_unit;

  [[nodiscard]] bool has_target() const noexcept { return kind != GuideKind::metronome; }
  /// A beat, or the way there and back.
  [[nodiscard]] double cycle_s() const noexcept;
  [[nodiscard]] bool leads(bool practice) const noexcept;
  /// Of a target, from 0 s on.
  [[nodiscard]] GuideTarget at(double time_s) const noexcept;
  /// From 0, the target's beginning, to 1, its other end; of a place beyond them less or more.
  [[nodiscard]] double share_of_way(double position) const noexcept {
    return (position - from) / (to - from);
  }
  /// What the hand is pulled with [the axis' unit]; 0 where nothing is felt.
  [[nodiscard]] double pull(const GuideTarget& target, double position, double speed) const noexcept;
};

/// What of the loop a subject's page shows: when, on the guide's clock, and where the tool was then.
struct GuideLook {
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< NaN: the loop does not run yet
  double position = std::numeric_limits<double>::quiet_NaN();
};

/// "a target that goes from 0.558 to 0.14 rad and back, ...": what a methods section says.
[[nodiscard]] std::string in_words(const GuidedMotion& guide);

}  // namespace kerf::bench
