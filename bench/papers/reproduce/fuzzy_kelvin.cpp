#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/core.h>

#include <kerf/fitting/rupture.h>
#include <kerf/models/fuzzy_kelvin.h>
#include <kerf/models/kelvin.h>

#include "fits/rupture_table.h"
#include "reproduce/reproduce.h"

namespace kerf::bench::fuzzy_kelvin {
namespace {

constexpr double period_s = 1e-3;
constexpr Colour colours[] = {Colour::blue, Colour::vermillion, Colour::green, Colour::purple,
                              Colour::orange};

/// Cutting at a constant depth and speed.
struct Cut {
  std::vector<double> time_s, force_n;
  std::vector<double> peak_n, interval_s;
};

Cut cut(const models::Law& threshold, double depth_m, double speed, double seconds) {
  std::vector<double> values{8.0, 7.0, 130.0};  // liver, [FuzzyKelvin]
  values.insert(values.end(), threshold.values().begin(), threshold.values().end());
  models::Options options = threshold.options();
  options["depth"] = depth_m;
  const auto law = models::FuzzyKelvin<double>::make(values, options);
  models::FuzzyKelvin<double>::State state;
  Cut all;
  double last_s = 0.0;
  for (double t = 0.0; t < seconds; t += period_s) {
    all.time_s.push_back(t);
    all.force_n.push_back(law.step(state, {speed * t, speed}, period_s));
    if (state.ruptures == all.peak_n.size()) continue;
    all.peak_n.push_back(state.rupture_force);
    all.interval_s.push_back(t - last_s);
    last_s = t;
  }
  return all;
}

/// Largest deviation from the mean, as a share of it.
double deviation(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::infinity();
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value - mean));
  return most / mean;
}

void surface(Reproduction& paper, const fitting::RuptureSamples& samples, const models::Law& threshold) {
  Chart chart{.title = "Rupture threshold: samples and trained surface (fig. 3)",
              .x_label = "depth [mm]",
              .y_label = "force [N]"};
  std::size_t next = 0;
  for (const double speed : {0.5e-3, 2e-3, 5e-3, 10e-3}) {
    Curve trained{.label = fmt::format("{:g} mm/s", 1e3 * speed), .colour = colours[next]};
    Curve given{.colour = colours[next], .mark = Mark::points};
    ++next;
    auto state = threshold.initial_state();
    for (double d = 1e-3; d <= 10e-3; d += 1e-4) {
      trained.x.push_back(1e3 * d);
      trained.y.push_back(threshold.step(state, models::Motion{d, speed}, period_s).force);
    }
    for (std::size_t i = 0; i < samples.force_n.size(); ++i) {
      if (std::abs(samples.speed_m_per_s[i] - speed) > 1e-9) continue;
      given.x.push_back(1e3 * samples.depth_m[i]);
      given.y.push_back(samples.force_n[i]);
    }
    chart.curves.push_back(std::move(trained));
    chart.curves.push_back(std::move(given));
  }
  paper.figures.push_back({"surface", std::move(chart)});
}

void one_cut(Reproduction& paper, const models::Law& threshold) {
  const Cut at = cut(threshold, 5e-3, 2e-3, 12.0);
  if (at.peak_n.empty()) return paper.add("Ruptures follow each other", "fig. 4", "none in 12 s", false);
  Chart chart{
      .title = "Force over time at 2 mm/s and 5 mm (fig. 4)", .x_label = "time [s]", .y_label = "force [mN]"};
  Curve curve{.x = at.time_s, .colour = Colour::blue};
  for (const double force : at.force_n) curve.y.push_back(1e3 * force);
  chart.curves.push_back(std::move(curve));
  paper.figures.push_back({"force_time", std::move(chart)});
  paper.add(
      "At constant depth and speed every rupture has the same force and the same interval", "fig. 4",
      fmt::format("{} ruptures of {:.1f} mN every {:.2f} s; force within {:.2f} %, interval within {:.2f} %",
                  at.peak_n.size(), 1e3 * at.peak_n.front(), at.interval_s.front(),
                  100.0 * deviation(at.peak_n), 100.0 * deviation(at.interval_s)),
      deviation(at.peak_n) < 0.01 && deviation(at.interval_s) < 0.01);
}

