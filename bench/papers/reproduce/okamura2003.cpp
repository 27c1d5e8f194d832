#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include <kerf/drivers/device.h>
#include <kerf/mechanisms/angle.h>
#include <kerf/models/branch.h>
#include <kerf/models/piecewise.h>

#include "fits/fit_recording.h"
#include "fits/fit_series.h"
#include "loop/command.h"
#include "report/charts.h"
#include "reproduce/reproduce.h"
#include "segment/segment.h"
#include "signal/quantiles.h"

namespace kerf::bench::okamura2003 {
namespace {

constexpr double period_s = 1e-3;
constexpr double contact_rad = 40.0 * degree;  // where the blades meet whatever is cut
constexpr double force_jnd = 0.07;             // Weber fraction, [Pang1991]
constexpr double felt_n = 0.1;                 // a step of the force that a hand feels
constexpr double least_force_n = 0.2;          // below it a JND is no share of the force
constexpr Colour colours[] = {Colour::blue, Colour::vermillion, Colour::green, Colour::purple};

/// A tissue between the blades: force of closing over the angle travelled, with the shapes of [Okamura2003]'s
/// figs. 4 and 6. Made for this bench, not measured.
struct Tissue {
  std::string name;
  std::vector<double> closing_n;  ///< at 0, 4, 8, ... 36 degrees past contact
};
const std::vector<Tissue> tissues{{"Empty", {0.25, 0.30, 0.32, 0.34, 0.37, 0.40, 0.44, 0.48, 0.53, 0.58}},
                                  {"liver-like", {0.3, 0.6, 0.8, 0.9, 0.95, 1.05, 1.2, 1.4, 1.7, 2.0}},
                                  {"skin-like", {0.3, 1.6, 2.6, 3.1, 3.0, 3.1, 3.5, 4.1, 4.6, 4.9}},
                                  {"tendon-like", {0.3, 2.8, 5.2, 6.0, 5.1, 4.2, 4.0, 4.3, 4.7, 5.0}}};

models::Piecewise<double> closing_law(const Tissue& tissue) {
  models::Piecewise<double> law;
  law.knots = tissue.closing_n.size();
  for (std::size_t i = 0; i < law.knots; ++i) {
    law.knot[i] = 4.0 * degree * static_cast<double>(i);
    law.closing[i] = law.opening[i] = tissue.closing_n[i];
  }
  return law;
}

/// Records a hand that cuts a tissue with the simulated scissors, and finds its cycles.
schema::Recording record(const Tissue& tissue, std::uint64_t seed, double seconds) {
  drivers::Surroundings surroundings;
  models::Piecewise<double> law = closing_law(tissue).with_opening_from(closing_law(tissues.front()));
  law.selector.ramp_band = 0.02;  // a friction that fades where the blades stand still
  surroundings.tissue[0] = [law, state = models::BranchSelector::State{}](double theta, double rate,
                                                                          double dt) mutable {
    if (theta > contact_rad) return 0.0;
    return law.step(state, {contact_rad - theta, -rate}, dt);
  };
  const auto device = drivers::open_device(
      fmt::format("sim:scissors?seed={}&open=38deg&close=-5deg&stroke=1.2s", seed), std::move(surroundings));
  schema::Recording recording;
  recording.header = schema::new_header("");
  for (const drivers::AxisInfo& axis : device->info().axes) {
    recording.axes.push_back({.name = axis.name,
                              .position_unit = axis.position_unit,
                              .force_unit = axis.force_unit,
                              .lever = axis.lever});
  }
  drivers::Sample sample;
  for (std::uint64_t tick = 0; tick < static_cast<std::uint64_t>(seconds / period_s); ++tick) {
    const double now_s = period_s * static_cast<double>(tick);
    (void)device->read(now_s, sample);
    (void)device->write({});
    recording.time.push_back(now_s);
    recording.tick.push_back(tick);
    for (std::size_t axis = 0; axis < recording.dimensions(); ++axis) {
      recording.position.push_back(sample.position[axis]);
      recording.velocity.push_back(sample.velocity[axis]);
      recording.force_measured.push_back(sample.force_measured[axis]);
    }
  }
  recording.cycles = find_cycles(recording, {});
  return recording;
}

/// The averaged closing and how a law follows it.
struct Averaged {
  std::vector<double> angle_deg;
  AxisSeries series;  ///< at one row a tick
};
Averaged averaged(const schema::Recording& recording, const models::Contact& contact) {
  const schema::Cycles& cycles = *recording.cycles;
  Averaged mean;
  for (std::size_t i = 0; i < cycles.grid.size(); ++i) {
    if (!std::isfinite(cycles.closing_mean[i])) continue;
    mean.angle_deg.push_back(cycles.grid[i] / degree);
    mean.series.time_s.push_back(period_s * static_cast<double>(mean.series.time_s.size()));
    mean.series.penetration.push_back(contact.motion(cycles.grid[i], 0.0).penetration);
    mean.series.velocity.push_back(1.0);
    mean.series.force.push_back(cycles.closing_mean[i]);
  }
  return mean;
}
std::vector<double> closing_force(const models::Law& fitted, const Averaged& mean) {
  const models::Law law = without_rendering_aids(fitted);
  std::vector<double> force;
  for (const double penetration : mean.series.penetration) {
    auto state = law.initial_state();
    force.push_back(law.step(state, models::Motion{penetration, 1.0}, period_s).force);
  }
  return force;
}
/// Error over force that 95 % of the angles stay below.
double relative_error(const std::vector<double>& force, const Averaged& mean) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < force.size(); ++i) {
    errors.push_back(std::abs(force[i] - mean.series.force[i]) /
                     std::max(std::abs(mean.series.force[i]), least_force_n));
  }
  return quantile(std::move(errors), 0.95);
}

