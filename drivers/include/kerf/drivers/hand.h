#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kerf::drivers {

/// Place, speed and acceleration along a stroke of minimum jerk of unit length and unit duration at time s:
///
///     x = 10 s^3 - 15 s^4 + 6 s^5,   held at 0 before and at 1 after; the peak speed is 1.875 at s = 1/2
///
/// Source: [FlashHogan1985].
struct MinimumJerk {
  double position = 0.0;
  double speed = 0.0;
  static MinimumJerk at(double s) noexcept;
};

/// How a hand holds a device: a mass, and a spring and a damper to where the hand wants to be.
struct HandImpedance {
  double mass_kg = 0.0;
  double damping_n_s_per_m = 0.0;
  double stiffness_n_per_m = 0.0;
};

/// A stylus held as usual: within what Fu and Cavusoglu [FuCavusoglu2012] give, 0.1 to 0.2 kg, 2 to 8 N·s/m,
/// 200 to 600 N/m.
inline constexpr HandImpedance usual_grip{
    .mass_kg = 0.15, .damping_n_s_per_m = 5.0, .stiffness_n_per_m = 500.0};

/// What a hand wants to do with a pair of scissors, and how firmly it holds them.
struct HandOptions {
  double open_rad = 0.61;   ///< equilibrium angle when open, 35 deg
  double close_rad = 0.0;   ///< equilibrium angle when closed; the tissue keeps the hand from reaching it
  double stroke_s = 0.8;    ///< duration of an opening or a closing
  double pause_s = 0.25;    ///< between strokes
  double variation = 0.05;  ///< standard deviation of angles and durations from stroke to stroke, as a share
  double mass_kg = usual_grip.mass_kg;
  double damping_n_s_per_m = usual_grip.damping_n_s_per_m;
  double stiffness_n_per_m = usual_grip.stiffness_n_per_m;
  std::uint64_t seed = 1;
};

/// The equilibrium angle of a hand that opens and closes scissors along minimum-jerk strokes, with small
/// variations from stroke to stroke. Every stroke is drawn at construction: asking for an angle allocates
/// nothing.
class Strokes {
 public:
  struct Equilibrium {
    double angle_rad = 0.0;
    double speed_rad_s = 0.0;
  };

  explicit Strokes(const HandOptions& options);

  /// Where the hand wants to be at a time that does not go back from call to call.
  Equilibrium at(double time_s) noexcept;

 private:
  struct Stroke {
    double begin_s;
    double duration_s;
    double from_rad;
    double to_rad;
  };
  std::vector<Stroke> strokes_;
  std::size_t current_ = 0;
};

}  // namespace kerf::drivers
