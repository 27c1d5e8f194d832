#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/comparisons.h>
#include <kerf/psychophysics/equivalence.h>

// [Okamura2003], Table 1: three blindfolded subjects, four tissues, "which felt more like cutting the real
// tissue". What the twelve answers can support, and what they cannot. docs/psychophysics.md discusses these
// numbers.

namespace kerf::psychophysics {
namespace {

struct Table {
  std::map<std::string, Count> by_tissue;  ///< preferences for the recording
  std::map<std::string, Count> by_subject;
  Count all;
};

Table read_table() {
  std::ifstream file(KERF_SOURCE_DIR "/examples/sessions/okamura2003-table-1.csv");
  Table table;
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#' || line.starts_with("subject")) continue;
    std::istringstream cells(line);
    std::string subject, tissue, preferred;
    std::getline(cells, subject, ',');
    std::getline(cells, tissue, ',');
    std::getline(cells, preferred);
    for (Count* count : {&table.by_tissue[tissue], &table.by_subject[subject], &table.all}) {
      ++count->trials;
      count->successes += preferred == "recording" ? 1 : 0;
    }
  }
  return table;
}

TEST(TableOf004, HoldsTwelveAnswersOfWhichHalfPreferTheRecording) {
  const Table table = read_table();
  EXPECT_EQ(table.all.trials, 12);
  EXPECT_EQ(table.all.successes, 6);
  ASSERT_EQ(table.by_tissue.size(), 4U);
  for (const char* tissue : {"tendon", "skin", "liver"}) EXPECT_EQ(table.by_tissue.at(tissue).successes, 2);
  EXPECT_EQ(table.by_tissue.at("empty").successes, 0);
  EXPECT_EQ(table.by_subject.size(), 3U);
}

TEST(TableOf004, ShowsNoPreference) {
  const Table table = read_table();
  EXPECT_DOUBLE_EQ(binomial_test(table.all, 0.5), 1.0);
  // Without the empty scissors: 6 of 9.
  EXPECT_DOUBLE_EQ(binomial_test({6, 9}, 0.5), 260.0 / 512.0);
}

TEST(TableOf004, CannotExcludeAPreferenceOfThreeInFour) {
  const Table table = read_table();
  const Interval interval = clopper_pearson(table.all);
  EXPECT_NEAR(interval.lower, 0.2109, 5e-5);
  EXPECT_NEAR(interval.upper, 0.7891, 5e-5);
  EXPECT_NEAR(excluded_margin(table.all, 0.5), 0.2547, 5e-5);
  EXPECT_FALSE(equivalent_proportion(table.all, 0.5, 0.25).is_shown);
  // As the d' of a comparison in two intervals: nothing under 0.97 is excluded, and 1 is a difference worth
  // hearing of.
  EXPECT_NEAR(excluded_d_prime({Decision::forced_choice, 2}, table.all), 0.975, 5e-3);
}

TEST(TableOf004, CannotSupportWhatItSaysOfEmptyScissors) {
  // All three preferred the model: that happens in one case of four by chance, and three answers can never do
  // better.
  const Table table = read_table();
  std::vector<double> p;
  for (const auto& [tissue, count] : table.by_tissue) p.push_back(binomial_test(count, 0.5));
  EXPECT_DOUBLE_EQ(binomial_test(table.by_tissue.at("empty"), 0.5), 0.25);
  for (const double adjusted : holm(p)) EXPECT_DOUBLE_EQ(adjusted, 1.0);
  EXPECT_DOUBLE_EQ(binomial_power({.truth = 0.999}, 3), 0.0);
}

TEST(TableOf004, HadTwoChancesInFiveToNoticeAPreferenceOfThreeInFour) {
  // 10 of 12, or 2 of 12, are needed: P(X >= 10 | 0.75) = 0.3907, P(X <= 2 | 0.75) under 1e-4.
  EXPECT_NEAR(binomial_power({.truth = 0.75}, 12), 0.3907, 5e-4);
}

}  // namespace
}  // namespace kerf::psychophysics
