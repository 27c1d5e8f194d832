#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <kerf/mechanisms/angle.h>
#include <kerf/models/lattice.h>
#include <kerf/models/law.h>

#include "support/example_laws.h"

// What one tick of each law costs, through the registry as the loop calls it, over a stroke that is already
// in the cache. scripts/benchmark laws runs it.

namespace kerf::models {
namespace {

constexpr double period_s = 1e-3;
constexpr std::size_t stroke_ticks = 4096;

std::vector<Motion> stroke(double reach) {
  std::vector<Motion> path;
  for (std::size_t i = 0; i < stroke_ticks; ++i) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / stroke_ticks;
    path.push_back(
        {.penetration = 0.5 * reach * (1.0 - std::cos(phase)),
         .velocity = 0.5 * reach * std::sin(phase) * 2.0 * std::numbers::pi / (period_s * stroke_ticks)});
  }
  return path;
}

void run_scalar(benchmark::State& bench, const Law& law, double reach) {
  const auto path = stroke(reach);
  auto state = law.initial_state();
  std::size_t i = 0;
  for (auto _ : bench) {
    benchmark::DoNotOptimize(law.step(state, path[i], period_s).force);
    i = (i + 1) % stroke_ticks;
  }
}

/// What was cut stays cut, so the blade goes on and on.
void run_cutting(benchmark::State& bench) {
  const Law law = test::example("fuzzy_kelvin");
  auto state = law.initial_state();
  double x = 0.0;
  for (auto _ : bench) {
    benchmark::DoNotOptimize(law.step(state, Motion{x, 2e-3}, period_s).force);
    x += 2e-6;
  }
}

void run_spatial(benchmark::State& bench, const Law& law, const std::vector<SpatialMotion>& path) {
  auto state = law.initial_state();
  std::size_t i = 0;
  for (auto _ : bench) {
    benchmark::DoNotOptimize(law.step(state, path[i], period_s).force);
    i = (i + 1) % path.size();
  }
}

Law table_of_1000() {
  std::vector<double> table;
  for (int i = 0; i < 1000; ++i) table.push_back(1.0 + std::sin(0.01 * i));
  return Law::make("recording", table, {{"points", 1000.0}, {"last", 0.4}});
}

/// The blade of [Henry2004]'s scalpel with two more sides, so that four polygons are in the tissue.
Law blade(const std::string& fidelity) {
  return Law::make(
      "blade", std::vector{5.0, 2e4, 4e3},
      {{"thresholds", false},
       {"fidelity", fidelity},
       {"polygons",
        std::string("-0.005 0.001 -0.112, 0.005 0.001 -0.112, 0.005 0.001 -0.082, -0.005 0.001 -0.082;"
                    "-0.005 -0.001 -0.112, 0.005 -0.001 -0.112, 0.005 -0.001 -0.082, -0.005 -0.001 -0.082;"
                    "-0.005 0.001 -0.112, -0.005 -0.001 -0.112, -0.005 -0.001 -0.082, -0.005 0.001 -0.082;"
                    "0.005 0.001 -0.112, 0.005 -0.001 -0.112, 0.005 -0.001 -0.082, 0.005 0.001 -0.082")}});
}
std::vector<SpatialMotion> sweep_of_blade() {
  std::vector<SpatialMotion> path;
  for (std::size_t i = 0; i < stroke_ticks; ++i) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / stroke_ticks;
    const double turn = 0.3 * std::sin(phase);
    const double rate = 0.3 * std::cos(phase) * 2.0 * std::numbers::pi / (period_s * stroke_ticks);
    path.push_back({{0.01 * std::sin(phase), 0.0, 0.1, 0.5 * turn, 0.3 * turn, turn},
                    {0.05, 0.02, 0.0, 0.5 * rate, 0.3 * rate, rate}});
  }
  return path;
}
std::vector<SpatialMotion> sweep_of_joints() {
  std::vector<SpatialMotion> path;
  for (std::size_t i = 0; i < stroke_ticks; ++i) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / stroke_ticks;
    path.push_back({{0.2 * std::sin(phase), -0.1 + 0.05 * std::cos(phase), 0.1 * std::sin(phase)},
                    {0.3 * std::cos(phase), -0.1 * std::sin(phase), 0.15 * std::cos(phase)}});
  }
  return path;
}

Law mesh(double side) {
  return Law::make("scissors_mesh", std::vector{20.0, 10.0, 1e-5, 1e-5, 1e-3, 20.0, 2e-3, 5000.0, 1e-3, 3e-4},
                   {{"columns", side}, {"rows", side}, {"edge", 0.012}, {"substeps", 4.0}});
}

