#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/population/compare.h>
#include <kerf/psychophysics/random.h>

#include "drawer.h"

namespace kerf::population {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::vector<double> values_of(const Group& group, double more) {
  std::vector<double> values;
  for (const Estimate& one : group) values.push_back(one.value + more);
  return values;
}

/// A blank whose error goes into every value of a group as it is: `of_cycles` are the blank's cycles.
Shared shared_mean(const Group& group, const std::vector<double>& of_cycles) {
  double sum = 0.0;
  for (const double one : of_cycles) sum += one;
  const auto n = static_cast<double>(of_cycles.size());
  Shared shared;
  for (const double one : of_cycles)
    shared.without.push_back(values_of(group, (sum - one) / (n - 1.0) - sum / n));
  return shared;
}

Group specimens_of_mean(std::initializer_list<double> values) {
  Group group;
  for (const double value : values)
    group.push_back({.value = value, .standard_error = {}, .specimen = std::to_string(group.size())});
  return group;
}

// The jackknife of a mean is its standard error: s / sqrt(n), here 0.2 / sqrt(4) of 1.0, 1.2, 1.4, ... by
// hand.
TEST(Shared, HasTheStandardErrorOfTheMeanThatWasTakenOff) {
  const Group group = specimens_of_mean({1.0, 2.5, 0.3, 1.7, 2.2});
  const std::vector<Shared> shared{shared_mean(group, {0.1, 0.5, 0.3, 0.7})};
  const GroupEstimate alone = estimate_group(group);
  const GroupEstimate both = estimate_group(group, {.shared = shared});
  const double squares = (0.09 + 0.01 + 0.01 + 0.09) / 3.0 / 4.0;
  ASSERT_TRUE(both.shared_error);
  EXPECT_NEAR(both.shared_error->standard_error, std::sqrt(squares), 1e-12);
  EXPECT_DOUBLE_EQ(both.shared_error->degrees_of_freedom, 3.0);
  EXPECT_DOUBLE_EQ(*both.mean, *alone.mean);
  const double own = 0.803 / 5.0;
  EXPECT_NEAR(*both.standard_error, std::sqrt(own + squares), 1e-9);
  // Student's t of Welch and Satterthwaite's 4.8 degrees of freedom; R: qt(0.975, df).
  const double degrees = (own + squares) * (own + squares) / (own * own / 4.0 + squares * squares / 3.0);
  EXPECT_NEAR(degrees, 4.80431, 1e-5);
  EXPECT_NEAR(both.interval->upper - *both.mean, 2.60240 * std::sqrt(own + squares), 1e-5);
  EXPECT_GT(both.of_the_next->upper, alone.of_the_next->upper);
  EXPECT_DOUBLE_EQ(both.together->value, alone.together->value) << "what all share is in no spread";
}

TEST(Shared, OfTwoBlanksHasTheErrorsOfBoth) {
  const Group group = specimens_of_mean({1.0, 2.5, 0.3, 1.7});
  const std::vector<Shared> shared{shared_mean(group, {0.1, 0.5, 0.3}), shared_mean(group, {0.0, 0.3})};
  const GroupEstimate both = estimate_group(group, {.shared = shared});
  EXPECT_NEAR(both.shared_error->standard_error, std::sqrt(0.04 / 3.0 + 0.045 / 2.0), 1e-12);
}

TEST(Shared, IsUnknownWhereAPartIs) {
  const Group group = specimens_of_mean({1.0, 2.5, 0.3, 1.7});
  std::vector<Shared> shared{shared_mean(group, {0.1, 0.5, 0.3})};
  shared[0].without[1][2] = unknown;
  const GroupEstimate lacking = estimate_group(group, {.shared = shared});
  EXPECT_TRUE(lacking.mean);
  EXPECT_FALSE(lacking.shared_error);
  EXPECT_FALSE(lacking.interval);
  shared[0].without = {values_of(group, 0.0)};
  EXPECT_FALSE(estimate_group(group, {.shared = shared}).interval) << "one part tells no error";
  shared[0].without = {{1.0, 2.0}, {1.0, 2.0}};
  EXPECT_THROW((void)estimate_group(group, {.shared = shared}), std::invalid_argument);
}

TEST(Shared, CancelsInADifferenceWithinSpecimens) {
  const Group slow = specimens_of_mean({1.0, 2.5, 0.3, 1.7});
  const Group fast = specimens_of_mean({1.3, 2.9, 0.5, 2.1});
  const std::vector<double> cycles{0.1, 0.5, 0.3, 0.7};
  const Pair one_blank{.first = fast,
                       .second = slow,
                       .shared = {{.first = shared_mean(fast, cycles), .second = shared_mean(slow, cycles)}}};
  const Comparison same = compare(std::vector{one_blank}).front();
  EXPECT_TRUE(same.is_crossed);
  EXPECT_NEAR(same.shared_error->standard_error, 0.0, 1e-12);
  const Pair own{.first = fast, .second = slow};
  EXPECT_NEAR(same.interval->lower, compare(std::vector{own}).front().interval->lower, 1e-9);
  const std::vector<double> still(cycles.size(), 0.0);
  const Pair two_blanks{.first = fast,
                        .second = slow,
                        .shared = {{.first = shared_mean(fast, cycles), .second = shared_mean(slow, still)},
                                   {.first = shared_mean(fast, still), .second = shared_mean(slow, cycles)}}};
  EXPECT_NEAR(compare(std::vector{two_blanks}).front().shared_error->standard_error,
              std::sqrt(2.0 * 0.2 / 3.0 / 4.0), 1e-12);
}

/// A study of eight specimens whose blank of six cycles has an error of 0.1, as large as their spread; in
/// another speed another blank.
struct Blanks {
  int holds = 0;          ///< the interval that knows of the blank
  int holds_without = 0;  ///< and that does not
  int alarms = 0;         ///< "differ" between two speeds that are alike
  int alarms_without = 0;
};

Blanks studied(int studies, std::uint64_t seed) {
  psychophysics::Random random(seed);
  Blanks found;
  CompareOptions options{.draws = 199, .most_exact = 300};
  for (int study = 0; study < studies; ++study) {
    std::vector<Group> speeds(2);
    std::vector<std::vector<double>> cycles(2);
    for (std::size_t speed = 0; speed < 2; ++speed)
      for (int i = 0; i < 6; ++i) cycles[speed].push_back(0.1 * std::sqrt(6.0) * random.normal());
    for (int specimen = 0; specimen < 8; ++specimen) {
      const double own = 0.1 * random.normal();
      for (std::size_t speed = 0; speed < 2; ++speed) {
        double blank = 0.0;
        for (const double one : cycles[speed]) blank += one / 6.0;
        speeds[speed].push_back({.value = own + blank + 0.05 * random.normal(),
                                 .standard_error = 0.05,
                                 .specimen = std::to_string(specimen)});
      }
    }
    const std::vector<Shared> shared{shared_mean(speeds[0], cycles[0])};
    found.holds += holds(*estimate_group(speeds[0], {.shared = shared}).interval, 0.0) ? 1 : 0;
    found.holds_without += holds(*estimate_group(speeds[0]).interval, 0.0) ? 1 : 0;
    const std::vector<double> still(6, 0.0);
    const Pair unknowing{.first = speeds[0], .second = speeds[1]};
    Pair pair = unknowing;
    pair.shared = {{.first = shared.front(), .second = shared_mean(speeds[1], still)},
                   {.first = shared_mean(speeds[0], still), .second = shared_mean(speeds[1], cycles[1])}};
    options.seed = seed + 1000 * static_cast<std::uint64_t>(study);
    found.alarms += compare(std::vector{pair}, options).front().verdict == Verdict::differ ? 1 : 0;
    found.alarms_without +=
        compare(std::vector{unknowing}, options).front().verdict == Verdict::differ ? 1 : 0;
  }
  return found;
}

// The bounds are exact 99.9 % intervals of 95 % (and of 5 %) of 300.
TEST(Shared, IsHeldByIntervalsOverSpecimensAndRaisesFewAlarms) {
  const Blanks found = studied(300, 11);
  EXPECT_GE(found.holds, 271);
  EXPECT_LT(found.holds_without, 240) << "a blank's error is in no spread between specimens";
  EXPECT_LE(found.alarms, 29);
  EXPECT_GT(found.alarms_without, 60) << "speeds with blanks of their own differ by the blanks' errors";
}

}  // namespace
}  // namespace kerf::population
