#include "chart/cost/tick_cost.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

/// A blade that goes back and forth in the tissue and turns about itself.
SampledMotion strokes_of_a_blade(std::size_t ticks) {
  SampledMotion path = ticks_at(1000.0, ticks);
  for (std::size_t i = 0; i < ticks; ++i) {
    const double phase = 0.01 * static_cast<double>(i);
    path.sample[i].position = {0.02 * std::sin(phase), 0.0, 0.1, 0.0, 0.0, 0.2 * std::sin(phase)};
    path.sample[i].velocity = {0.2 * std::cos(phase), 0.0, 0.0, 0.0, 0.0, 2.0 * std::cos(phase)};
  }
  return path;
}

LawRendering blade_of(const std::string& fidelity, double strips) {
  const double values[] = {5.0, 2e4, 4e3};
  return {
      models::Law::make("blade", values, {{"thresholds", false}, {"fidelity", fidelity}, {"strips", strips}}),
      {},
      {0, 1, 2, 3, 4, 5}};
}

LawRendering spring() {
  const double values[] = {10.0, 1.0, 1.0};
  return {models::Law::make("kelvin", values), {}, {0}};
}

TEST(TickCost, IsGreaterForALawThatDoesMore) {
  const auto path = strokes_of_a_blade(500);
  const std::vector<TimedLaw> laws{{blade_of("strips", 256.0), &path}, {spring(), &path}};
  const auto costs = tick_costs(laws, {.rounds = 3, .cold_ticks = ticks_for_p99, .told = {}});
  ASSERT_EQ(costs.size(), 2U);
  EXPECT_GT(costs[0].p50_ns, costs[1].p50_ns);
  EXPECT_GT(costs[1].mean_rounds, 0.0);
  EXPECT_GT(costs[0].mean_rounds, costs[1].mean_rounds);
  for (const TickCost& cost : costs) {
    EXPECT_LE(cost.p50_ns, cost.p999_ns);
    EXPECT_LE(cost.cold.p50_ns, cost.cold.p99_ns);
    EXPECT_GE(cost.p50_ns, 0.0);
  }
}

TEST(TickCost, KeepsTheOrderInWhichLawsWereGiven) {
  const auto path = strokes_of_a_blade(300);
  const std::vector<TimedLaw> laws{{spring(), &path}, {blade_of("strips", 256.0), &path}, {spring(), &path}};
  const auto costs = tick_costs(laws, {.rounds = 2, .cold_ticks = 0, .told = {}});
  ASSERT_EQ(costs.size(), 3U);
  EXPECT_GT(costs[1].p50_ns, costs[0].p50_ns);
  EXPECT_GT(costs[1].p50_ns, costs[2].p50_ns);
  EXPECT_TRUE(std::isnan(costs[0].cold.p50_ns)) << "no cold tick was asked for";
}

TEST(TickCost, TimesALawThatNeverPushes) {
  SampledMotion in_the_air = ticks_at(1000.0, 100);
  for (models::SpatialMotion& sample : in_the_air.sample) sample.position[0] = -1.0;
  const std::vector<TimedLaw> laws{{spring(), &in_the_air}};
  const auto costs = tick_costs(laws, {.rounds = 1, .cold_ticks = 4, .told = {}});
  ASSERT_EQ(costs.size(), 1U);
  EXPECT_TRUE(std::isfinite(costs[0].p50_ns) && std::isfinite(costs[0].cold.p50_ns));
}

TEST(TickCost, SaysHowFarItIsAndStopsWithoutAResult) {
  const auto path = strokes_of_a_blade(50);
  const std::vector<TimedLaw> laws{{spring(), &path}, {spring(), &path}};
  std::atomic<bool> stop{false};
  std::vector<double> shares;
  const TickCostOptions options{
      .rounds = 2, .cold_ticks = 4, .stop = &stop, .told = [&](double share) { shares.push_back(share); }};
  EXPECT_EQ(tick_costs(laws, options).size(), 2U);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
  stop = true;
  EXPECT_TRUE(tick_costs(laws, options).empty());
}

TEST(TickCost, RefusesAPathWithoutSamplesAndAPeriodThatIsNotPositive) {
  const SampledMotion nothing;
  const std::vector<TimedLaw> no_path{{spring(), &nothing}};
  EXPECT_THROW((void)tick_costs(no_path), std::invalid_argument);
  SampledMotion path = strokes_of_a_blade(2);
  path.period_s[1] = 0.0;
  const std::vector<TimedLaw> no_period{{spring(), &path}};
  EXPECT_THROW((void)tick_costs(no_period), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
