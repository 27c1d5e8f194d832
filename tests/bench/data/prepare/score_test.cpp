#include "prepare/score.h"

#include <vector>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

std::vector<double> times(std::size_t rows) {
  std::vector<double> time;
  for (std::size_t i = 0; i < rows; ++i) time.push_back(0.1 * static_cast<double>(i));
  return time;
}

TEST(Score, OfTheLabelsThemselvesIsPerfect) {
  const std::vector<RowSpan> labels{{10, 20}, {40, 60}};
  const ContactScore score = score_contacts(labels, labels, times(100));
  EXPECT_EQ(score.found, 2U);
  EXPECT_EQ(score.missed + score.false_ones + score.split_up, 0U);
  EXPECT_EQ(score.begin.percentile_90_s, 0.0);
  EXPECT_EQ(score.f1, 1.0);
}

TEST(Score, CountsWhatIsMissedFalseAndSplitUp) {
  const std::vector<RowSpan> labels{{10, 20}, {40, 60}, {80, 90}};
  const std::vector<RowSpan> detected{{8, 19}, {30, 35}, {40, 45}, {47, 62}};
  const ContactScore score = score_contacts(detected, labels, times(100));
  EXPECT_EQ(score.labelled, 3U);
  EXPECT_EQ(score.detected, 4U);
  EXPECT_EQ(score.found, 2U);
  EXPECT_EQ(score.missed, 1U);
  EXPECT_EQ(score.false_ones, 1U);
  EXPECT_EQ(score.split_up, 1U) << "40-45 lies on a label that 47-62 covers better";
  EXPECT_NEAR(score.begin.bias_s, 0.25, 1e-12) << "of -0.2 and +0.7 s";
  EXPECT_NEAR(score.begin.median_s, 0.45, 1e-12);
  EXPECT_NEAR(score.end.median_s, 0.15, 1e-12);
  EXPECT_NEAR(score.precision, 27.0 / 36.0, 1e-12);
  EXPECT_NEAR(score.recall, 27.0 / 40.0, 1e-12);
  EXPECT_NEAR(score.f1, 2.0 * 27.0 / 76.0, 1e-12);
}

TEST(Score, OfASpanOverTwoLabelsFindsOne) {
  const std::vector<RowSpan> labels{{10, 20}, {25, 60}};
  const ContactScore score = score_contacts(std::vector<RowSpan>{{5, 70}}, labels, times(100));
  EXPECT_EQ(score.found, 1U);
  EXPECT_EQ(score.missed, 1U);
  EXPECT_NEAR(score.begin.bias_s, -2.0, 1e-12) << "it belongs to the label it shares most rows with";
}

TEST(Score, TakesRunsOfAValueForLabels) {
  const auto spans = labelled_spans(std::vector<double>{3, 3, 1, 3, 2, 3}, 3.0);
  ASSERT_EQ(spans.size(), 3U);
  EXPECT_EQ(spans[0].end, 2U);
  EXPECT_EQ(spans[2].begin, 5U);
  EXPECT_TRUE(labelled_spans({}, 3.0).empty());
}

}  // namespace
}  // namespace kerf::bench
