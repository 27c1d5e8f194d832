#include "stability/plane/plane.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fmt/core.h>

#include "plot/plot.h"
#include "stability/wall/wall_force.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

/// What one start came to.
enum class Course : std::uint8_t { ended, goes_on, grew };

struct CourseOfWall {
  Course course = Course::ended;
  double ripple_n = 0.0;  ///< of the wall's force over the last quarter
};

/// Of one quarter of the time.
struct Swing {
  double position = 0.0, position_squared = 0.0, force = 0.0, force_squared = 0.0;
  double ticks = 0.0;
  void add(double position_m, double force_n) noexcept {
    position += position_m;
    position_squared += position_m * position_m;
    force += force_n;
    force_squared += force_n * force_n;
    ticks += 1.0;
  }
  [[nodiscard]] double variance() const noexcept {
    const double mean = position / ticks;
    return std::max(0.0, position_squared / ticks - mean * mean);
  }
  [[nodiscard]] double ripple_n() const noexcept {
    const double mean = force / ticks;
    return std::sqrt(std::max(0.0, force_squared / ticks - mean * mean));
  }
};

/// Ticks after which a motion that lies a twentieth beside a line has halved or doubled: its amplitude
/// changes by exp(-pi w T d) a swing at a distance d from the line, and a swing has 2 pi / w T ticks.
std::size_t ticks_of(const SampledDevice& device, double stiffness) {
  constexpr double least = 1000.0;
  constexpr double most = 30'000.0;
  const double alpha = stiffness * device.period_s * device.period_s / device.moving_mass_kg();
  return static_cast<std::size_t>(std::clamp(28.0 / alpha, least, most));
}

CourseOfWall course_of(const SampledDevice& device, const std::shared_ptr<const DeviceMotion>& moves,
                       double stiffness, double start_m, double lost_m) {
  const std::size_t quarter = ticks_of(device, stiffness) / 4;
  const double push_n = 0.5 * stiffness * device.encoder_step_m;
  const double balance_m = push_n / (stiffness + device.hand.stiffness_n_per_m);
  SampledLoop<WallForce> loop(device, moves,
                              WallForce{.wall = {.stiffness_n_per_m = stiffness}, .one_sided = false},
                              {.position_m = balance_m + start_m});
  Swing second;
  Swing last;
  for (int part = 0; part < 4; ++part) {
    bool moved = false;
    for (std::size_t tick = 0; tick < quarter; ++tick) {
      loop.step(push_n);
      const double position_m = loop.motion().position_m;
      moved = moved || loop.motion().speed_m_s != 0.0;
      if (!(std::abs(position_m) < lost_m)) return {.course = Course::grew, .ripple_n = 0.0};
      if (part == 1) second.add(position_m, loop.held_n());
      if (part == 3) last.add(position_m, loop.held_n());
    }
    if (!moved) return {};
  }
  const double ratio = last.variance() / second.variance();
  // What moves within two steps is as small as it gets without coming to rest.
  const double smallest_m = 2.0 * device.encoder_step_m;
  const bool is_smallest = last.variance() < smallest_m * smallest_m;
  const Course course = is_smallest   ? Course::goes_on
                        : ratio < 0.5 ? Course::ended
                        : ratio > 2.0 ? Course::grew
                                      : Course::goes_on;
  return {.course = course, .ripple_n = last.ripple_n()};
}

}  // namespace

PlanePoint plane_point(const SampledDevice& device, double stiffness) noexcept {
  return {.viscous = device.viscous_n_s_per_m / (stiffness * device.period_s),
          .coulomb = device.encoder_step_m > 0.0 ? device.coulomb_n / (stiffness * device.encoder_step_m)
                                                 : std::numeric_limits<double>::infinity()};
}

SampledDevice device_at(PlanePoint point, const SampledDevice& device, double stiffness) {
  SampledDevice there = device;
  there.viscous_n_s_per_m = point.viscous * stiffness * device.period_s;
  there.coulomb_n = point.coulomb * stiffness * device.encoder_step_m;
  return there;
}

PlaneLines plane_lines(const SampledDevice& device) noexcept {
  return {.viscous = 0.5 + device.delay_s / device.period_s, .coulomb = 0.5};
}

PlaneRegion plane_region(PlanePoint point, PlaneLines lines) noexcept {
  const bool viscous = point.viscous >= lines.viscous;
  const bool coulomb = point.coulomb >= lines.coulomb;
  if (viscous) return coulomb ? PlaneRegion::passive : PlaneRegion::bounded_cycle;
  return coulomb ? PlaneRegion::locked : PlaneRegion::unstable;
}

std::string_view name_of(PlaneRegion region) noexcept {
  switch (region) {
    case PlaneRegion::passive:
      return "passive";
    case PlaneRegion::bounded_cycle:
      return "limit cycle bounded by quantisation";
    case PlaneRegion::locked:
      return "locked by Coulomb friction";
    case PlaneRegion::unstable:
      break;
  }
  return "unstable";
}

std::string_view name_of(PlaneBehaviour behaviour) noexcept {
  switch (behaviour) {
    case PlaneBehaviour::dies_away:
      return "dies away";
    case PlaneBehaviour::locked:
      return "dies away from near, grows from far";
    case PlaneBehaviour::small_cycle:
      return "limit cycle below what is felt";
    case PlaneBehaviour::cycle:
      return "limit cycle";
    case PlaneBehaviour::grows:
      break;
  }
  return "grows";
}

