#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/core.h>

#include <kerf/drivers/hand.h>
#include <kerf/models/lattice.h>
#include <kerf/models/law.h>

#include "cases/each_case.h"
#include "cases/trace.h"

namespace kerf::bench::cases::euler {
namespace {

constexpr double period_s = 1e-3;
constexpr double seconds = 0.4;
constexpr double press_s = 0.2;

/// Where a tool is that presses to a depth and stays there.
double pressed(double depth_m, double time_s) {
  return depth_m * drivers::MinimumJerk::at(time_s / press_s).position;
}

/// Largest distance of two traces at the times of the first; lost_n where the first got lost.
double largest_error(const CaseTrace& trace, const CaseTrace& reference, std::size_t finer) {
  double worst = 0.0;
  for (std::size_t i = 0; i < trace.force_n.size(); ++i) {
    const double error = std::abs(trace.force_n[i] - reference.force_n[finer * i]);
    worst = std::max(worst, error < lost_n ? error : lost_n);
  }
  return worst;
}

CaseOutcome judged(double error_n) {
  return {.holds = error_n <= felt_n, .measured = error_n, .unit = "N", .figure = newtons(error_n)};
}

constexpr double arm_n_per_m = 400.0;
constexpr double relaxation_s = 0.4e-3;

CaseTrace press_kelvin(const std::string& integrator, double dt) {
  const double values[] = {200.0, arm_n_per_m, arm_n_per_m * relaxation_s};
  const models::Law tissue = models::Law::make("kelvin", values, {{"integrator", integrator}});
  auto state = tissue.initial_state();
  CaseTrace trace;
  for (int tick = 0; tick * dt < seconds; ++tick) {
    const models::Motion motion{.penetration = pressed(5e-3, tick * dt)};
    const models::Response response = tissue.step(state, motion, dt);
    trace.add(tick * dt, response.force);
    if (response.fault || !(response.force < lost_n)) break;
  }
  return trace;
}

/// A patch of tissue, its border held, pressed in its middle by a tool at a virtual coupling.
constexpr models::LatticeOptions patch{
    .columns = 13, .rows = 13, .stiffness_n_per_m = 400.0, .diagonal_stiffness_n_per_m = 200.0};
constexpr double coupling_n_per_m = 100.0;

CaseTrace press_lattice(int substeps) {
  models::Lattice<double> lattice(patch);
  for (int i = 0; i < patch.columns; ++i) {
    for (const int edge : {0, patch.rows - 1}) {
      lattice.pin(i, edge);
      lattice.pin(edge, i);
    }
  }
  models::Coupling tool{.node = patch.rows / 2 * patch.columns + patch.columns / 2,
                        .stiffness_n_per_m = coupling_n_per_m};
  CaseTrace trace;
  for (int tick = 0; tick * period_s < seconds; ++tick) {
    const double now_m = pressed(5e-3, tick * period_s);
    tool.target_m = {now_m, 0.0};
    tool.velocity_m_per_s = {(pressed(5e-3, (tick + 1) * period_s) - now_m) / period_s, 0.0};
    lattice.step(period_s / substeps, substeps, {&tool, 1});
    trace.add(tick * period_s, -tool.force_n[0]);
    if (!(std::abs(trace.force_n.back()) < lost_n)) break;
  }
  return trace;
}

}  // namespace

NamedCase run_maxwell(std::uint64_t) {
  constexpr std::size_t finer = 50;
  const CaseTrace reference = press_kelvin("exact", period_s / finer);
  const CaseTrace failing = press_kelvin("euler", period_s);
  const CaseTrace holding = press_kelvin("exact", period_s);
  Chart picture = two_traces("5 mm into a Kelvin solid with an arm of 0.4 ms", failing, "forward Euler",
                             holding, "exact (first-order hold)");
  picture.x_range = {0.0, 0.1};
  picture.y_range = {-0.5, 1.0};
  return {
      .where = "[FuzzyKelvin], section 2.1 (the model); literature",
      .what = "Forward Euler on a Maxwell arm that relaxes faster than half a period diverges.",
      .remedy = "The exact step over a period, a = exp(-T / tau), which is stable at any ratio.",
      .limit = felt_n,
      .quantity = "largest error of the force towards steps 50 times as fine",
      .without = judged(largest_error(failing, reference, finer)),
      .with = judged(largest_error(holding, reference, finer)),
      .theory = fmt::format("An error of the arm grows by |1 - T / tau| = {:.2f} a tick; stable for T < 2 "
                            "tau = {:.1f} ms.",
                            std::abs(1.0 - period_s / relaxation_s), 2e3 * relaxation_s),
      .picture = std::move(picture)};
}

NamedCase run_lattice(std::uint64_t) {
  constexpr int finer = 8;
  const int needed = models::substeps(patch, period_s);
  const CaseTrace reference = press_lattice(finer * needed);
  const CaseTrace failing = press_lattice(1);
  const CaseTrace holding = press_lattice(needed);
  Chart picture = two_traces("5 mm into a lattice of 13 by 13 nodes", failing, "one step a tick", holding,
                             fmt::format("{} sub-steps", needed));
  picture.x_range = {0.0, 0.1};
  picture.y_range = {-0.2, 0.4};
  return {.where = "[Weiss2004], section 3 (333 Hz of the 1000 Hz it aimed at)",
          .what =
              "A lattice of stiff springs and light nodes, stepped once a tick, blows up within a few "
              "milliseconds of being touched.",
          .remedy = "As many sub-steps a tick as the stable step of the lattice asks for.",
          .limit = felt_n,
          .quantity = fmt::format("largest error of the force towards {} times as many sub-steps", finer),
          .without = judged(largest_error(failing, reference, 1)),
          .with = judged(largest_error(holding, reference, 1)),
          .theory = fmt::format("dt^2 s + 2 dt s tau_d <= 4 with s = 4 (k + 2 kd) / m gives a stable step of "
                                "{:.3f} ms: {} sub-steps in a tick of 1 ms.",
                                1e3 * models::stable_step(patch), needed),
          .picture = std::move(picture)};
}

}  // namespace kerf::bench::cases::euler
