#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/homogeneity.h>
#include <kerf/psychophysics/random.h>

namespace kerf::psychophysics {
namespace {

// Fisher [Fisher1935]: the lady who tastes tea, three of four cups right on each side. R: fisher.test,
// two-sided.
TEST(EqualProportions, AgreeWithTheLadyTastingTea) {
  EXPECT_NEAR(equal_proportions(std::vector<Count>{{3, 4}, {1, 4}}).p, 0.4857, 5e-5);
}

// Fisher [Fisher1962]: convictions of like-sex twins of criminals, 2 of 17 and 10 of 13. R: p = 0.0005367.
TEST(EqualProportions, AgreeWithFishersTwins) {
  EXPECT_NEAR(equal_proportions(std::vector<Count>{{2, 17}, {10, 13}}).p, 0.0005367, 5e-8);
}

// By hand: 3, 1 and 2 of 4. Of the 924 ways to place six successes 216 are those of the likelier table 2, 2,
// 2.
TEST(EqualProportions, AddUpAllTablesOfThreeGroups) {
  const Homogeneity found = equal_proportions(std::vector<Count>{{3, 4}, {1, 4}, {2, 4}});
  EXPECT_NEAR(found.p, 708.0 / 924.0, 1e-12);
  EXPECT_TRUE(found.is_exact);
  EXPECT_EQ(found.degrees_of_freedom, 2);
  EXPECT_NEAR(found.statistic, 2.0, 1e-12);
}

TEST(EqualProportions, OfManyGroupsAreDrawn) {
  const std::vector<Count> alike(12, Count{.successes = 10, .trials = 20});
  const Homogeneity same = equal_proportions(alike);
  EXPECT_FALSE(same.is_exact);
  EXPECT_DOUBLE_EQ(same.p, 1.0);
  std::vector<Count> apart = alike;
  for (std::size_t i = 0; i < 6; ++i) apart[i].successes = 18;
  EXPECT_DOUBLE_EQ(equal_proportions(apart).p, 1.0 / 5000.0);
}

TEST(EqualProportions, RaiseFalseAlarmsNoMoreOftenThanTheySay) {
  Random random(4);
  int alarms = 0;
  for (int experiment = 0; experiment < 400; ++experiment) {
    std::vector<Count> groups(5, Count{.trials = 12});
    for (Count& group : groups) group.successes = random.successes(12, 0.7);
    alarms += equal_proportions(groups).p <= 0.05 ? 1 : 0;
  }
  EXPECT_LE(alarms, 32);  // 8 %: three standard deviations over 5 %
  EXPECT_GE(alarms, 6);
}

TEST(EqualProportions, HaveNothingToCompareInOneGroup) {
  EXPECT_DOUBLE_EQ(equal_proportions(std::vector<Count>{{3, 4}, {0, 0}}).p, 1.0);
  EXPECT_DOUBLE_EQ(equal_proportions(std::vector<Count>{{4, 4}, {5, 5}}).p, 1.0);
  EXPECT_DOUBLE_EQ(equal_proportions(std::vector<Count>{}).p, 1.0);
  EXPECT_THROW((void)equal_proportions(std::vector<Count>{{5, 4}}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