/// A tick while the scissors close slowly on the slab.
void run_mesh(benchmark::State& bench, double side) {
  const Law law = mesh(side);
  auto state = law.initial_state();
  double theta = 30.0 * degree;
  for (auto _ : bench) {
    theta = theta < 10.0 * degree ? 30.0 * degree : theta - 1e-4;
    benchmark::DoNotOptimize(law.step(state, SpatialMotion{{theta, 0.0}, {-0.1, 0.0}}, period_s).force);
  }
  bench.counters["per_node_substep_ns"] = benchmark::Counter(
      side * side * 4.0 * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// The sub-step of a whole lattice alone, one coupling attached.
void run_lattice(benchmark::State& bench, int side) {
  const LatticeOptions options{.columns = side, .rows = side};
  Lattice<float> lattice(options);
  Coupling pull{.node = side * side / 2, .stiffness_n_per_m = 20.0, .target_m = {1e-3, 1e-3}};
  const double dt = 0.9 * stable_step(options);
  for (auto _ : bench) lattice.step(dt, 1, std::span(&pull, 1));
  bench.counters["per_node_substep_ns"] = benchmark::Counter(
      side * side * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// One side cut after the other, along the middle of a lattice of 100 x 100.
void run_cut(benchmark::State& bench) {
  Lattice<float> lattice({.columns = 100, .rows = 100});
  int column = 0;
  for (auto _ : bench) {
    if (column == 99) {
      bench.PauseTiming();
      lattice.reset();
      column = 0;
      bench.ResumeTiming();
    }
    const auto begin = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(lattice.cut_side(lattice.cell(column, 50), lattice.cell(column, 49)));
    bench.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    ++column;
  }
}

const auto registered = [] {
  const auto scalar = [](const char* name, Law law, double reach) {
    benchmark::RegisterBenchmark(
        name, [law = std::move(law), reach](benchmark::State& bench) { run_scalar(bench, law, reach); });
  };
  scalar("kelvin", test::example("kelvin"), 0.4);
  scalar("exponential", test::example("exponential"), 0.4);
  scalar("maxwell_2_arms", test::example("maxwell"), 0.4);
  scalar("springpot", test::example("springpot"), 0.4);
  scalar("hunt_crossley", test::example("hunt_crossley"), 0.4);
  scalar("friction", test::example("friction"), 0.4);
  scalar("precontact", test::example("precontact"), 0.02);
  scalar("fracture", test::example("fracture"),
         0.07);  // short of the yield point, where each tick has its exponential
  scalar("scissors_analytic", test::example("scissors_analytic"), 0.4);
  scalar("piecewise", test::example("piecewise"), 0.4);
  scalar("recording_1000", table_of_1000(), 0.4);
  benchmark::RegisterBenchmark("fuzzy_kelvin_9_rules", run_cutting);
  const auto spatial = [](const char* name, Law law, std::vector<SpatialMotion> path) {
    benchmark::RegisterBenchmark(name, [law = std::move(law), path = std::move(path)](
                                           benchmark::State& bench) { run_spatial(bench, law, path); });
  };
  spatial("blade_exact_4_polygons", blade("exact"), sweep_of_blade());
  spatial("blade_strips_16_4_polygons", blade("strips"), sweep_of_blade());
  spatial("blade_paper_16_4_polygons", blade("paper"), sweep_of_blade());
  for (const char* projection : {"consistent", "paper"}) {
    const Law law = Law::make("orthogonal", std::vector{0.1, 5.0, 2.0, 0.06},
                              {{"projection", std::string(projection)}, {"point", std::string("0 0.2 0")}});
    spatial(projection == std::string("paper") ? "orthogonal_paper" : "orthogonal_consistent", law,
            sweep_of_joints());
  }
  benchmark::RegisterBenchmark("lattice_100x100", [](benchmark::State& bench) { run_lattice(bench, 100); });
  benchmark::RegisterBenchmark("scissors_mesh_100x100",
                               [](benchmark::State& bench) { run_mesh(bench, 100.0); });
  benchmark::RegisterBenchmark("scissors_mesh_142x142",
                               [](benchmark::State& bench) { run_mesh(bench, 142.0); });
  benchmark::RegisterBenchmark("cut_side_100x100", run_cut)->UseManualTime();
  return true;
}();

}  // namespace
}  // namespace kerf::models

BENCHMARK_MAIN();