LawFile fitted(const schema::Recording& recording, const std::string& model) {
  FitRecordingOptions options;
  options.models = {model};
  const RecordingFit fit = fit_recording(recording, options);
  if (fit.laws.empty()) {
    throw std::runtime_error(
        model + " could not be fitted: " + (fit.refusals.empty() ? "" : fit.refusals.front().why));
  }
  return fit.laws.front().file;
}

/// A segmented model of the averaged closing alone, as [Okamura2003] draws it.
models::Law segmented(const Averaged& mean, std::size_t segments) {
  // The grid runs over the angle, hence out of the tissue.
  return fitting::fit("piecewise", fitted_view(mean.series),
                      {.law_options = {{"segments", static_cast<double>(segments)}}, .folds = 2})
      .law();
}

void loops_and_segments(Reproduction& paper, const std::vector<schema::Recording>& recordings) {
  Chart loops{.title = "Haptic recordings: averaged closing and opening (fig. 4)",
              .x_label = "angle between the blades [deg]",
              .y_label = "force at the handle [N]"};
  Chart models_chart{.title = "Averaged closings and their segmented models (fig. 6)",
                     .x_label = "angle between the blades [deg]",
                     .y_label = "force at the handle [N]"};
  Chart errors{.title = "Error of the segmented model against the number of segments",
               .x_label = "segments",
               .y_label = "error over force, 95 % of angles below [%]",
               .log_y = true};
  errors.horizontal.push_back({.at = 100.0 * force_jnd, .label = "JND of force"});
  std::string needed;
  std::size_t most = 0;
  for (std::size_t t = 0; t < tissues.size(); ++t) {
    const schema::Recording& recording = recordings[t];
    const schema::Cycles& cycles = *recording.cycles;
    std::vector<double> angle;
    for (const double theta : cycles.grid) angle.push_back(theta / degree);
    loops.curves.push_back(
        {.label = tissues[t].name, .x = angle, .y = cycles.closing_mean, .colour = colours[t]});
    loops.curves.push_back({.x = angle, .y = cycles.opening_mean, .colour = colours[t], .dashed = true});
    Curve error{.label = tissues[t].name, .colour = colours[t]};
    const Averaged mean = averaged(recording, contact_of(recording, 0));
    std::size_t fewest = 0;
    for (std::size_t n = 1; n <= 7; ++n) {
      const auto force = closing_force(segmented(mean, n), mean);
      error.x.push_back(static_cast<double>(n));
      error.y.push_back(100.0 * relative_error(force, mean));
      if (fewest > 0 || relative_error(force, mean) > force_jnd) continue;
      fewest = n;
      models_chart.curves.push_back({.label = tissues[t].name,
                                     .x = mean.angle_deg,
                                     .y = mean.series.force,
                                     .colour = Colour::grey,
                                     .mark = Mark::points,
                                     .width = 0.7});
      models_chart.curves.back().label.clear();
      models_chart.curves.push_back(
          {.label = fmt::format("{}, {} segment{}", tissues[t].name, n, n > 1 ? "s" : ""),
           .x = mean.angle_deg,
           .y = force,
           .colour = colours[t]});
    }
    errors.curves.push_back(std::move(error));
    needed += fmt::format("{}{} {}", t ? ", " : "", tissues[t].name,
                          fewest > 0 ? std::to_string(fewest) : "more than 7");
    most = std::max(most, fewest > 0 ? fewest : 8);
  }
  paper.figures.push_back({"recordings", std::move(loops)});
  paper.figures.push_back({"segmented", std::move(models_chart)});
  paper.figures.push_back({"segments_error", std::move(errors)});
  paper.add("A small number of segments (2 to 7) is generally sufficient", "3.2, fig. 6",
            fmt::format("fewest within the force JND of 7 %: {}", needed), most <= 7);
}

