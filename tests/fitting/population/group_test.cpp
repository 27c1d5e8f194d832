#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include <kerf/population/group.h>

namespace kerf::population {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Estimate of(double value, std::optional<double> error, std::optional<std::string> specimen) {
  return {.value = value, .standard_error = error, .specimen = std::move(specimen)};
}

std::vector<Estimate> once_each(std::initializer_list<double> values) {
  std::vector<Estimate> estimates;
  for (const double value : values) estimates.push_back(of(value, {}, std::to_string(estimates.size())));
  return estimates;
}

/// Two recordings of each of three specimens, without known errors.
std::vector<Estimate> balanced() {
  return {of(1.0, {}, "a"), of(1.2, {}, "a"), of(1.7, {}, "b"),
          of(1.5, {}, "b"), of(0.6, {}, "c"), of(0.8, {}, "c")};
}

TEST(Group, CountsSpecimensWhereEachWasRecordedOnce) {
  const GroupEstimate group = estimate_group(once_each({1.0, 2.5, 0.3, 1.7, 2.2}));
  // Student's interval of five values: 1.54 +- 2.776445 sqrt(0.803 / 5).
  EXPECT_NEAR(*group.mean, 1.54, 1e-12);
  EXPECT_NEAR(group.interval->upper, 1.54 + 2.77644510519779 * std::sqrt(0.803 / 5.0), 1e-9);
  EXPECT_EQ(group.degrees_of_freedom, 4);
  EXPECT_FALSE(group.between_specimens) << "a spread between recordings may be all of it";
  EXPECT_FALSE(group.between_recordings);
  EXPECT_NEAR(group.together->value, std::sqrt(0.803), 1e-9);
  // 4 x 0.803 / chi^2_4: R's qchisq(c(0.975, 0.025), 4).
  EXPECT_NEAR(group.together->interval->lower, std::sqrt(4.0 * 0.803 / 11.1432867818778), 1e-8);
  EXPECT_NEAR(group.together->interval->upper, std::sqrt(4.0 * 0.803 / 0.484418557087993), 1e-8);
}

TEST(Group, TellsWhereTheNextOfNormalValuesWillLie) {
  const GroupEstimate group = estimate_group(once_each({1.0, 2.5, 0.3, 1.7, 2.2}));
  const double half = 2.77644510519779 * std::sqrt(0.803 * (1.0 + 1.0 / 5.0));
  EXPECT_NEAR(group.of_the_next->lower, 1.54 - half, 1e-3 * half);
  EXPECT_NEAR(group.of_the_next->upper, 1.54 + half, 1e-3 * half);
}

TEST(Group, CountsSpecimensAndNotRecordings) {
  std::vector<Estimate> estimates = balanced();
  const GroupEstimate twice = estimate_group(estimates);
  // Means of specimens 1.1, 1.6, 0.7: Student's interval of three values.
  EXPECT_NEAR(twice.interval->upper - *twice.mean, 4.30265272974946 * std::sqrt(0.61 / 3.0 / 3.0), 1e-9);
  // Within: 3 x 0.02 / 3; between: 0.61 / 3 - 0.02 / 2 (analysis of variance).
  EXPECT_NEAR(std::pow(twice.between_recordings->value, 2), 0.02, 1e-9);
  EXPECT_NEAR(std::pow(twice.between_specimens->value, 2), 0.61 / 3.0 - 0.01, 1e-9);
  for (int i = 0; i < 3; ++i) {
    for (const Estimate& estimate : balanced()) estimates.push_back(estimate);
  }
  const GroupEstimate often = estimate_group(estimates);
  EXPECT_EQ(often.recordings, 24U);
  EXPECT_NEAR(often.interval->upper, twice.interval->upper, 1e-9) << "more recordings are no more specimens";
}

TEST(Group, KnowsTheSpreadOfRecordingsByAnExactInterval) {
  const Spread within = *estimate_group(balanced()).between_recordings;
  // 0.06 / chi^2_3: R's qchisq(c(0.975, 0.025), 3).
  EXPECT_NEAR(within.interval->lower, std::sqrt(0.06 / 9.34840360449615), 1e-8);
  EXPECT_NEAR(within.interval->upper, std::sqrt(0.06 / 0.215795282623898), 1e-8);
}

TEST(Group, KnowsNothingOfOthersFromOneSpecimen) {
  const GroupEstimate group = estimate_group(std::vector{of(1.0, 0.1, "a"), of(2.0, 0.1, "a")});
  EXPECT_NEAR(*group.mean, 1.5, 1e-12);
  EXPECT_EQ(group.specimens, 1U);
  EXPECT_FALSE(group.standard_error);
  EXPECT_FALSE(group.interval);
  EXPECT_FALSE(group.between_specimens);
  EXPECT_FALSE(group.of_the_next);
  EXPECT_NEAR(group.of_this_specimen->upper, 1.5 + 12.7062047361747 * 0.5, 1e-8);
  EXPECT_NEAR(std::pow(group.between_recordings->value, 2), 0.5 - 0.01, 1e-9);
}

TEST(Group, KnowsAMeanAloneFromOneRecording) {
  const GroupEstimate group = estimate_group(std::vector{of(1.0, 0.1, "a")});
  EXPECT_EQ(*group.mean, 1.0);
  EXPECT_FALSE(group.interval);
  EXPECT_FALSE(group.of_this_specimen);
  EXPECT_FALSE(group.between_recordings);
  EXPECT_FALSE(estimate_group(std::vector<Estimate>{}).mean);
}

TEST(Group, CountsRecordingsWhereASpecimenIsUnknown) {
  std::vector<Estimate> estimates = balanced();
  estimates[3].specimen.reset();
  const GroupEstimate group = estimate_group(estimates);
  EXPECT_EQ(group.unit, Unit::recordings);
  EXPECT_FALSE(group.specimens);
  EXPECT_EQ(group.degrees_of_freedom, 5);
  EXPECT_TRUE(group.together);
  EXPECT_FALSE(group.between_specimens);
}

TEST(Group, LeavesOutWhatHasNoLimit) {
  std::vector<Estimate> estimates = balanced();
  estimates.push_back(of(50.0, infinity, "d"));
  estimates.push_back(of(std::nan(""), 0.1, "d"));
  const GroupEstimate group = estimate_group(estimates);
  EXPECT_EQ(group.left_out, 2U);
  EXPECT_EQ(group.recordings, 6U);
  EXPECT_EQ(group.specimens, 3U);
  EXPECT_NEAR(*group.mean, *estimate_group(balanced()).mean, 1e-12);
}

TEST(Group, UsesNoStandardErrorWhereOneIsUnknown) {
  std::vector<Estimate> estimates = balanced();
  for (std::size_t i = 1; i < estimates.size(); ++i) estimates[i].standard_error = 0.01;
  const GroupEstimate group = estimate_group(estimates);
  EXPECT_FALSE(group.has_standard_errors);
  EXPECT_NEAR(group.between_recordings->value, estimate_group(balanced()).between_recordings->value, 1e-12);
}

TEST(Group, LeavesRoomForASpreadThatDoesNotShow) {
  // Specimens more alike than their recordings would have them by chance.
  const std::vector<Estimate> alike{of(1.9, 0.05, "a"), of(2.11, 0.05, "a"), of(1.92, 0.05, "b"),
                                    of(2.1, 0.05, "b"), of(2.13, 0.05, "c"), of(1.89, 0.05, "c")};
  const Spread between = *estimate_group(alike).between_specimens;
  EXPECT_EQ(between.value, 0.0);
  EXPECT_EQ(between.interval->lower, 0.0);
  EXPECT_GT(between.interval->upper, 0.1);
}

TEST(Group, DoesNotDependOnUnitOrOrder) {
  std::vector<Estimate> estimates = balanced();
  const GroupEstimate group = estimate_group(estimates);
  for (Estimate& estimate : estimates) estimate.value = 1e6 * estimate.value + 3e7;
  std::swap(estimates[0], estimates[5]);
  const GroupEstimate other = estimate_group(estimates);
  EXPECT_NEAR(other.interval->lower, 1e6 * group.interval->lower + 3e7, 1e-2);
  EXPECT_NEAR(other.between_specimens->interval->upper, 1e6 * group.between_specimens->interval->upper, 1.0);
}

TEST(Group, TakesEqualValuesAsTheyAre) {
  const GroupEstimate group = estimate_group(once_each({2.0, 2.0, 2.0}));
  EXPECT_EQ(group.interval->lower, 2.0);
  EXPECT_EQ(group.together->value, 0.0);
}

TEST(Group, RefusesWhatCannotBe) {
  EXPECT_THROW((void)estimate_group(std::vector{of(1.0, -0.1, "a")}), std::invalid_argument);
  EXPECT_THROW((void)estimate_group(std::vector{of(1.0, std::nan(""), "a")}), std::invalid_argument);
  EXPECT_THROW((void)estimate_group(balanced(), {.confidence = 1.0}), std::invalid_argument);
  EXPECT_THROW((void)log_of(of(0.0, 0.1, "a")), std::invalid_argument);
}

TEST(LogOf, HasTheRelativeError) {
  const Estimate estimate = log_of(of(200.0, 10.0, "a"));
  EXPECT_NEAR(estimate.value, 5.298317366548036, 1e-14);
  EXPECT_NEAR(*estimate.standard_error, 0.05, 1e-15);
  EXPECT_EQ(*log_of(of(200.0, infinity, "a")).standard_error, infinity);
}

}  // namespace
}  // namespace kerf::population
