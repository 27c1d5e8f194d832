#include "starts/prony.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "starts/scan.h"

namespace kerf::fitting {
namespace {

/// A ramp of a tenth of a second, and a hold, of a Maxwell law at 100 Hz.
struct Held {
  std::vector<double> time_s, penetration, velocity, force;

  explicit Held(const models::Law& law) {
    models::Law::State state = law.initial_state();
    for (int i = 0; i <= 1000; ++i) {
      time_s.push_back(0.01 * i);
      penetration.push_back(std::min(0.1 * i, 1.0));
      velocity.push_back(i <= 10 ? 10.0 : 0.0);
      force.push_back(law.step(state, models::Motion{penetration.back(), velocity.back()}, 0.01).force);
    }
  }
  [[nodiscard]] Samples samples() const {
    const Series series{
        .time_s = time_s, .penetration = penetration, .velocity = velocity, .force = force, .cycle = {}};
    return check_series(std::span(&series, 1), {});
  }
};

Problem maxwell(double arms) {
  const models::Options options{{"arms", arms}};
  const auto parameters = models::Law::parameters("maxwell", options);
  return {.model = "maxwell", .law_options = options, .parameters = parameters};
}

/// The relaxation times of each family, from that which leaves least.
std::vector<std::vector<double>> times_of(const std::vector<double>& law_values, double arms) {
  const Samples samples = Held(models::Law::make("maxwell", law_values, {{"arms", arms}})).samples();
  std::vector<std::vector<double>> times;
  for (const LinearFamily& family : prony_families(maxwell(arms), samples, all_of(samples))) {
    const auto tail = family.base.tail(static_cast<Eigen::Index>(arms));
    times.emplace_back(tail.begin(), tail.end());
  }
  return times;
}

// Two samples to twice the duration: 12 times from 0.02 to 20 s, each a ratio of 1000^(1/11) after the last.
double time_of_grid(int place) { return 0.02 * std::pow(1000.0, place / 11.0); }

TEST(PronyStarts, BeginWithTheTimesThatMadeTheForce) {
  for (const int place : {0, 4, 11}) {
    const auto times = times_of({5.0, 8.0, time_of_grid(place)}, 1.0);
    ASSERT_FALSE(times.empty());
    EXPECT_NEAR(times[0][0] / time_of_grid(place), 1.0, 1e-9);
  }
  const auto times = times_of({5.0, 8.0, 12.0, time_of_grid(2), time_of_grid(7)}, 2.0);
  ASSERT_FALSE(times.empty());
  EXPECT_NEAR(times[0][0] / time_of_grid(2), 1.0, 1e-9);
  EXPECT_NEAR(times[0][1] / time_of_grid(7), 1.0, 1e-9);
}

TEST(PronyStarts, LeaveNothingOfAForceThatOneOfTheirFamilyMade) {
  const std::vector<double> law{5.0, 8.0, time_of_grid(4)};
  const Samples samples = Held(models::Law::make("maxwell", law, {{"arms", 1.0}})).samples();
  const Problem problem = maxwell(1.0);
  const auto families = prony_families(problem, samples, all_of(samples));
  ASSERT_FALSE(families.empty());
  const Start start = best_of_family(problem, samples, all_of(samples), families[0]);
  EXPECT_NEAR(start.values[0], 5.0, 1e-6);
  EXPECT_NEAR(start.values[1], 8.0, 1e-6);
  EXPECT_NEAR(start.sum_of_squares, 0.0, 1e-6);
}

TEST(PronyStarts, BeginBesideATimeThatLiesBetweenTwo) {
  const double between = std::sqrt(time_of_grid(5) * time_of_grid(6));
  const auto times = times_of({5.0, 8.0, between}, 1.0);
  ASSERT_GE(times.size(), 2U);
  EXPECT_THAT((std::vector{times[0][0], times[1][0]}),
              testing::UnorderedElementsAre(testing::DoubleNear(time_of_grid(5), 1e-9),
                                            testing::DoubleNear(time_of_grid(6), 1e-9)));
}

TEST(PronyStarts, AreSixSetsOfDifferentTimes) {
  for (const double arms : {1.0, 3.0}) {
    std::vector<double> values{5.0};
    values.insert(values.end(), static_cast<std::size_t>(arms), 8.0);
    for (int arm = 0; arm < static_cast<int>(arms); ++arm) values.push_back(time_of_grid(2 + 3 * arm));
    const auto sets = times_of(values, arms);
    EXPECT_EQ(sets.size(), 6U);
    for (const auto& set : sets) {
      EXPECT_TRUE(std::ranges::is_sorted(set, std::ranges::less_equal())) << "no time twice";
    }
    EXPECT_EQ(std::set(sets.begin(), sets.end()).size(), sets.size());
  }
}

}  // namespace
}  // namespace kerf::fitting
