#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/law.h>

namespace kerf::models {
namespace {

constexpr double period_s = 1e-3;
constexpr int ticks = 2000;
constexpr double outside =
    5e-3;  ///< where a path begins and ends, before the tissue and what leads up to it [m]

/// A closed path in and out of the tissue: a few sines with random amplitudes and phases, begun and ended at
/// rest outside.
std::vector<Motion> closed_path(unsigned seed, double reach) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::array<double, 4> amplitude{};
  std::array<double, 4> phase{};
  for (std::size_t k = 0; k < 4; ++k) {
    amplitude[k] = reach * uniform(random) / static_cast<double>(k + 1);
    phase[k] = 2.0 * std::numbers::pi * uniform(random);
  }
  std::vector<Motion> path;
  for (int tick = 0; tick <= ticks; ++tick) {
    const double t = static_cast<double>(tick) / ticks;
    const double window = std::sin(std::numbers::pi * t) * std::sin(std::numbers::pi * t);
    double x = 0.5 * reach;
    for (std::size_t k = 0; k < 4; ++k) {
      x += amplitude[k] * std::sin(2.0 * std::numbers::pi * static_cast<double>(k + 1) * t + phase[k]);
    }
    path.push_back({.penetration = window * (x + outside) - outside, .velocity = 0.0});
  }
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    path[i].velocity = (path[i + 1].penetration - path[i - 1].penetration) / (2.0 * period_s);
  }
  return path;
}

struct Energy {
  double least = 0.0;     ///< lowest that the energy taken in ever fell
  double turnover = 0.0;  ///< sum of what went in and out
};

/// Energy that a law takes in along a path. `held`: the force of a tick acts until the next one, as a loop
/// holds it; else the force of the law itself, by the trapezoid.
Energy along(const Law& law, const std::vector<Motion>& path, bool held) {
  auto state = law.initial_state();
  Energy energy;
  double sum = 0.0;
  double before = law.step(state, path[0], period_s).force;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double force = law.step(state, path[i], period_s).force;
    const double part =
        (held ? before : 0.5 * (before + force)) * (path[i].penetration - path[i - 1].penetration);
    before = force;
    sum += part;
    energy.turnover += std::abs(part);
    energy.least = std::min(energy.least, sum);
  }
  return energy;
}

/// `fracture` keeps books of its own, which fracture_test.cpp holds it to: a force that drops to zero within
/// a tick has no trapezoid.
std::vector<Law> passive_laws() {
  std::vector<Law> laws;
  laws.push_back(Law::make("kelvin", std::vector{8.0, 7.0, 130.0}));
  laws.push_back(Law::make("kelvin", std::vector{400.0, 300.0, 0.5}));
  laws.push_back(Law::make("maxwell", std::vector{8.0, 300.0, 20.0, 7.0, 0.003, 0.1, 2.0}, {{"arms", 3.0}}));
  laws.push_back(Law::make("springpot", std::vector{8.0, 20.0, 0.3}));
  laws.push_back(Law::make("hunt_crossley", std::vector{0.5, 0.4, 1.5}));
  laws.push_back(Law::make("friction", std::vector{0.0, 0.0, 0.5, 0.8, 5e-4}));
  laws.push_back(Law::make("exponential", std::vector{0.02, 3.0, 0.4}, {{"thickness", 0.03}}));
  laws.push_back(Law::make("precontact", std::vector{300.0, 0.002}));
  laws.push_back(Law::make("exponential", std::vector{0.02, 3.0, 0.0},
                           {{"thickness", 0.03}, {"zero_at_contact", true}}));
  laws.push_back(Law::make("scissors_analytic", std::vector{0.003, 0.4, 6.0}));
  laws.push_back(Law::make("piecewise", std::vector{0.0, 0.01, 0.03, 0.0, 1.0, 1.5}, {{"segments", 2.0}}));
  laws.push_back(Law::make("fuzzy_kelvin", std::vector{30.0, 20.0, 5.0, 0.0, 0.02, 0.0, 0.1, 5.0, 1.0, 0.05},
                           {{"memberships", 1.0}}));
  return laws;
}

TEST(Passivity, NoPassiveLawGivesMoreEnergyThanItTookOverAThousandClosedPaths) {
  for (const Law& law : passive_laws()) {
    double worst = 0.0;
    for (unsigned seed = 0; seed < 1000; ++seed) {
      const Energy energy = along(law, closed_path(seed, 0.03), false);
      worst = std::max(worst, -energy.least / (energy.turnover + 1e-6));
    }
    // The trapezoid over the tick in which contact begins or ends is not the law's own work.
    EXPECT_LE(worst, 1e-4) << law.model() << ": share of the turnover that came out and had not gone in";
  }
}

TEST(Passivity, HeldByALoopAnElasticLawGivesOutALittle) {
  // The finding behind virtual walls that buzz: half a tick of delay. Printed, so that nobody takes the laws'
  // passivity for that of the loop.
  for (const Law& law : passive_laws()) {
    double worst = 0.0;
    for (unsigned seed = 0; seed < 1000; ++seed) {
      const Energy energy = along(law, closed_path(seed, 0.03), true);
      worst = std::max(worst, -energy.least / (energy.turnover + 1e-6));
    }
    std::cout << "held at 1 kHz, " << law.model() << " gives out up to " << 100.0 * worst
              << " % of its turnover\n";
    if (law.model() == "precontact" || law.model() == "piecewise") {
      EXPECT_GT(worst, 1e-4) << law.model();
    }
  }
}

TEST(Passivity, KelvinTakesInEnergyAtEveryPeriod) {
  const Law law = Law::make("kelvin", std::vector{400.0, 300.0, 0.5});
  for (const double period : {1e-5, 1e-3, 1e-2, 0.1, 1.0}) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> step(0.0, 1e-3);
    auto state = law.initial_state();
    double x = 0.05;
    double before = law.step(state, Motion{x, 0.0}, period).force;
    // It begins compressed, with the parallel spring's energy in it.
    double sum = 0.5 * 400.0 * x * x;
    for (int tick = 0; tick < 20000; ++tick) {
      const double next = std::clamp(x + step(random), 0.0, 0.1);
      const double force = law.step(state, Motion{next, 0.0}, period).force;
      sum += 0.5 * (before + force) * (next - x);
      before = force;
      x = next;
      ASSERT_GE(sum, -1e-12) << period << ' ' << tick;
    }
  }
}

}  // namespace
}  // namespace kerf::models
