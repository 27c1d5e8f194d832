#include "stability/controllers/compare_controllers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "run/run.h"
#include "stability/controllers/controlled_theory.h"
#include "stability/controllers/controller_cost.h"

namespace kerf::bench {
namespace {

ControllerTheory theory_of(const ControllerDesign& design, const SampledDevice& model,
                           const WallSearchOptions& search) {
  ControllerTheory theory;
  for (const double damping : search.damping_n_s_per_m) {
    theory.boundary_n_per_m.push_back(
        controlled_boundary(design, model, damping, search.softest_n_per_m, search.stiffest_n_per_m));
    theory.passive_n_per_m.push_back(controlled_passive(design, damping, search.stiffest_n_per_m));
  }
  return theory;
}

/// What a controller holds at the first damping, all that the search looked at included.
double held_by(const ComparedController& one) {
  return one.z_width.ladder.empty() ? 0.0 : one.z_width.ladder.front().held_n_per_m;
}

/// Half of the stiffest wall that all of them hold that hold any.
double wall_for_all(const std::vector<ComparedController>& controllers) {
  double least = std::numeric_limits<double>::infinity();
  for (const ComparedController& one : controllers) {
    if (held_by(one) > 0.0) least = std::min(least, held_by(one));
  }
  return std::isfinite(least) ? 0.5 * least : 0.0;
}

bool tells_something(const TransparencyTrial& trial) {
  return std::ranges::all_of(trial.records(), [](const TransparencyRecord& record) {
    return std::ranges::all_of(record.sensor_n, [](double f) { return std::isfinite(f); });
  });
}

}  // namespace

Transparency measure_transparency(const std::string& uri, const ControllerDesign& design, const Wall& wall,
                                  const ControllersOptions& options, const std::atomic<bool>& stop) {
  std::unique_ptr<TransparencyTrial> trial;
  std::string axis_name;
  RunOptions run{.device_uri = uri,
                 .seconds = 1e6,
                 .rate_hz = options.z_width.rate_hz,
                 .virtual_time = uri.starts_with("sim:"),
                 .progress = options.z_width.progress};
  run.rendering = [&](const drivers::DeviceInfo& device) {
    const std::size_t axis = axis_of(device, options.z_width.axis);
    axis_name = device.axes[axis].name;
    trial = std::make_unique<TransparencyTrial>(device.axes[axis], axis, 1.0 / options.z_width.rate_hz,
                                                design, wall, options.transparency);
    return OtherRendering{.step = [&](const drivers::Sample& sample,
                                      double elapsed_s) { return trial->step(sample, elapsed_s); },
                          .finished = [&] { return trial->finished(); },
                          .max_ticks = trial->max_ticks()};
  };
  (void)run_on_device(run, stop);
  if (options.transparency.sensor_at_hand && !tells_something(*trial)) {
    throw std::invalid_argument(
        fmt::format("{}: no force sensor tells what the hand exerts on axis '{}'; leave out --hand-sensor",
                    uri, axis_name));
  }
  return transparency_of(*trial, wall, design.device, options.transparency);
}

ComparedControllers compare_controllers(const std::string& uri, const SampledDevice& model,
                                        const ControllersOptions& options, const std::atomic<bool>& stop) {
  ComparedControllers compared{.device = {}, .model = model, .wall = {}, .controllers = {}, .left_out = {}};
  std::vector<ControllerDesign> designs;
  for (const WallController controller : wall_controllers) {
    try {
      designs.push_back(design_controller(controller, model));
    } catch (const std::invalid_argument& why) {
      compared.left_out.push_back(fmt::format("{}: {}", name_of(controller), why.what()));
    }
  }
  for (const ControllerDesign& design : designs) {
    if (stop.load()) return compared;
    ZWidthOptions search = options.z_width;
    search.search.controller = design;
    ComparedController one{.design = design,
                           .z_width = measure_z_width(uri, search, stop),
                           .transparency = {},
                           .without = {},
                           .theory = {}};
    compared.device = one.z_width.device;
    compared.axis = one.z_width.axis;
    compared.controllers.push_back(std::move(one));
    if (!compared.controllers.back().z_width.finished) return compared;
  }
  const WallSearchOptions& search = options.z_width.search;
  compared.wall = {.stiffness_n_per_m =
                       options.wall_n_per_m > 0.0 ? options.wall_n_per_m : wall_for_all(compared.controllers),
                   .damping_n_s_per_m = search.damping_n_s_per_m.front()};
  for (ComparedController& one : compared.controllers) {
    const double stiffness = compared.wall.stiffness_n_per_m;
    if (stop.load()) return compared;
    if (!(held_by(one) >= stiffness) || stiffness == 0.0) {
      one.without = fmt::format("it does not hold {:.4g} N/m", stiffness);
      continue;
    }
    Transparency found = measure_transparency(uri, one.design, compared.wall, options, stop);
    if (!found.finished) {
      one.without =
          "its measurement was ended by a force beyond its stop, by ticks that were missed, or by hand";
      continue;
    }
    one.transparency = std::move(found);
  }
  const std::vector<double> costs = controller_costs(designs, compared.wall);
  for (std::size_t i = 0; i < compared.controllers.size(); ++i) {
    ComparedController& one = compared.controllers[i];
    one.tick_ns = costs[i];
    if (one.design.controller == WallController::passivity) continue;
    one.theory = theory_of(one.design, model, search);
    const ControlledSystem system(one.design, model, compared.wall);
    if (!one.transparency) continue;
    for (const RenderedLine& line : one.transparency->lines)
      one.theory->loop.push_back(system.loop_impedance(line.frequency_hz));
  }
  compared.finished = !stop.load();
  return compared;
}

}  // namespace kerf::bench
