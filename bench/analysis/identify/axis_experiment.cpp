#include "identify/axis_experiment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "recordings/whole_recording.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

using identification::Excitation;
using json = nlohmann::ordered_json;

constexpr double rate_hz = 1000.0;
constexpr double tick_s = 1.0 / rate_hz;
constexpr std::size_t usual_period_ticks = 1000;  // of layouts that do not tell theirs
constexpr std::size_t periods = 3;                // the first of them settles in the frequency domain
constexpr std::size_t settle_ticks = 600;
constexpr std::size_t first_settle_ticks = 3000;  // gravity is not known yet
constexpr double pilot_spring_share = 0.3;        // of the largest force, at a travel from the place
constexpr std::size_t move_ticks = 4000;          // to another place
constexpr std::size_t least_training = 4;
constexpr std::size_t most_training = 24;
constexpr std::size_t pilot_levels = 6;
constexpr double default_force_share = 0.1;
constexpr double centring_hz = 2.0;

std::string flags_in_words(std::uint32_t flags) {
  std::string words;
  for (const schema::FlagInfo& flag : schema::flag_table) {
    if ((flags & flag.flag) == 0) continue;
    words += fmt::format("{}{}", words.empty() ? "" : "; ", flag.meaning);
  }
  return words;
}

/// What the loop made of a plan.
struct Played {
  drivers::DeviceInfo device;
  ExcitationRendering::Ticks ticks;
  std::vector<std::size_t> begins;
  ExperimentEnd end = ExperimentEnd::complete;
  std::string problem;
};

using MakePlan = std::function<ExcitationPlan(const drivers::DeviceInfo&)>;

Played play(const ExperimentOptions& options, const MakePlan& make_plan, const std::filesystem::path& record,
            const std::atomic<bool>& stop) {
  std::optional<ExcitationRendering> rendering;
  RunOptions run{.device_uri = options.device_uri, .rate_hz = rate_hz, .virtual_time = options.virtual_time};
  run.progress = options.progress;
  run.warn = options.warn;
  run.seconds = 1e6;
  if (!record.empty()) run.record = record;
  run.rendering = [&](const drivers::DeviceInfo& device) {
    rendering.emplace(make_plan(device), tick_s);
    return OtherRendering{.step = [&](const drivers::Sample& sample,
                                      double elapsed_s) { return rendering->step(sample, elapsed_s); },
                          .finished = [&] { return rendering->finished(); },
                          .max_ticks = rendering->longest_ticks() + 512};
  };
  run.each_row = [&](const schema::Row& row) { rendering->see(row); };
  Played played;
  played.device = run_on_device(run, stop).device;
  played.ticks = rendering->ticks();
  played.begins = rendering->begins();
  played.end = rendering->finished() ? rendering->end() : ExperimentEnd::stopped;
  if (played.end == ExperimentEnd::fault) {
    played.problem = fmt::format("a fault took the force: {}", flags_in_words(rendering->fault_flags()));
  } else if (played.end != ExperimentEnd::complete && played.end != ExperimentEnd::enough) {
    played.problem = in_words(played.end);
  }
  return played;
}

std::size_t period_ticks_of(const ExperimentOptions& options) {
  return 4 *
         static_cast<std::size_t>(std::lround(0.25 * options.period_s * rate_hz));  // of make_excitation()
}

double force_of(const ExperimentOptions& options, const drivers::AxisInfo& axis) {
  const double limit = options.force_n > 0.0 ? options.force_n : default_force_share * axis.force_limit;
  return std::min(limit, axis.force_limit);
}

/// What both plans have in common. @throws std::invalid_argument
ExcitationPlan plan_on(const ExperimentOptions& options, const drivers::DeviceInfo& device,
                       std::size_t axis) {
  const drivers::AxisInfo& about = device.axes.at(axis);
  const double force_n = force_of(options, about);
  if (!(force_n > 0.0)) {
    throw std::invalid_argument(
        fmt::format("{}: no force may be commanded on axis '{}' (its limit is {:g} {}), so nothing moves it",
                    options.device_uri, about.name, about.force_limit, about.force_unit));
  }
  ExcitationPlan plan;
  plan.axis = axis;
  plan.lever = about.lever;
  plan.force_limit_n = force_n;
  plan.travel_m = options.travel_m;
  plan.lower_m = about.lever * about.lower;
  plan.upper_m = about.lever * about.upper;
  return plan;
}