void scaling(Reproduction& paper, const schema::Recording& recording) {
  const LawFile file = fitted(recording, "recording");
  const models::Law pure = without_rendering_aids(file.law);
  Chart chart{.title = "A reversal: pure recording and scaled (fig. 5)",
              .x_label = "time [s]",
              .y_label = "force at the handle [N]"};
  std::vector<double> time_s;
  std::vector<models::Motion> motion;
  for (int tick = 0; tick < 2400; ++tick) {
    time_s.push_back(period_s * tick);
    const double phase = 2.0 * std::numbers::pi * time_s.back() / 1.6;
    motion.push_back({.penetration = 0.3 * (1.0 - std::cos(phase)) / 2.0 + 0.1,
                      .velocity = 0.3 * std::numbers::pi / 1.6 * std::sin(phase)});
  }
  const auto rendered = [&](const models::Law& law, Curve curve) {
    curve.x = time_s;
    curve.y = law.along(motion, std::vector(motion.size(), period_s));
    double worst = 0.0;
    for (std::size_t tick = 401; tick < curve.y.size(); ++tick)
      worst = std::max(worst, std::abs(curve.y[tick] - curve.y[tick - 1]));
    chart.curves.push_back(std::move(curve));
    return worst;
  };
  const double jump = rendered(pure, {.label = "pure recording", .colour = Colour::vermillion});
  const double scaled =
      rendered(file.law, {.label = "scaled after each reversal, ramp band", .colour = Colour::blue});
  paper.figures.push_back({"scaling", std::move(chart)});
  paper.add("The discontinuities of a pure recording are removed by the scaling", "3.1, fig. 5",
            fmt::format("largest step from tick to tick: {:.2f} N pure, {:.3f} N scaled", jump, scaled),
            jump > 10.0 * scaled);
}

/// The recording rendered on a freely moved device by a very slow hand.
struct SlowHand {
  double jumps_per_s = 0.0;  ///< steps of the force from tick to tick that a hand feels
  double mean_n = 0.0;       ///< mean size of the force
  double largest_step_n = 0.0;
  Curve force;
};
SlowHand slow_hand(const LawFile& file, double ramp_band, std::uint64_t seed) {
  models::Options options = file.law.options();
  options["ramp_band"] = ramp_band;
  options["reversal_scale"] = 0.0;  // the band alone is on trial
  const models::Law law = models::Law::make(file.law.model(), file.law.values(), options);
  LawRendering rendering(law, file.contact, {0});
  const auto device = drivers::open_device(
      fmt::format("sim:scissors?seed={}&open=25deg&close=15deg&stroke=20s&pause=1s&variation=0", seed));
  SlowHand all;
  drivers::Sample sample;
  double before = 0.0;
  int jumps = 0;
  constexpr int ticks = 12000;
  for (int tick = 0; tick < ticks; ++tick) {
    (void)device->read(period_s * tick, sample);
    const double force = rendering(sample, period_s).force[0];
    (void)device->write({force});
    all.force.x.push_back(period_s * tick);
    all.force.y.push_back(force);
    if (tick > 2000) {
      jumps += std::abs(force - before) > felt_n;
      all.mean_n += std::abs(force) / (ticks - 2000);
      all.largest_step_n = std::max(all.largest_step_n, std::abs(force - before));
    }
    before = force;
  }
  all.jumps_per_s = jumps / (period_s * (ticks - 2000));
  return all;
}