PlaneBehaviour plane_behaviour_named(std::string_view name) {
  for (const PlaneBehaviour behaviour : plane_behaviours) {
    if (name_of(behaviour) == name) return behaviour;
  }
  throw std::invalid_argument(fmt::format("'{}' is no behaviour of a wall: expected '{}', ... or '{}'", name,
                                          name_of(PlaneBehaviour::dies_away),
                                          name_of(PlaneBehaviour::grows)));
}

bool agree(PlaneBehaviour behaviour, PlaneRegion region) noexcept {
  switch (region) {
    case PlaneRegion::passive:
      return behaviour == PlaneBehaviour::dies_away;
    case PlaneRegion::bounded_cycle:
      return behaviour == PlaneBehaviour::small_cycle || behaviour == PlaneBehaviour::cycle;
    case PlaneRegion::locked:
      return behaviour == PlaneBehaviour::locked;
    case PlaneRegion::unstable:
      break;
  }
  return behaviour == PlaneBehaviour::grows;
}

double swing_line(const SampledDevice& device, double stiffness, double coulomb,
                  double amplitude_steps) noexcept {
  const double w_t =
      device.period_s * std::sqrt((stiffness + device.hand.stiffness_n_per_m) / device.moving_mass_kg());
  return plane_lines(device).viscous - 4.0 * coulomb / (std::numbers::pi * w_t * amplitude_steps);
}

PlaneBehaviour plane_behaviour(const SampledDevice& device, double stiffness, const PlaneTrial& trial) {
  check(device);
  if (!(device.encoder_step_m > 0.0)) {
    throw std::invalid_argument(
        "the plane is drawn in steps of the encoder, and the device has none; give --encoder");
  }
  constexpr double lost = 4.0;  // times the far start
  const double step_m = device.encoder_step_m;
  const auto moves = std::make_shared<const DeviceMotion>(device);
  const auto from = [&](double steps) {
    return course_of(device, moves, stiffness, steps * step_m, lost * trial.far_steps * step_m);
  };
  const CourseOfWall near = from(trial.near_steps);
  const CourseOfWall far = from(trial.far_steps);
  if (far.course == Course::grew)
    return near.course == Course::ended ? PlaneBehaviour::locked : PlaneBehaviour::grows;
  if (near.course == Course::ended) return PlaneBehaviour::dies_away;
  return near.ripple_n > trial.felt_n ? PlaneBehaviour::cycle : PlaneBehaviour::small_cycle;
}

double PlaneMap::agreement() const {
  if (cells.empty()) return 1.0;
  const PlaneLines lines = plane_lines(device);
  const std::size_t columns = grid.first.size();
  std::size_t agreeing = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const PlanePoint at{.viscous = grid.first[i % columns], .coulomb = grid.second[i / columns]};
    if (agree(cells[i], plane_region(at, lines))) ++agreeing;
  }
  return static_cast<double>(agreeing) / static_cast<double>(cells.size());
}

PlaneMap plane_map(const SampledDevice& device, std::span<const double> stiffnesses, std::size_t cells,
                   const PlaneTrial& trial, const MapOptions& options) {
  constexpr double least = 0.05;
  constexpr double most = 5.0;
  if (stiffnesses.empty()) throw std::invalid_argument("the plane is drawn for walls; give --wall");
  PlaneMap map{.device = device,
               .stiffness_n_per_m = stiffnesses.front(),
               .trial = trial,
               .grid = {},
               .cells = {},
               .walls = {}};
  Range viscous{.begin = least, .end = most};
  Range coulomb = viscous;
  const auto reach = [](Range& range, double value) {
    if (!(value > 0.0)) return;
    range.begin = std::min(range.begin, 0.8 * value);
    range.end = std::max(range.end, 1.25 * value);
  };
  for (const double stiffness : stiffnesses) {
    const PlanePoint at = plane_point(device, stiffness);
    reach(viscous, at.viscous);
    reach(coulomb, at.coulomb);
    map.walls.push_back(
        {.stiffness_n_per_m = stiffness, .at = at, .behaviour = plane_behaviour(device, stiffness, trial)});
  }
  reach(viscous, 2.0 * plane_lines(device).viscous);
  map.grid = {.first = logarithmic(viscous.begin, viscous.end, cells),
              .second = logarithmic(coulomb.begin, coulomb.end, cells)};
  if (!options.with_cells) return map;
  map.cells.resize(cells * cells);
  const auto is_stopped = [&] { return options.stop != nullptr && *options.stop; };
  for_each_index(cells, options.threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < cells && !is_stopped(); ++column) {
      const PlanePoint at{.viscous = map.grid.first[column], .coulomb = map.grid.second[row]};
      map.cells[row * cells + column] =
          plane_behaviour(device_at(at, device, map.stiffness_n_per_m), map.stiffness_n_per_m, trial);
    }
    if (options.done != nullptr) ++*options.done;
  });
  if (is_stopped())
    throw std::system_error(std::make_error_code(std::errc::interrupted), "the map is not complete");
  return map;
}

}  // namespace kerf::bench