/// The pilot: periods of half a second, each of twice the force of the one before.
ExcitationPlan pilot_plan(const ExperimentOptions& options, const drivers::DeviceInfo& device,
                          std::size_t axis, double centre_m) {
  ExcitationPlan plan = plan_on(options, device, axis);
  const Excitation excitation =
      identification::make_excitation({.kind = identification::ExcitationKind::multisine,
                                       .period_s = tick_s,
                                       .ticks = period_ticks_of(options),
                                       .lowest_hz = options.lowest_hz,
                                       .highest_hz = options.highest_hz,
                                       .seed = options.seed});
  plan.enough_travel_m = 0.25 * options.travel_m;
  plan.centring_n_per_m = pilot_spring_share * plan.force_limit_n / options.travel_m;
  for (std::size_t level = 0; level < pilot_levels; ++level) {
    PlannedStretch stretch{
        .centre_m = centre_m, .settle_ticks = level == 0 ? first_settle_ticks : 50U, .periods = 1};
    const double peak_n = 0.9 * plan.force_limit_n * std::ldexp(1.0, static_cast<int>(level) - 5);
    for (const double force : excitation.force) stretch.force_n.push_back(peak_n * force);
    plan.stretches.push_back(std::move(stretch));
  }
  return plan;
}

/// The whole stretches of what was played, as one experiment, each relative to its place.
identification::Experiment experiment_of(const Played& played, const std::vector<PlannedStretch>& planned,
                                         bool sensor, bool held) {
  identification::Experiment out;
  out.held = held;
  out.data.period_s = tick_s;
  out.data.position_m = played.ticks.position_m;
  out.data.commanded_n = played.ticks.commanded_n;
  out.excitation_n = played.ticks.excitation_n;
  out.speed_m_s = played.ticks.speed_m_s;
  if (sensor) out.sensor_n = played.ticks.sensor_n;
  for (std::size_t i = 0; i < played.begins.size(); ++i) {
    const PlannedStretch& stretch = planned[i];
    const std::size_t period = stretch.force_n.size();
    const std::size_t begin = played.begins[i];
    const std::size_t whole = std::min(stretch.periods, (out.data.position_m.size() - begin) / period);
    if (whole == 0) continue;
    out.places = std::max(out.places, stretch.place + 1);
    out.stretches.push_back({.begin = begin,
                             .period = period,
                             .periods = whole,
                             .place = stretch.place,
                             .validates = stretch.validates});
    for (std::size_t n = begin; n < begin + whole * period; ++n) out.data.position_m[n] -= stretch.centre_m;
  }
  return out;
}

/// Around the middle of the range, a travel apart from each other.
std::vector<double> places_of(const ExperimentOptions& options, const drivers::AxisInfo& about, double at_m) {
  const double lower = about.lever * about.lower;
  const double upper = about.lever * about.upper;
  const std::size_t count = options.places > 0
                                ? options.places
                                : (!options.held && upper - lower > 8.0 * options.travel_m ? 3U : 1U);
  if (options.held || count == 1) return {at_m};
  std::vector<double> places;
  const double apart = std::min(
      2.0 * options.travel_m, (0.9 * (upper - lower) - 2.0 * options.travel_m) / static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    places.push_back(0.5 * (lower + upper) +
                     apart * (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1)));
  }
  return places;
}

}  // namespace