template <typename Depth, typename Speed>
void sweep(Reproduction& paper, const models::Law& threshold, const char* figure, const std::string& title,
           const std::vector<double>& values, Depth depth, Speed speed, const char* unit, bool longer,
           const std::string& claim, const char* where) {
  Chart chart{.title = title, .x_label = "time [s]", .y_label = "force [mN]"};
  std::string forces, intervals;
  bool rising = true;
  bool follows = true;
  double last_force = 0.0;
  double last_interval = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Cut at = cut(threshold, depth(values[i]), speed(values[i]), 8.0);
    Curve curve{.label = fmt::format("{:g} {}", 1e3 * values[i], unit), .x = at.time_s, .colour = colours[i]};
    for (const double force : at.force_n) curve.y.push_back(1e3 * force);
    chart.curves.push_back(std::move(curve));
    if (at.peak_n.empty()) {
      paper.add(claim, where, fmt::format("no rupture in 8 s at {:g} {}", 1e3 * values[i], unit), false);
      return;
    }
    rising = rising && at.peak_n.front() > last_force;
    follows = follows && (i == 0 || (at.interval_s.front() > last_interval) == longer);
    last_force = at.peak_n.front();
    last_interval = at.interval_s.front();
    forces += fmt::format("{}{:.0f}", i ? ", " : "", 1e3 * last_force);
    intervals += fmt::format("{}{:.2f}", i ? ", " : "", last_interval);
  }
  paper.figures.push_back({figure, std::move(chart)});
  paper.add(claim, where, fmt::format("ruptures at {} mN every {} s", forces, intervals), rising && follows);
}

}  // namespace

Reproduction run(std::uint64_t) {
  Reproduction paper{
      .paper = "002", .key = "FuzzyKelvin", .title = "Hybrid Kelvin and fuzzy model of tissue cutting"};
  const fitting::RuptureSamples samples = liver_ruptures();
  const auto projected = fitting::train_rupture(samples);
  const auto descended = fitting::train_rupture(samples, {.learning = fitting::Learning::back_propagation});
  const models::Law& threshold = projected.law;
  surface(paper, samples, threshold);
  one_cut(paper, threshold);
  const auto same = [](double value) { return value; };
  const auto at = [](double fixed) { return [fixed](double) { return fixed; }; };
  sweep(paper, threshold, "force_depth", "Force over time at 2 mm/s (fig. 5)", {3e-3, 4e-3, 5e-3, 6e-3}, same,
        at(2e-3), "mm", true, "Deeper: higher force and longer interval", "fig. 5");
  sweep(paper, threshold, "force_speed", "Force over time at 5 mm (fig. 6)", {1e-3, 2e-3, 4e-3, 6e-3},
        at(5e-3), same, "mm/s", false, "Faster: higher force and shorter interval", "fig. 6");
  paper.answer(
      "Hybrid learning against plain back-propagation, on the table that ships", "2.2",
      fmt::format("variable projection: {:.2g} mN rms after {} iterations in {:.3f} s; back-propagation: "
                  "{:.2g} mN after {} in {:.3f} s",
                  1e3 * projected.rmse_n, projected.iterations, projected.seconds, 1e3 * descended.rmse_n,
                  descended.iterations, descended.seconds));
  const models::Kelvin<double> liver{8.0, 7.0, 130.0};
  models::Kelvin<double>::State state;
  double force = 0.0;
  for (int tick = 0; tick <= 30000; ++tick) {
    force = liver.step(state, {std::min(2e-6 * tick, 5e-3), 0.0}, period_s);
  }
  paper.add(
      "The Kelvin element relaxes at a constant strain", "2.1, fig. 2",
      fmt::format("5 mm in 2.5 s, then held: {:.1f} mN after 30 s, {:.1f} mN in the end", 1e3 * force, 40.0),
      std::abs(force - 0.0474485998763) < 1e-10);
  return paper;
}

}  // namespace kerf::bench::fuzzy_kelvin
