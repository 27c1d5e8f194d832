#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <kerf/kerf.h>

#include "laws/law_file.h"

// What a call of libkerf costs over the step of the law itself, on the same motion. scripts/benchmark library
// runs it.

namespace kerf {
namespace {

constexpr double period_s = 1e-3;
constexpr std::size_t ticks = 4096;

struct Tick {
  std::array<double, 6> position{};
  std::array<double, 6> velocity{};
};

/// In and out, along the contact of the file; of a law in space, about the place where its tissue is met.
std::vector<Tick> stroke(const bench::LawFile& file) {
  std::vector<Tick> path;
  for (std::size_t i = 0; i < ticks; ++i) {
    const double phase = 2.0 * 3.14159265358979 * static_cast<double>(i) / ticks;
    Tick tick;
    if (file.law.is_spatial()) {
      tick.position = {1e-4 * std::sin(phase), 1e-4 * std::cos(phase), -0.003 + 0.001 * std::cos(phase)};
      tick.velocity = {0.001, 0.001, 0.002 * std::sin(phase)};
    } else {
      tick.position[0] = file.contact.position + file.contact.direction * 0.1 * (1.0 - std::cos(phase));
      tick.velocity[0] = file.contact.direction * 0.1 * std::sin(phase);
    }
    path.push_back(tick);
  }
  return path;
}

std::string file_of(const std::string& model) { return KERF_SOURCE_DIR "/examples/" + model + ".law.toml"; }

/// The step of the law in C++, with its contact.
void by_law(benchmark::State& bench, const std::string& model) {
  const bench::LawFile file = bench::read_law_file(file_of(model));
  const auto path = stroke(file);
  auto state = file.law.initial_state();
  const bool spatial = file.law.is_spatial();
  std::size_t i = 0;
  for (auto _ : bench) {
    if (spatial) {
      benchmark::DoNotOptimize(
          file.law.step(state, models::SpatialMotion{path[i].position, path[i].velocity}, period_s));
    } else {
      const auto motion = file.contact.motion(path[i].position[0], path[i].velocity[0]);
      benchmark::DoNotOptimize(file.contact.force_on_axis(file.law.step(state, motion, period_s).force));
    }
    i = (i + 1) % ticks;
  }
}

/// The same by the library; `none`: without a velocity from the host.
void by_library(benchmark::State& bench, const std::string& model, bool none) {
  const auto path = stroke(bench::read_law_file(file_of(model)));
  kerf_law* law = nullptr;
  kerf_state* state = nullptr;
  if (kerf_law_open(file_of(model).c_str(), &law, nullptr, 0) != KERF_OK ||
      kerf_state_create(law, &state, nullptr, 0) != KERF_OK)
    return bench.SkipWithError("no law");
  const bool spatial = kerf_law_is_spatial(law) != 0;
  std::array<double, 6> force{};
  std::size_t i = 0;
  for (auto _ : bench) {
    if (spatial) {
      benchmark::DoNotOptimize(kerf_step_axes(
          state, path[i].position.data(), none ? nullptr : path[i].velocity.data(), period_s, force.data()));
    } else {
      benchmark::DoNotOptimize(kerf_step(state, path[i].position[0], none ? KERF_NONE : path[i].velocity[0],
                                         period_s, force.data()));
    }
    benchmark::DoNotOptimize(force);
    i = (i + 1) % ticks;
  }
  kerf_state_destroy(state);
  kerf_law_close(law);
}

const auto registered = [] {
  for (const models::LawInfo& info : models::registry()) {
    const std::string model(info.name);
    benchmark::RegisterBenchmark((model + "_law").c_str(), [model](auto& bench) { by_law(bench, model); });
    benchmark::RegisterBenchmark((model + "_library").c_str(),
                                 [model](auto& bench) { by_library(bench, model, false); });
    benchmark::RegisterBenchmark((model + "_filtered").c_str(),
                                 [model](auto& bench) { by_library(bench, model, true); });
  }
  return true;
}();

}  // namespace
}  // namespace kerf

BENCHMARK_MAIN();
