#include <limits>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/psychophysics/repeated_measures.h>

namespace kerf::psychophysics {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

const std::vector<std::vector<double>> eight_subjects{{6.1, 7.2, 7.9}, {3.0, 4.1, 4.1}, {5.5, 5.0, 6.8},
                                                      {2.2, 3.9, 3.0}, {7.0, 7.0, 8.5}, {4.4, 6.0, 5.9},
                                                      {1.0, 2.5, 2.5}, {8.0, 7.5, 9.1}};

// R 4.2.2: m <- matrix(c(6.1,7.2,7.9, 3,4.1,4.1, 5.5,5,6.8, 2.2,3.9,3, 7,7,8.5, 4.4,6,5.9, 1,2.5,2.5,
// 8,7.5,9.1), ncol = 3, byrow = TRUE); friedman.test(m); colMeans(t(apply(m, 1, rank))). With three ties.
TEST(FriedmanTest, AgreesWithRWhereThereAreTies) {
  const FriedmanTest test = friedman_test(eight_subjects);
  EXPECT_NEAR(test.statistic, 7.6551724137931, 1e-12);
  EXPECT_EQ(test.degrees_of_freedom, 2);
  EXPECT_NEAR(test.p, 0.0217620814456727, 1e-14);
  EXPECT_THAT(test.mean_ranks,
              ElementsAre(DoubleNear(1.3125, 1e-14), DoubleNear(2.0625, 1e-14), DoubleNear(2.625, 1e-14)));
  EXPECT_NEAR(test.agreement, 7.6551724137931 / 16.0, 1e-13);
}

TEST(FriedmanTest, FindsFullAgreementAndNone) {
  const FriedmanTest all = friedman_test({{1, 2, 3, 4}, {0, 5, 6, 70}, {-1, 0, 1, 2}});
  EXPECT_DOUBLE_EQ(all.agreement, 1.0);
  EXPECT_DOUBLE_EQ(all.statistic, 9.0);  // n (k - 1)
  const FriedmanTest none = friedman_test({{5, 5, 5}, {1, 1, 1}});
  EXPECT_EQ(none.statistic, 0.0);
  EXPECT_EQ(none.p, 1.0);
}

TEST(FriedmanTest, RefusesWhatIsNoTable) {
  EXPECT_THROW((void)friedman_test({{1, 2}}), std::invalid_argument);
  EXPECT_THROW((void)friedman_test({{1}, {2}}), std::invalid_argument);
  EXPECT_THROW((void)friedman_test({{1, 2}, {1, 2, 3}}), std::invalid_argument);
  EXPECT_THROW((void)friedman_test({{1, 2}, {1, std::numeric_limits<double>::quiet_NaN()}}),
               std::invalid_argument);
}

// R 4.2.2, of the third column of the table above less the first: t.test(d); t.test(d, mu = 1).
TEST(SubjectsMean, AgreesWithStudentsTestOfR) {
  std::vector<double> apart;
  for (const auto& row : eight_subjects) apart.push_back(row[2] - row[0]);
  const SubjectsMean mean = subjects_mean(apart);
  EXPECT_NEAR(mean.mean, 1.325, 1e-14);
  EXPECT_NEAR(mean.standard_error, 0.111403385432016, 1e-14);
  EXPECT_NEAR(mean.interval.lower, 1.06157285309792, 1e-13);
  EXPECT_NEAR(mean.interval.upper, 1.58842714690208, 1e-13);
  EXPECT_NEAR(mean.p_of(0.0), 6.74936519874042e-06, 1e-17);
  EXPECT_NEAR(mean.p_of(1.0), 0.0224252544265033, 1e-14);
}

TEST(SubjectsMean, OfEqualValuesIsCertainOfThem) {
  const SubjectsMean mean = subjects_mean(std::vector<double>{2.0, 2.0, 2.0});
  EXPECT_EQ(mean.interval.lower, 2.0);
  EXPECT_EQ(mean.p_of(2.0), 1.0);
  EXPECT_EQ(mean.p_of(1.0), 0.0);
  EXPECT_THROW((void)subjects_mean(std::vector<double>{2.0}), std::invalid_argument);
  EXPECT_THROW((void)subjects_mean(std::vector<double>{2.0, 3.0}, 1.0), std::invalid_argument);
}

// R 4.2.2: coef(lm(c(0.1, 0.9, 1.2, 2.2) ~ c(0, 1, 1.5, 2.5)))
TEST(SlopeOfLine, AgreesWithR) {
  EXPECT_NEAR(slope_of_line(std::vector<double>{0, 1, 1.5, 2.5}, std::vector<double>{0.1, 0.9, 1.2, 2.2}),
              0.830769230769231, 1e-14);
  EXPECT_THROW((void)slope_of_line(std::vector<double>{1, 1}, std::vector<double>{0, 1}),
               std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
