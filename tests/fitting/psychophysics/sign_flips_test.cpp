#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/random.h>
#include <kerf/psychophysics/sign_flips.h>

namespace kerf::psychophysics {
namespace {

TEST(SignFlips, AgreeWithFishersOfDarwinsMaize) {
  // [Fisher1935], section 21: of 32,768 flips 863 have a sum of 314 and more, and 1,726 one as far from 0.
  const std::vector<double> heights{49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48};
  const SignFlips found = flip_signs(heights);
  EXPECT_TRUE(found.is_exact);
  EXPECT_NEAR(found.mean, 314.0 / 15.0, 1e-12);
  EXPECT_EQ(found.p_greater, 863.0 / 32768.0);
  EXPECT_EQ(found.p_two_sided, 1726.0 / 32768.0);
}

TEST(SignFlips, CountEveryFlipOfFewValues) {
  const std::vector<double> values{3.0, 1.0, -2.0};  // sums 6 4 2 0 0 -2 -4 -6; seen 2
  EXPECT_EQ(flip_signs(values).p_greater, 3.0 / 8.0);
  EXPECT_EQ(flip_signs(values).p_two_sided, 6.0 / 8.0);
  EXPECT_EQ(flip_signs(std::vector<double>{-3.0, -1.0, 2.0}).p_greater, 6.0 / 8.0);
  EXPECT_EQ(flip_signs(std::vector<double>{0.0, 0.0}).p_greater, 1.0);
  EXPECT_EQ(flip_signs(std::vector<double>{0.25, 0.0}).p_greater, 0.5) << "a zero has no sign to be flipped";
}

TEST(SignFlips, NeedFiveSubjectsForOneSideAndSixForTwo) {
  EXPECT_EQ(flip_signs(std::vector<double>(4, 1.0)).least_p, 1.0 / 16.0);
  EXPECT_EQ(flip_signs(std::vector<double>(5, 1.0)).p_greater, 1.0 / 32.0);
  EXPECT_EQ(flip_signs(std::vector<double>(5, 1.0)).p_two_sided, 1.0 / 16.0);
  EXPECT_EQ(flip_signs(std::vector<double>(6, 1.0)).p_two_sided, 1.0 / 32.0);
}

TEST(SignFlips, AreTheBinomialTestWhereAllValuesAreEquallyLarge) {
  std::vector<double> values(20, -1.0);
  for (int i = 0; i < 15; ++i) values[static_cast<std::size_t>(i)] = 1.0;
  EXPECT_NEAR(flip_signs(values).p_greater, 0.020694732666015625, 1e-15);  // P(X >= 15) of 20
}

TEST(SignFlips, AreDrawnFromManyValuesNearTheExactShare) {
  std::vector<double> values(40, -1.0);
  for (int i = 0; i < 25; ++i) values[static_cast<std::size_t>(i)] = 1.0;
  const SignFlips found = flip_signs(values, {.samples = 99'999});
  EXPECT_FALSE(found.is_exact);
  EXPECT_NEAR(found.p_greater, 0.0769, 0.0035);  // P(X >= 25) of 40, four errors of the draw
  EXPECT_EQ(found.p_greater, flip_signs(values, {.samples = 99'999}).p_greater) << "the same seed";
}

TEST(SignFlips, AlarmAtTheirLevelHoweverUnlikeTheSubjectsAre) {
  // Values of spreads from 0.1 to 10, symmetric about 0: p lies uniformly on its steps.
  Random random(5);
  int alarms = 0;
  constexpr int studies = 4000;
  for (int study = 0; study < studies; ++study) {
    std::vector<double> values;
    for (int subject = 0; subject < 8; ++subject)
      values.push_back(random.normal() * std::pow(10.0, 2.0 * random.uniform() - 1.0));
    alarms += flip_signs(values).p_two_sided <= 0.0625 ? 1 : 0;
  }
  EXPECT_NEAR(alarms / static_cast<double>(studies), 0.0625, 4.0 * std::sqrt(0.0625 * 0.9375 / studies));
}

TEST(SignFlips, RefuseWhatIsNoValue) {
  EXPECT_THROW((void)flip_signs({}), std::invalid_argument);
  EXPECT_THROW((void)flip_signs(std::vector<double>{1.0, std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
  EXPECT_THROW((void)flip_signs(std::vector<double>{1.0}, {.samples = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