void limit_cycle(Reproduction& paper, const schema::Recording& recording, std::uint64_t seed) {
  const LawFile file = fitted(recording, "recording");
  Chart chart{.title = "A hand at 0.5 deg/s: ramp bands of three widths",
              .x_label = "time [s]",
              .y_label = "force at the handle [N]",
              .x_range = {4.0, 5.5}};
  std::string text;
  double jumps_without = 0.0;
  double removed_at = 0.0;
  SlowHand last;
  std::size_t colour = 0;
  for (const double band : {0.0, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6}) {
    last = slow_hand(file, band, seed);
    if (band == 0.0) {
      jumps_without = last.jumps_per_s;
      paper.add(
          "At low speed the sign of the velocity makes a limit cycle", "3.1",
          fmt::format("without a ramp band the force jumps {:.0f} times a second, by up to {:.2f} N a tick",
                      last.jumps_per_s, last.largest_step_n),
          last.jumps_per_s > 5.0);
    }
    text += fmt::format("{}{:g} rad/s: {:.0f} and {:.2g} N", text.empty() ? "" : ", ", band, last.jumps_per_s,
                        last.mean_n);
    if (last.jumps_per_s > 0.0) {
      removed_at = 0.0;
    } else if (removed_at == 0.0) {
      removed_at = band;
    }
    if (band == 0.0 || band == 0.1 || band == 0.8) {
      last.force.label = band == 0.0 ? "none" : fmt::format("{:g} rad/s", band);
      last.force.colour = colours[(colour + 1) % 3];
      last.force.width = band == 0.0 ? 0.8 : 1.5;
      ++colour;
      chart.curves.push_back(last.force);
    }
  }
  paper.figures.push_back({"limit_cycle", std::move(chart)});
  paper.add("A linear ramp of the force around zero velocity removes it", "3.1, its width not given",
            fmt::format("jumps of more than {:g} N a second, and mean force, by width of the band: {}; gone "
                        "from {:g} rad/s on, with most "
                        "of the force at this speed",
                        felt_n, text, removed_at),
            removed_at > 0.0 && jumps_without > 5.0);
}

void analytical(Reproduction& paper, const std::vector<schema::Recording>& recordings) {
  Chart chart{.title = "Analytical model on the averaged closings (fig. 7)",
              .x_label = "angle between the blades [deg]",
              .y_label = "force at the handle [N]"};
  std::string text;
  double best = 1.0;
  double worst = 0.0;
  for (std::size_t t = 0; t < tissues.size(); ++t) {
    const LawFile file = fitted(recordings[t], "scissors_analytic");
    const Averaged mean = averaged(recordings[t], file.contact);
    const auto force = closing_force(file.law, mean);
    const double error = relative_error(force, mean);
    best = std::min(best, error);
    worst = std::max(worst, error);
    text += fmt::format("{}{} {:.0f} %", t ? ", " : "", tissues[t].name, 100.0 * error);
    chart.curves.push_back({.x = mean.angle_deg,
                            .y = mean.series.force,
                            .colour = colours[t],
                            .mark = Mark::points,
                            .width = 0.7});
    chart.curves.push_back({.label = tissues[t].name, .x = mean.angle_deg, .y = force, .colour = colours[t]});
  }
  paper.figures.push_back({"analytical", std::move(chart)});
  paper.add("The analytical model does not closely match the data of tissue", "3.3, fig. 7",
            fmt::format("error over force: {}; the JND is 7 %", text), worst > force_jnd);
}

}  // namespace

Reproduction run(std::uint64_t seed) {
  Reproduction paper{.paper = "004",
                     .key = "Okamura2003",
                     .title = "Haptic scissors: recordings, segmented and analytical models"};
  std::vector<schema::Recording> recordings;
  for (std::size_t t = 0; t < tissues.size(); ++t) recordings.push_back(record(tissues[t], seed + t, 20.0));
  loops_and_segments(paper, recordings);
  scaling(paper, recordings[2]);
  limit_cycle(paper, recordings[2], seed);
  analytical(paper, recordings);
  return paper;
}

}  // namespace kerf::bench::okamura2003
