#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/comparisons.h>
#include <kerf/psychophysics/random.h>

namespace kerf::psychophysics {
namespace {

Wins of_two(int first, int second) { return {{0, first}, {second, 0}}; }

TEST(RankingOverSubjects, OfTwoItemsHasTheErrorOfAJackknifeOfTheLogit) {
  const std::vector<Wins> subjects{of_two(9, 3), of_two(7, 5), of_two(11, 1), of_two(4, 8), of_two(10, 2)};
  const SubjectsRanking found = rank_over_subjects(subjects);
  const double p = 41.0 / 60.0;
  EXPECT_NEAR(difference(found, 0, 1).value, std::log(p / (1.0 - p)), 1e-9);
  // Each subject's step: (k - 12 p) / (48 p q).
  double squares = 0.0;
  for (const double k : {9.0, 7.0, 11.0, 4.0, 10.0})
    squares += std::pow((k - 12.0 * p) / (48.0 * p * (1.0 - p)), 2);
  EXPECT_NEAR(difference(found, 0, 1).standard_error, std::sqrt(0.8 * squares), 1e-9);
}

TEST(RankingOverSubjects, OfTwoItemsIsTheTestBySignFlips) {
  const std::vector<Wins> subjects{of_two(9, 3), of_two(7, 5),  of_two(11, 1),
                                   of_two(4, 8), of_two(10, 2), of_two(8, 4)};
  const SubjectsRanking found = rank_over_subjects(subjects);
  const SignFlips flips = flip_signs(std::vector<double>{6, 2, 10, -4, 8, 4});
  EXPECT_EQ(found.p, flips.p_two_sided);
  EXPECT_EQ(found.least_p, 1.0 / 32.0);
  EXPECT_TRUE(found.is_exact);
}

TEST(RankingOverSubjects, KeepsTheWorthsOfAllAnswersTogether) {
  const std::vector<Wins> subjects{{{0, 3, 4}, {1, 0, 2}, {0, 2, 0}}, {{0, 1, 3}, {3, 0, 3}, {1, 1, 0}}};
  const SubjectsRanking found = rank_over_subjects(subjects);
  const Ranking pooled = rank({{0, 4, 7}, {4, 0, 5}, {1, 3, 0}});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found.pooled.worth[i], pooled.worth[i], 1e-12);
  double sum = 0.0;
  for (const auto& row : found.covariance) {
    for (const double value : row) sum += value;
  }
  EXPECT_NEAR(sum, 0.0, 1e-12) << "only differences are uncertain";
}

/// Twelve comparisons a pair of three items by each of so many subjects, whose worths are N(0, deviation).
std::vector<Wins> drawn(int subjects, double deviation, Random& random) {
  std::vector<Wins> all;
  for (int subject = 0; subject < subjects; ++subject) {
    const double worth[] = {deviation * random.normal(), deviation * random.normal(),
                            deviation * random.normal()};
    Wins wins(3, std::vector<int>(3, 0));
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = i + 1; j < 3; ++j) {
        wins[i][j] = random.successes(12, 1.0 / (1.0 + std::exp(worth[j] - worth[i])));
        wins[j][i] = 12 - wins[i][j];
      }
    }
    all.push_back(wins);
  }
  return all;
}

TEST(RankingOverSubjects, AlarmsAtItsLevelWhereTastesDifferAndThePooledTestDoesNot) {
  Random random(3);
  constexpr int studies = 1000;
  int alarms = 0;
  int pooled_alarms = 0;
  int pair_alarms = 0;
  for (int study = 0; study < studies; ++study) {
    const SubjectsRanking found = rank_over_subjects(drawn(8, 1.0, random));
    alarms += found.p <= 0.05 ? 1 : 0;
    pooled_alarms += found.pooled.ratio_p <= 0.05 ? 1 : 0;
    pair_alarms += difference(found, 0, 1).p <= 0.05 ? 1 : 0;
  }
  const double band = 3.5 * std::sqrt(0.05 * 0.95 / studies);
  EXPECT_NEAR(alarms / static_cast<double>(studies), 0.05, band);
  EXPECT_LE(pair_alarms / static_cast<double>(studies), 0.05 + band);
  EXPECT_GT(pooled_alarms / static_cast<double>(studies), 0.3);
}

TEST(RankingOverSubjects, RefusesWhatCannotBeRanked) {
  EXPECT_THROW((void)rank_over_subjects(std::vector<Wins>{of_two(9, 3)}), std::invalid_argument);
  EXPECT_THROW((void)rank_over_subjects(std::vector<Wins>{of_two(9, 3), {{0, 1, 1}, {1, 0, 1}, {1, 1, 0}}}),
               std::invalid_argument);
  // Only the second subject ever compared the third item.
  EXPECT_THROW((void)rank_over_subjects(
                   std::vector<Wins>{{{0, 3, 0}, {3, 0, 0}, {0, 0, 0}}, {{0, 3, 2}, {3, 0, 2}, {2, 2, 0}}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics
