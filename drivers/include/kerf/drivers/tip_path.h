#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace kerf::drivers {

/// The path of a hand from waypoint to waypoint: it rests at each for a pause and goes straight to the next
/// along a stroke of minimum jerk, after the last one back to the first. A function of time alone.
class TipPath {
 public:
  struct Options {
    std::vector<Eigen::Vector3d> waypoints_m;  ///< at least one
    double stroke_s = 0.8;                     ///< > 0
    double pause_s = 0.25;                     ///< >= 0
  };
  struct Equilibrium {
    Eigen::Vector3d position_m;
    Eigen::Vector3d speed_m_s;
  };

  explicit TipPath(Options options) : options_(std::move(options)) {}

  [[nodiscard]] const Options& options() const noexcept { return options_; }
  [[nodiscard]] Equilibrium at(double time_s) const noexcept;

 private:
  Options options_;
};

/// Waypoints from a text, "0:0:0mm,30:-20:0mm" or in m. @throws DeviceError for anything else.
[[nodiscard]] std::vector<Eigen::Vector3d> parse_waypoints(std::string_view text);

/// 64 waypoints: the origin, then others no further from it than `reach_m` in each direction.
[[nodiscard]] std::vector<Eigen::Vector3d> drawn_waypoints(std::uint64_t seed, double reach_m);

}  // namespace kerf::drivers
