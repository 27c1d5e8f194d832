#include "stability/zwidth/z_width.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/drivers/gaussian.h>

#include "laws/placement.h"
#include "loop/clock.h"
#include "loop/loop.h"
#include "record/recorder.h"
#include "run/run.h"
#include "stability/device/sampled_loop.h"
#include "stability/wall/wall_theory.h"
#include "threads/for_each_index.h"

namespace kerf::bench {

std::size_t axis_of(const drivers::DeviceInfo& device, const std::string& name) {
  std::size_t axis = 0;
  if (!name.empty()) {
    while (axis < device.axes.size() && device.axes[axis].name != name) ++axis;
  }
  if (axis >= device.axes.size()) {
    throw std::invalid_argument(
        fmt::format("{} has no axis '{}'; it has {}", device.uri, name, names_in(device.axes)));
  }
  if (!(device.axes[axis].force_limit > 0.0)) {
    throw std::invalid_argument(fmt::format("{}: axis '{}' has no force, and walls are rendered by one",
                                            device.uri, device.axes[axis].name));
  }
  return axis;
}

namespace {

/// A search as the rendering of a loop.
class RenderedSearch {
 public:
  explicit RenderedSearch(WallSearch& search) : search_(search) {}
  Command operator()(const drivers::Sample& sample, double elapsed_s) noexcept {
    return search_.step(sample, elapsed_s);
  }
  [[nodiscard]] bool finished() const noexcept { return search_.finished(); }

 private:
  WallSearch& search_;
};

/// A search as the force of a SampledLoop.
class SearchForce {
 public:
  SearchForce(WallSearch& search, double period_s) : search_(&search), period_s_(period_s) {}
  double operator()(const AxisReading& reading) noexcept {
    sample_.position[0] = reading.position_m;
    sample_.velocity[0] = reading.speed_m_s;
    return search_->step(sample_, period_s_).force[0];
  }

 private:
  WallSearch* search_;
  double period_s_;
  drivers::Sample sample_;
};

ZWidth begun(const drivers::DeviceInfo& device, std::size_t axis, const ZWidthOptions& options) {
  return {.device = device,
          .axis = axis,
          .period_s = 1.0 / options.rate_hz,
          .options = options.search,
          .ladder = {}};
}

void take(ZWidth& found, const WallSearch& search, const LoopReport& report) {
  found.ladder = search.rungs();
  found.options = search.options();
  found.finished = search.finished();
  found.ticks = report.ticks();
  found.missed = report.missed();
}

/// Boundaries of one model over the ladder.
std::vector<double> boundaries_of(const SampledDevice& device, const WallSearchOptions& options) {
  std::vector<double> boundaries;
  if (!device.is_linear()) {
    for (const WallRung& rung : search_model(device, options)) boundaries.push_back(rung.boundary());
    return boundaries;
  }
  const SampledSystem system(device);
  for (const double damping : options.damping_n_s_per_m) {
    boundaries.push_back(
        eigenvalue_boundary(system, damping, options.softest_n_per_m, options.stiffest_n_per_m));
  }
  return boundaries;
}

SampledDevice drawn(const UncertainModel& model, drivers::Gaussian& normal) {
  constexpr double per_half_interval = 1.0 / 1.959963984540054;
  const auto vary = [&](double& value, double share) {
    value *= std::max(0.0, 1.0 + share * per_half_interval * normal());
  };
  SampledDevice device = model.device;
  vary(device.mass_kg, model.mass);
  device.mass_kg = std::max(device.mass_kg, 0.01 * model.device.mass_kg);
  vary(device.viscous_n_s_per_m, model.viscous);
  vary(device.coulomb_n, model.coulomb);
  vary(device.hand.mass_kg, model.hand);
  vary(device.hand.damping_n_s_per_m, model.hand);
  vary(device.hand.stiffness_n_per_m, model.hand);
  const double longest_s = device.period_s * static_cast<double>(SampledDevice::max_delay_ticks);
  device.delay_s = std::clamp(device.delay_s + model.delay_s * per_half_interval * normal(), 0.0, longest_s);
  return device;
}

/// The middle 95 % of numbers, between those that stand beside its ends.
Range middle_of(std::vector<double> numbers) {
  std::ranges::sort(numbers);
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(numbers.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, numbers.size() - 1);
    return std::lerp(numbers[below], numbers[above], place - static_cast<double>(below));
  };
  return {.begin = at(0.025), .end = at(0.975)};
}

}  // namespace

