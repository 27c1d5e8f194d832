#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>

namespace kerf::drivers {

/// A pose that a tool takes at a moment: one number an axis, in the unit of the axis [m or rad].
struct PoseKeyframe {
  double at_s = 0.0;
  Axes position{};
};

/// The path of a tool through keyframes of all its axes, at rest in each of them, with minimum jerk from one
/// to the next: with s = (t - t_i) / (t_{i+1} - t_i) and every axis by itself,
///
///     x = x_i + (x_{i+1} - x_i) (10 s^3 - 15 s^4 + 6 s^5)
///
/// After the last one it stays, or begins anew. A function of time alone that allocates nothing.
class PosePath {
 public:
  struct Options {
    std::vector<PoseKeyframe> keyframes;  ///< at least one, the first at 0 s, each later than the one before
    bool repeat = false;                  ///< after the last one from the first again, which is the same pose
  };
  struct Equilibrium {
    Axes position{};
    Axes velocity{};
  };

  /// @throws DeviceError for keyframes that are not as above.
  explicit PosePath(Options options);

  [[nodiscard]] const Options& options() const noexcept { return options_; }
  [[nodiscard]] Equilibrium at(double time_s) const noexcept;

 private:
  Options options_;
};

/// Keyframes of x, y, z, rx, ry, rz from a text, "0s:0:0:100mm:0:0:0deg,0.8s:0:-40:100mm:0:0:0deg", lengths
/// in mm or m, angles in deg or rad; and back, without loss. @throws DeviceError for anything else.
[[nodiscard]] std::vector<PoseKeyframe> parse_keyframes(std::string_view text);
[[nodiscard]] std::string to_text(const std::vector<PoseKeyframe>& keyframes);

}  // namespace kerf::drivers
