#include "answers/explored/explored_alike.h"

#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answer_pages/analysis_json.h"
#include "answers/analysis.h"
#include "bench/sessions/answers/studies.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// So many slots of either sample, at these speeds.
void add_explored(Study& study, const std::string& subject, double first_m_s, double second_m_s,
                  std::array<std::size_t, 2> pair = {0, 1}) {
  for (const double wobble : {0.9, 1.1}) {
    for (const std::size_t which : {0U, 1U}) {
      const double speed = wobble * (which == 0 ? first_m_s : second_m_s);
      study.explored.push_back(
          {.subject = subject,
           .pair = pair,
           .which = which,
           .hand = {.speed_m_s = speed, .peak_speed_m_s = 2.0 * speed, .strokes_per_s = 1.0}});
    }
  }
}

Study explored_study(std::array<double, 4> percent) {
  Study study = test::study_with(Design::abx, test::abx_task());
  for (std::size_t i = 0; i < percent.size(); ++i) {
    const std::string subject = "S" + std::to_string(i);
    test::add_answers(study, subject, "", 6, 4);
    const double middle = 0.02 * static_cast<double>(i + 1);  // people differ in speed, and that is no matter
    add_explored(study, subject, middle * (1.0 - 0.005 * percent[i]), middle * (1.0 + 0.005 * percent[i]));
  }
  return study;
}

TEST(ExploredAlike, IsTheMeanOfTheSubjectsWithStudentsInterval) {
  const auto pairs = explored_alike(explored_study({5.0, 10.0, 15.0, 22.0}));
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].subjects, 4U);
  // R: t.test(c(5, 10, 15, 22))$conf.int
  EXPECT_NEAR(pairs[0].speed_percent.mean, 13.0, 1e-9);
  EXPECT_NEAR(pairs[0].speed_percent.interval->lower, 1.4522066, 1e-6);
  EXPECT_NEAR(pairs[0].speed_percent.interval->upper, 24.5477934, 1e-6);
  EXPECT_NEAR(pairs[0].peak_speed_percent.mean, 13.0, 1e-9);
  EXPECT_NEAR(pairs[0].stroke_rate_percent.mean, 0.0, 1e-12);
  EXPECT_TRUE(pairs[0].differs());
}

TEST(ExploredAlike, IsSaidWhereTheIntervalIsWithoutZero) {
  Analysis found = analyse(explored_study({5.0, 10.0, 15.0, 22.0}), {.bootstrap = 0});
  EXPECT_THAT(found.warnings,
              Contains(HasSubstr("not explored alike: the mean speed of the tool was 13.0 % higher")));
  EXPECT_THAT(summary_lines(found), Contains(HasSubstr("explored ")));
  EXPECT_EQ(analysis_as_json(found)["explored"][0]["differs"], true);
  found = analyse(explored_study({-9.0, 10.0, -8.0, 9.0}), {.bootstrap = 0});
  EXPECT_THAT(found.warnings, Not(Contains(HasSubstr("explored alike"))));
  EXPECT_EQ(analysis_as_json(found)["explored"][0]["differs"], false);
}

TEST(ExploredAlike, OfTwoPeopleHasNoIntervalAndOfLevelsTwoNames) {
  Study study = test::study_with(Design::abx, test::abx_task());
  add_explored(study, "S1", 0.01, 0.02, {0, 0});
  add_explored(study, "S2", 0.01, 0.03, {0, 0});
  const auto pairs = explored_alike(study);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_FALSE(pairs[0].speed_percent.interval);
  EXPECT_FALSE(pairs[0].differs());
  EXPECT_EQ(names_of(pairs[0], {"spring"})[1], "comparison");
}

}  // namespace
}  // namespace kerf::bench