ZWidth measure_z_width(const std::string& uri, const ZWidthOptions& options, const std::atomic<bool>& stop) {
  std::unique_ptr<WallSearch> search;
  std::size_t axis = 0;
  RunOptions run{.device_uri = uri,
                 .seconds = 1e6,
                 .rate_hz = options.rate_hz,
                 .virtual_time = uri.starts_with("sim:"),
                 .progress = options.progress};
  run.rendering = [&](const drivers::DeviceInfo& device) {
    axis = axis_of(device, options.axis);
    search = std::make_unique<WallSearch>(device.axes[axis], axis, 1.0 / options.rate_hz, options.search);
    return OtherRendering{.step = [&](const drivers::Sample& sample,
                                      double elapsed_s) { return search->step(sample, elapsed_s); },
                          .finished = [&] { return search->finished(); },
                          .max_ticks = search->max_ticks()};
  };
  const RunResult result = run_on_device(run, stop);
  ZWidth found = begun(result.device, axis, options);
  take(found, *search, result.report);
  return found;
}

ZWidth measure_z_width(drivers::Device& device, const ZWidthOptions& options, const std::atomic<bool>& stop) {
  const std::size_t axis = axis_of(device.info(), options.axis);
  ZWidth found = begun(device.info(), axis, options);
  WallSearch search(device.info().axes[axis], axis, found.period_s, options.search);
  VirtualClock clock;
  RenderedSearch rendering(search);
  NoRecorder none;
  std::atomic<std::size_t> done{0};
  Heartbeat heartbeat;
  LoopReport report;
  run_loop(clock, device, rendering, none,
           {.ticks = search.max_ticks(), .safety = {.period_s = found.period_s}},
           {.stop = stop, .done = done, .heartbeat = heartbeat}, report);
  take(found, search, report);
  return found;
}

std::vector<WallRung> search_model(const SampledDevice& device, const WallSearchOptions& options) {
  check(device);
  constexpr double no_limit_n = 1e6;  // the search has its own stop
  WallSearchOptions bounded = options;
  if (bounded.stop_n == 0.0) bounded.stop_n = 20.0 * options.strike_n;
  const drivers::AxisInfo axis{.name = "x",
                               .position_unit = "m",
                               .force_unit = "N",
                               .resolution = device.encoder_step_m,
                               .force_limit = no_limit_n};
  WallSearch search(axis, 0, device.period_s, bounded);
  SampledLoop<SearchForce> loop(device, SearchForce(search, device.period_s), {});
  for (std::uint64_t tick = 0; tick < search.max_ticks() && !search.finished(); ++tick) loop.step();
  return search.rungs();
}

std::vector<ZWidthTheory> z_width_theory(const UncertainModel& model, const WallSearchOptions& options,
                                         std::size_t draws, std::size_t threads) {
  std::vector<ZWidthTheory> theory;
  const std::vector<double> exact = boundaries_of(model.device, options);
  const PassiveWalls passive(model.device);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double damping = options.damping_n_s_per_m[i];
    theory.push_back({.damping_n_s_per_m = damping,
                      .boundary = exact[i],
                      .passive = passive.stiffness(damping),
                      .band = {}});
  }
  if (model.is_exact() || draws == 0) return theory;
  std::vector<SampledDevice> models;
  drivers::Gaussian normal(1);
  for (std::size_t i = 0; i < draws; ++i) models.push_back(drawn(model, normal));
  std::vector<std::vector<double>> of_draws(draws);
  for_each_index(draws, threads, [&](std::size_t i) { of_draws[i] = boundaries_of(models[i], options); });
  for (std::size_t rung = 0; rung < theory.size(); ++rung) {
    std::vector<double> at_rung;
    for (const std::vector<double>& boundaries : of_draws) at_rung.push_back(boundaries[rung]);
    theory[rung].band = middle_of(std::move(at_rung));
  }
  return theory;
}

}  // namespace kerf::bench
