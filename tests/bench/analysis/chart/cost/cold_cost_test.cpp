#include "chart/cost/cold_cost.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

SampledMotion press(std::size_t ticks) {
  SampledMotion path = ticks_at(1000.0, ticks);
  for (std::size_t i = 0; i < ticks; ++i) path.sample[i].position[0] = 1e-5 * static_cast<double>(i + 1);
  return path;
}

LawRendering spring_in_the_cold() {
  const double values[] = {10.0, 1.0, 1.0};
  return {models::Law::make("kelvin", values), {}, {0}};
}

TEST(ColdCost, TellsAPercentileWhereTenTicksLieBeyondIt) {
  const SampledMotion path = press(50);
  const std::vector<TimedLaw> laws{{spring_in_the_cold(), &path}};
  const ColdCost few = cold_costs(laws, {.ticks = ticks_for_p99 - 1, .told = {}}).laws.at(0);
  EXPECT_EQ(few.ticks, ticks_for_p99 - 1) << "more than the path has: it is passed several times";
  EXPECT_TRUE(std::isfinite(few.p50_ns));
  EXPECT_TRUE(std::isnan(few.p99_ns));
  const ColdCost more = cold_costs(laws, {.ticks = ticks_for_p99, .told = {}}).laws.at(0);
  EXPECT_GE(more.p99_ns, more.p50_ns);
  EXPECT_TRUE(std::isnan(more.p999_ns));
}

TEST(ColdCost, IsThatOfAnEmptyBodyToo) {
  const SampledMotion path = press(50);
  const std::vector<TimedLaw> laws{{spring_in_the_cold(), &path}, {spring_in_the_cold(), &path}};
  const ColdCosts costs = cold_costs(laws, {.ticks = 40, .told = {}});
  ASSERT_EQ(costs.laws.size(), 2U);
  EXPECT_EQ(costs.empty.ticks, 40U);
  EXPECT_GT(costs.empty.p50_ns, 0.0);
}

TEST(ColdCost, TakesNoMoreTimeThanItHasButOnePassage) {
  const SampledMotion path = press(50);
  const std::vector<TimedLaw> laws{{spring_in_the_cold(), &path}};
  EXPECT_EQ(cold_costs(laws, {.ticks = 1000, .max_seconds = 0.0, .told = {}}).laws.at(0).ticks, 50U);
}

TEST(ColdCost, SaysHowFarItIsAndStopsWithoutAResult) {
  const SampledMotion path = press(50);
  const std::vector<TimedLaw> laws{{spring_in_the_cold(), &path}};
  std::vector<double> shares;
  std::atomic<bool> stop{false};
  const ColdCostOptions options{
      .ticks = 100, .stop = &stop, .told = [&](double share) { shares.push_back(share); }};
  EXPECT_EQ(cold_costs(laws, options).laws.size(), 1U);
  EXPECT_EQ(shares, (std::vector{0.5, 1.0}));
  stop = true;
  EXPECT_TRUE(cold_costs(laws, options).laws.empty());
}

}  // namespace
}  // namespace kerf::bench
