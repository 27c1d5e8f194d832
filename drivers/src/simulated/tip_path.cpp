#include "kerf/drivers/tip_path.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "kerf/drivers/device.h"
#include "kerf/drivers/gaussian.h"
#include "kerf/drivers/hand.h"

namespace kerf::drivers {
namespace {

constexpr std::size_t waypoints_drawn = 64;

[[noreturn]] void refuse_waypoint(std::string_view waypoint) {
  throw DeviceError("waypoint '" + std::string(waypoint) +
                    "': expected X:Y:Z with the unit mm or m, joined by ',', such as 0:0:0mm,30:-20:0mm");
}

Eigen::Vector3d parse_waypoint(std::string_view text) {
  Eigen::Vector3d place;
  const char* from = text.data();
  const char* const end = text.data() + text.size();
  for (int at = 0; at < 3; ++at) {
    if (at > 0 && (from == end || *from++ != ':')) refuse_waypoint(text);
    const auto [stop, error] = std::from_chars(from, end, place[at]);
    if (error != std::errc{} || !(std::abs(place[at]) <= 1e6)) refuse_waypoint(text);
    from = stop;
  }
  const std::string_view unit(from, static_cast<std::size_t>(end - from));
  if (unit == "mm") return 1e-3 * place;
  if (unit != "m") refuse_waypoint(text);
  return place;
}

}  // namespace

TipPath::Equilibrium TipPath::at(double time_s) const noexcept {
  const std::vector<Eigen::Vector3d>& waypoints = options_.waypoints_m;
  const double leg_s = options_.pause_s + options_.stroke_s;
  const double legs = std::floor(std::max(0.0, time_s) / leg_s);
  const auto leg = static_cast<std::size_t>(legs);
  const Eigen::Vector3d& from = waypoints[leg % waypoints.size()];
  const Eigen::Vector3d travel = waypoints[(leg + 1) % waypoints.size()] - from;
  const MinimumJerk motion = MinimumJerk::at((time_s - legs * leg_s - options_.pause_s) / options_.stroke_s);
  return {.position_m = from + motion.position * travel,
          .speed_m_s = motion.speed / options_.stroke_s * travel};
}

std::vector<Eigen::Vector3d> parse_waypoints(std::string_view text) {
  std::vector<Eigen::Vector3d> waypoints;
  while (true) {
    const auto comma = std::min(text.find(','), text.size());
    waypoints.push_back(parse_waypoint(text.substr(0, comma)));
    if (comma == text.size()) return waypoints;
    text.remove_prefix(comma + 1);
  }
}

std::vector<Eigen::Vector3d> drawn_waypoints(std::uint64_t seed, double reach_m) {
  Gaussian random(seed);
  std::vector<Eigen::Vector3d> waypoints{Eigen::Vector3d::Zero()};
  while (waypoints.size() < waypoints_drawn) {
    Eigen::Vector3d place;
    for (int at = 0; at < 3; ++at) place[at] = reach_m * std::clamp(0.5 * random(), -1.0, 1.0);
    waypoints.push_back(place);
  }
  return waypoints;
}

}  // namespace kerf::drivers