AxisExperiment excite_axis(const ExperimentOptions& options, std::size_t axis,
                           const std::filesystem::path& record, const std::atomic<bool>& stop) {
  AxisExperiment out;
  // The pilot, about where the axis is.
  double at_m = 0.0;
  std::vector<PlannedStretch> pilot_stretches;
  const auto where = [&](const drivers::DeviceInfo& device) {
    const drivers::AxisInfo& about = device.axes.at(axis);
    at_m = 0.5 * about.lever * (about.lower + about.upper);
    ExcitationPlan plan = pilot_plan(options, device, axis, at_m);
    pilot_stretches = plan.stretches;
    return plan;
  };
  const Played pilot = play(options, where, {}, stop);
  out.device = pilot.device;
  out.end = pilot.end;
  out.problem = pilot.problem;
  const bool sensor = pilot.device.measures_force;
  out.places_m = places_of(options, pilot.device.axes.at(axis), at_m);
  if (!out.problem.empty()) {
    out.experiment = experiment_of(pilot, pilot_stretches, sensor, options.held);
    return out;
  }
  const drivers::AxisInfo& about = pilot.device.axes.at(axis);
  const double force_n = force_of(options, about);
  identification::Experiment told = experiment_of(pilot, pilot_stretches, false, options.held);
  // The level that moved it enough is the last one, and may be a part of a period.
  if (!pilot.begins.empty()) {
    told.stretches = {{.begin = pilot.begins.back(),
                       .period = told.data.position_m.size() - pilot.begins.back(),
                       .periods = 1,
                       .place = 0}};
  }
  double lowest = 0.0;
  double highest = 0.0;
  for (std::size_t n = pilot.begins.empty() ? 0 : pilot.begins.back(); n < pilot.ticks.position_m.size();
       ++n) {
    const double position = pilot.ticks.position_m[n] - at_m;
    if (!std::isfinite(position)) continue;
    lowest = std::min(lowest, position);
    highest = std::max(highest, position);
  }
  const double step_m = about.lever * about.resolution;
  if (highest - lowest < std::max(8.0 * step_m, 1e-6)) {
    out.experiment = std::move(told);
    out.problem = fmt::format(
        "{:.3g} {} moved it by {:.2g} mm: no motor, too much friction, or too little force; "
        "give more --max-force (its limit is {:.3g} {})",
        force_n, about.force_unit, 1e3 * (highest - lowest), about.force_limit, about.force_unit);
    return out;
  }
  identification::AxisModel prior{.mass_kg = 0.2, .viscous_n_s_per_m = 1.0, .coulomb_n = 0.1 * force_n};
  if (const auto model = identification::first_model(told.data, told.stretches, 1)) {
    prior = model->axis;
    prior.offset_n = std::clamp(model->offset_n.front(), -force_n, force_n);
  }
  prior.delay_s = std::min(prior.delay_s, 0.03);
  prior.viscous_n_s_per_m = std::max(prior.viscous_n_s_per_m, 0.1 * prior.mass_kg);
  prior.stiffness_n_per_m = options.held ? std::max(0.0, prior.stiffness_n_per_m) : 0.0;
  const double constant_n = prior.offset_n;
  prior.offset_n = 0.0;
  const double centring = prior.mass_kg * std::pow(2.0 * std::numbers::pi * centring_hz, 2);

  const std::size_t period_ticks = period_ticks_of(options);
  const std::size_t between_ticks = std::min(settle_ticks, period_ticks);
  const auto stretch_s = tick_s * static_cast<double>(between_ticks + periods * period_ticks);
  const auto wanted = static_cast<std::size_t>(options.seconds / stretch_s);
  const std::size_t training =
      std::clamp(3 * wanted / 4, std::max(least_training, out.places_m.size()), most_training);
  const std::size_t validation = std::max<std::size_t>(2, training / 3);
  identification::ExcitationOptions base{.kind = options.kind,
                                         .period_s = tick_s,
                                         .ticks = period_ticks,
                                         .lowest_hz = options.lowest_hz,
                                         .highest_hz = options.highest_hz,
                                         .seed = options.seed,
                                         .lines_seed = options.seed};
  const double speed = about.speed_limit > 0.0 ? 0.5 * about.lever * about.speed_limit : 1.0;
  out.design = identification::design_excitation(
      base, {.force_n = 0.7 * force_n, .travel_m = 0.7 * options.travel_m, .speed_m_s = speed}, prior, step_m,
      centring, training * periods);

  std::vector<PlannedStretch> stretches;
  for (std::size_t i = 0; i < training + validation; ++i) {
    identification::ExcitationOptions one = out.design.options;
    one.seed = options.seed + 1000 * (i + 1);
    const Excitation excitation = identification::make_excitation(one);
    // Through the places once, and back for the validation: each way takes time.
    const std::size_t count = out.places_m.size();
    const std::size_t place =
        i < training ? i * count / training : count - 1 - (i - training) * count / validation;
    const bool stays = stretches.empty() ? count == 1 : stretches.back().place == place;
    PlannedStretch stretch{.centre_m = out.places_m[place],
                           .settle_ticks = !stays              ? move_ticks
                                           : stretches.empty() ? settle_ticks
                                                               : between_ticks,
                           .periods = periods,
                           .place = place,
                           .validates = i >= training};
    for (const double force : excitation.force) stretch.force_n.push_back(out.design.peak_n * force);
    stretches.push_back(std::move(stretch));
    out.experiment.lines = excitation.excited;
  }
  const std::vector<std::size_t> lines = out.experiment.lines;
  const auto whole = [&](const drivers::DeviceInfo& device) {
    ExcitationPlan plan = plan_on(options, device, axis);
    plan.centring_n_per_m = centring;
    plan.bias_n = -constant_n;
    plan.stretches = stretches;
    return plan;
  };
  const Played played = play(options, whole, record, stop);
  out.experiment = experiment_of(played, stretches, sensor, options.held);
  out.experiment.lines = lines;
  out.end = played.end;
  out.problem = played.problem;
  return out;
}

