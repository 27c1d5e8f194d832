#include "stability/study.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "laws/placement.h"
#include "stability/controllers/compare_controllers.h"
#include "stability/controllers/controllers_findings.h"
#include "stability/device/known_device.h"
#include "stability/plane/plane_findings.h"
#include "stability/several/several_findings.h"
#include "stability/wall/wall_theory.h"
#include "stability/zwidth/z_width_findings.h"

namespace kerf::bench {
namespace {

Range range_of(const std::vector<double>& given, const char* option, Range standard, bool from_zero) {
  if (given.empty()) return standard;
  if (!(given[0] < given[1]) || !(from_zero ? given[0] >= 0.0 : given[0] > 0.0)) {
    throw std::invalid_argument(fmt::format("{} {} {}: expected a lower and a greater upper end, {}", option,
                                            given[0], given[1],
                                            from_zero ? "not negative" : "greater than 0"));
  }
  return {given[0], given[1]};
}

StudiedAxis studied(const StudyOptions& options, const drivers::DeviceInfo& info, std::size_t axis) {
  return {.device_uri = options.on.device_uri,
          .axis = info.axes[axis].name,
          .grip = options.on.grip,
          .way = options.on.way,
          .units = TravelUnits(info.axes[axis])};
}

/// A law along its line, and the axis of the device whose mass and friction are taken.
std::pair<AxisLaw, std::size_t> placed_law(const LawFile& file, const std::string& name,
                                           const AxisRequest& on, const drivers::DeviceInfo& info) {
  if (file.law.is_spatial()) {
    const PlacedWay placed = place_way(on.way, file, info);
    const std::size_t axis = on.axis.empty() ? placed.device_axis : requested_axis(on, info);
    return {{.law = file.law, .way = placed.way}, axis};
  }
  if (!on.way.along.empty() || !on.way.from.empty()) {
    throw std::invalid_argument(fmt::format(
        "{}: law '{}' has one axis, and --along and --from are of several", name, file.law.model()));
  }
  const std::size_t axis = on.axis.empty() ? axis_for(file, info) : requested_axis(on, info);
  return {{.law = file.law, .lever = info.axes[axis].lever}, axis};
}

}  // namespace

Findings study_walls(const StudyOptions& options) {
  const KnownDevice known(options.on);
  const drivers::DeviceInfo& info = known.info;
  const std::size_t axis = requested_axis(options.on, info);
  const SampledDevice device = requested_device(options.on, info, axis);
  Grid2 grid = wall_grid(device, options.cells, options.cells);
  const Range stiffness =
      range_of(options.stiffness_n_per_m, "--stiffness", {grid.first.front(), grid.first.back()}, false);
  const Range damping =
      range_of(options.damping_n_s_per_m, "--damping", {grid.second.front(), grid.second.back()}, true);
  grid = {.first = logarithmic(stiffness.begin, stiffness.end, options.cells),
          .second = linear(damping.begin, damping.end, options.cells)};
  Findings findings =
      findings_of(wall_map(device, options.trial, grid, options.map), studied(options, info, axis));
  known.tell(findings);
  return findings;
}

Findings study_plane(const StudyOptions& options) {
  const KnownDevice known(options.on);
  const drivers::DeviceInfo& info = known.info;
  const std::size_t axis = requested_axis(options.on, info);
  const SampledDevice device = requested_device(options.on, info, axis);
  std::vector<double> walls = options.wall_n_per_m;
  if (walls.empty()) {
    const double passive = colgate_schenkel(device, 0.0);
    if (!(passive > 0.0)) {
      throw std::invalid_argument(
          fmt::format("{}: axis '{}' has no viscous friction, which places a wall in the plane; give --wall",
                      info.uri, info.axes[axis].name));
    }
    walls = {passive, 0.25 * passive, 4.0 * passive};
  }
  for (const double stiffness : walls) {
    if (!(stiffness > 0.0) || !std::isfinite(stiffness)) {
      throw std::invalid_argument(
          fmt::format("--wall {}: expected a stiffness greater than 0 N/m", stiffness));
    }
  }
  const std::size_t cells = std::min(options.cells, max_plane_cells);
  Findings findings = findings_of(plane_map(device, walls, cells, options.plane_trial, options.map),
                                  studied(options, info, axis));
  known.tell(findings);
  return findings;
}

Findings study_several(const StudyOptions& options) {
  const SeveralAxes several = several_axes(options.several, options.on);
  const Range searched = range_of(options.stiffness_n_per_m, "--stiffness", {1.0, 1e6}, false);
  StudiedAxis on{.device_uri = several.of, .axis = {}, .grip = options.on.grip, .way = options.on.way};
  const std::size_t directions = std::min(options.cells, max_directions);
  return findings_of(direction_map(several.axes, several.shape, directions, searched, options.map), on);
}

namespace {

/// Half of the interval of a number that was measured, all of the number where the interval has no end;
/// `otherwise` where none was.
double half_interval(const drivers::Known& known, double otherwise) {
  if (!known) return otherwise;
  const double half = 0.5 * (known->upper - known->lower);
  return std::isfinite(half) ? half : std::abs(known->value);
}
double share(const drivers::Known& known, double otherwise) {
  return known && known->value > 0.0 ? half_interval(known, otherwise) / known->value : otherwise;
}

/// The model of an axis, as uncertain as a model of the device says that was taken, else as somebody gave;
/// none where its mass and friction are neither known nor given.
std::optional<UncertainModel> model_of(const StudyOptions& options, const KnownDevice& known,
                                       std::size_t axis) {
  const AxisRequest& on = options.on;
  const drivers::AxisInfo& about = known.info.axes[axis];
  if (!about.mechanics && !(on.mass_kg && on.viscous_n_s_per_m && on.coulomb_n)) return std::nullopt;
  const double given = options.z_width.model_error;
  UncertainModel model{.device = requested_device(on, known.info, axis),
                       .mass = given,
                       .viscous = given,
                       .coulomb = given,
                       .hand = given};
  const drivers::AxisModel* const measured =
      known.model && given == 0.0 ? known.model->from.model.axis(about.name) : nullptr;
  if (measured == nullptr) return model;
  if (!on.mass_kg) model.mass = share(measured->mass, 0.0);
  if (!on.viscous_n_s_per_m) model.viscous = share(measured->viscous, 0.0);
  if (!on.coulomb_n) model.coulomb = share(measured->coulomb_up, 0.0);
  if (!on.delay_s) model.delay_s = half_interval(measured->delay, 0.0);
  if (options.z_width.fresh_model && measured->hand_stiffness) {
    // Its mass and damping are in those of the device.
    model.device.hand = {.stiffness_n_per_m = measured->hand_stiffness->value};
    model.hand = share(measured->hand_stiffness, 0.0);
  }
  return model;
}

/// The search that is asked for, over these dampings.
WallSearchOptions search_of(const StudyOptions& options, std::vector<double> damping) {
  WallSearchOptions search = options.z_width.search;
  search.damping_n_s_per_m = std::move(damping);
  const Range stiffness = range_of(options.stiffness_n_per_m, "--stiffness",
                                   {search.softest_n_per_m, search.stiffest_n_per_m}, false);
  search.softest_n_per_m = stiffness.begin;
  search.stiffest_n_per_m = stiffness.end;
  check(search, 1.0 / options.on.rate_hz);
  return search;
}

}  // namespace

WallSearchOptions z_width_search(const StudyOptions& options) {
  constexpr double most_damping = 10.0;
  const Range damping = range_of(options.damping_n_s_per_m, "--damping", {0.0, most_damping}, true);
  return search_of(options, linear(damping.begin, damping.end, options.z_width.rungs));
}

Findings study_z_width(const StudyOptions& options, const std::atomic<bool>& stop) {
  const WallSearchOptions search = z_width_search(options);
  const std::optional<ModelFile>& fresh = options.z_width.fresh_model;
  const KnownDevice known = fresh ? KnownDevice(options.on, *fresh) : KnownDevice(options.on);
  const ZWidth measured = measure_z_width(options.on.device_uri,
                                          {.search = search,
                                           .axis = options.on.axis,
                                           .rate_hz = options.on.rate_hz,
                                           .progress = options.z_width.progress},
                                          stop);
  const std::optional<UncertainModel> model = model_of(options, known, measured.axis);
  std::vector<ZWidthTheory> theory;
  if (model) theory = z_width_theory(*model, measured.options, options.z_width.draws, options.map.threads);
  Findings findings = findings_of(measured, theory, model, studied(options, measured.device, measured.axis));
  known.tell(findings);
  return findings;
}

Findings study_controllers(const StudyOptions& options, const std::atomic<bool>& stop) {
  std::vector<double> dampings{0.0};
  if (!options.damping_n_s_per_m.empty()) {
    const Range damping = range_of(options.damping_n_s_per_m, "--damping", {}, true);
    dampings = linear(damping.begin, damping.end, options.z_width.rungs);
  }
  if (options.wall_n_per_m.size() > 1)
    throw std::invalid_argument("--controllers compares them on one wall; give one --wall");
  const double wall = options.wall_n_per_m.empty() ? 0.0 : options.wall_n_per_m.front();
  if (!options.wall_n_per_m.empty() && !(wall > 0.0 && std::isfinite(wall)))
    throw std::invalid_argument(fmt::format("--wall {}: expected a stiffness greater than 0 N/m", wall));
  const KnownDevice known(options.on);
  const std::size_t axis = requested_axis(options.on, known.info);
  const SampledDevice model = requested_device(options.on, known.info, axis);
  const ControllersOptions compared{.z_width = {.search = search_of(options, std::move(dampings)),
                                                .axis = options.on.axis,
                                                .rate_hz = options.on.rate_hz,
                                                .progress = options.z_width.progress},
                                    .transparency = {.least_push_n = options.z_width.search.strike_n,
                                                     .stop_n = options.z_width.search.stop_n,
                                                     .sensor_at_hand = options.sensor_at_hand},
                                    .wall_n_per_m = wall};
  Findings findings = findings_of(compare_controllers(options.on.device_uri, model, compared, stop),
                                  studied(options, known.info, axis));
  known.tell(findings);
  return findings;
}

LawFindings study_law(const LawFile& file, const std::string& name, const StudyOptions& options) {
  constexpr double search = 10.0;  // times the depth that was given
  const KnownDevice known(options.on);
  const drivers::DeviceInfo& info = known.info;
  const auto [law, axis] = placed_law(file, name, options.on, info);
  const SampledDevice device = requested_device(options.on, info, axis);
  const ToolRange& range = options.range;
  const std::size_t cells = std::min(options.cells, max_law_cells);
  const double rate_hz = options.on.rate_hz;
  const Grid2 grid{
      .first = linear(2.0 * range.depth_m / static_cast<double>(cells), 2.0 * range.depth_m, cells),
      .second = logarithmic(0.05 * rate_hz, 10.0 * rate_hz, cells)};
  LawStudy study{.model = std::string(file.law.model()),
                 .law = law,
                 .device = device,
                 .range = range,
                 .limits = limits_of(device, law, range, search * range.depth_m),
                 .map = law_map(device, law, range.speed_m_s, grid, options.map),
                 .met = is_met(law, range, device.period_s),
                 .passive = is_passive(device, law, range),
                 .worst = worst_stroke(device, law, range)};
  if (study.met && device.hand.stiffness_n_per_m > 0.0)
    study.pressed = press(device, law, {.depth_m = range.depth_m});
  Findings findings = findings_of(study, studied(options, info, axis));
  known.tell(findings);
  return {.findings = std::move(findings),
          .holds = study.met && study.passive && (!study.pressed || study.pressed->stable)};
}

}  // namespace kerf::bench