json layout_as_json(const AxisExperiment& measured) {
  json stretches = json::array();
  for (const identification::Stretch& stretch : measured.experiment.stretches) {
    stretches.push_back({{"begin", stretch.begin},
                         {"period", stretch.period},
                         {"periods", stretch.periods},
                         {"place", stretch.place},
                         {"validates", stretch.validates}});
  }
  const identification::Design& design = measured.design;
  return {{"held", measured.experiment.held},
          {"places", measured.places_m},
          {"lines", measured.experiment.lines},
          {"stretches", std::move(stretches)},
          {"problem", measured.problem},
          {"kind", design.options.kind == identification::ExcitationKind::chirp ? "chirp" : "multisine"},
          {"band_hz", {design.options.lowest_hz, design.options.highest_hz}},
          {"period_ticks", design.options.ticks},
          {"slope", design.options.slope},
          {"peak", design.peak_n},
          {"seed", measured.design.options.seed}};
}

AxisExperiment read_experiment(const std::filesystem::path& recording, const json& layout, std::size_t axis) {
  const schema::Recording read = read_whole_recording(recording);
  const std::size_t dimensions = read.dimensions();
  if (axis >= dimensions || read.force_commanded.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: it holds no commanded force of that axis", recording.string()));
  }
  AxisExperiment out;
  out.places_m = layout.at("places").get<std::vector<double>>();
  out.problem = layout.at("problem").get<std::string>();
  out.design.peak_n = layout.at("peak");
  out.design.options = {.kind = layout.at("kind") == "chirp" ? identification::ExcitationKind::chirp
                                                             : identification::ExcitationKind::multisine,
                        .period_s = tick_s,
                        .ticks = layout.value("period_ticks", usual_period_ticks),
                        .lowest_hz = layout.at("band_hz").at(0),
                        .highest_hz = layout.at("band_hz").at(1),
                        .slope = layout.at("slope"),
                        .seed = layout.at("seed"),
                        .lines_seed = layout.at("seed")};
  identification::Experiment& experiment = out.experiment;
  experiment.held = layout.at("held");
  experiment.places = out.places_m.size();
  experiment.lines = layout.at("lines").get<std::vector<std::size_t>>();
  experiment.data.period_s = tick_s;
  const double lever = read.axes[axis].lever;
  const std::size_t ticks = read.tick.empty() ? 0 : static_cast<std::size_t>(read.tick.back()) + 1;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  experiment.data.position_m.assign(ticks, unknown);
  experiment.speed_m_s.assign(ticks, unknown);
  experiment.data.commanded_n.assign(ticks, 0.0);
  experiment.excitation_n.assign(ticks, 0.0);
  if (!read.force_measured.empty()) experiment.sensor_n.assign(ticks, unknown);
  for (std::size_t row = 0; row < read.rows(); ++row) {
    const auto tick = static_cast<std::size_t>(read.tick[row]);
    experiment.data.position_m[tick] = lever * read.position[row * dimensions + axis];
    experiment.speed_m_s[tick] = lever * read.velocity[row * dimensions + axis];
    experiment.data.commanded_n[tick] = read.force_commanded[row * dimensions + axis];
    if (!experiment.sensor_n.empty())
      experiment.sensor_n[tick] = read.force_measured[row * dimensions + axis];
  }
  std::size_t number = 0;
  for (const json& of : layout.at("stretches")) {
    const identification::Stretch stretch{.begin = of.at("begin"),
                                          .period = of.at("period"),
                                          .periods = of.at("periods"),
                                          .place = of.at("place"),
                                          .validates = of.at("validates")};
    if (stretch.end() > ticks || stretch.place >= out.places_m.size() || stretch.period == 0) {
      throw std::invalid_argument(
          fmt::format("{}: it is shorter than what is said of it beside it", recording.string()));
    }
    identification::ExcitationOptions one = out.design.options;
    one.seed = out.design.options.seed + 1000 * (number + 1);
    ++number;
    const Excitation excitation = identification::make_excitation(one);
    for (std::size_t n = stretch.begin; n < stretch.end(); ++n) {
      experiment.data.position_m[n] -= out.places_m[stretch.place];
      experiment.excitation_n[n] =
          out.design.peak_n * excitation.force[(n - stretch.begin) % excitation.force.size()];
    }
    experiment.stretches.push_back(stretch);
  }
  return out;
}

}  // namespace kerf::bench
