#include "answers/felt_check.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answer_pages/analysis_json.h"
#include "answers/analysis.h"
#include "bench/sessions/answers/studies.h"
#include "bench/sessions/sealed/stored_session.h"
#include "sealed/trials/slot_levels.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// Adds two slots of a subject that felt the samples with so much force.
void add_felt(Study& study, const std::string& subject, const FeltLevel& first, const FeltLevel& second) {
  study.felt.push_back({.subject = subject, .pair = {0, 1}, .sample = 0, .level = first});
  study.felt.push_back({.subject = subject, .pair = {0, 1}, .sample = 1, .level = second});
}

FeltLevel level(double rms_n, double limited_share = 0.0, double vibration_n = 0.001) {
  return {.rms_n = rms_n,
          .peak_n = 2.0 * rms_n,
          .limited_share = limited_share,
          .vibration_n = vibration_n,
          .vibration_thresholds = vibration_n / 0.003};
}

Study study_felt(const FeltLevel& first, const FeltLevel& second) {
  Study study = test::study_with(Design::abx, test::abx_task());
  for (const char* const subject : {"S1", "S2", "S3", "S4"}) {
    test::add_answers(study, subject, "", 6, 4);
    add_felt(study, subject, first, second);
  }
  return study;
}

TEST(FeltCheck, IsTheMeanOfTheSubjectsInJndsWithStudentsInterval) {
  Study study = test::study_with(Design::abx, test::abx_task());
  const std::vector<double> apart{0.5, 1.0, 1.5, 2.2};
  for (std::size_t i = 0; i < apart.size(); ++i) {
    const double half = 0.5 * apart[i] * 0.07 * 2.0;
    add_felt(study, "S" + std::to_string(i), level(2.0 - half), level(2.0 + half));
  }
  const FeltCheck check = felt_check(study);
  ASSERT_EQ(check.pairs.size(), 1U);
  const FeltOfPair& pair = check.pairs[0];
  EXPECT_EQ(pair.subjects, 4U);
  // R: t.test(c(0.5, 1, 1.5, 2.2))$conf.int
  EXPECT_NEAR(pair.rms_jnds.mean, 1.3, 1e-9);
  EXPECT_NEAR(pair.rms_jnds.interval->lower, 0.14522066, 1e-7);
  EXPECT_NEAR(pair.rms_jnds.interval->upper, 2.45477934, 1e-7);
  EXPECT_NEAR(pair.peak_jnds.mean, 1.3, 1e-9);
  EXPECT_TRUE(pair.strength_differs());
}

TEST(FeltCheck, CountsASubjectOnceHoweverManySlotsItFelt) {
  Study study = study_felt(level(2.0), level(2.0));
  for (int i = 0; i < 100; ++i) add_felt(study, "S9", level(2.0), level(3.0));
  const double alone = felt_apart(level(2.0), level(3.0)).rms_jnds;
  EXPECT_NEAR(felt_check(study).pairs[0].rms_jnds.mean, alone / 5.0, 1e-9);
}

TEST(FeltCheck, HasNoIntervalOfTwoSubjects) {
  Study study = test::study_with(Design::abx, test::abx_task());
  add_felt(study, "S1", level(2.0), level(2.1));
  add_felt(study, "S2", level(2.0), level(2.2));
  EXPECT_FALSE(felt_check(study).pairs[0].rms_jnds.interval);
}

TEST(FeltCheck, LeavesOutSlotsThatWereNotFelt) {
  Study study = study_felt(level(2.0), level(2.0));
  add_felt(study, "S1", FeltLevel(), level(9.0));
  study.felt.pop_back();
  EXPECT_NEAR(felt_check(study).samples[0].level.rms_n, 2.0, 1e-12);
  EXPECT_EQ(felt_check(study).samples[0].slots, 4U);
}

TEST(FeltCheck, SaysInPlainWordsWhatElseMayHaveToldSamplesApart) {
  const auto warnings = [](const FeltLevel& first, const FeltLevel& second) {
    return analyse(study_felt(first, second), {.bootstrap = 0}).warnings;
  };
  const auto strength = HasSubstr("were not felt equally strong");
  const auto limit = HasSubstr("the limit may have told them apart");
  const auto buzz = HasSubstr("a buzz or the sound of the device may have told them apart");
  const auto alike = warnings(level(2.0), level(2.1));
  EXPECT_THAT(alike, Not(Contains(strength)));
  EXPECT_THAT(alike, Not(Contains(limit)));
  EXPECT_THAT(alike, Not(Contains(buzz)));
  EXPECT_THAT(
      warnings(level(2.0), level(2.2)),
      Contains(HasSubstr("Samples 'standard' and 'comparison' were not felt equally strong, but 1.4 JND "
                         "apart (rms 2 and 2.2 N")));
  EXPECT_THAT(warnings(level(2.0, 0.02), level(2.0)), Contains(limit));
  EXPECT_THAT(warnings(level(2.0, 0.0, 0.02), level(2.0)), Contains(buzz));
  EXPECT_THAT(warnings(level(2.0, 0.0, 0.002), level(2.0)), Not(Contains(buzz)))
      << "below the threshold of a hand";
}

TEST(FeltCheck, IsInLinesAndJson) {
  const Analysis analysis = analyse(study_felt(level(2.0), level(2.2)), {.bootstrap = 0});
  EXPECT_THAT(summary_lines(analysis),
              Contains(HasSubstr("felt of comparison less standard: 1.36 (1.36 to 1.36) JND rms")));
  const auto json = analysis_as_json(analysis).at("felt");
  EXPECT_EQ(json.at("jnd").at("weber_fraction"), 0.07);
  EXPECT_TRUE(json.at("pairs")[0].at("rms_jnds").at("differs").get<bool>());
  EXPECT_EQ(json.at("samples")[1].at("slots"), 4);
  const auto none = analysis_as_json(analyse(test::study_with(Design::abx, test::abx_task()))).at("felt");
  EXPECT_EQ(none.at("note"), "of no trial that counts the forces are known");
}

/// A trial whose first slot buzzes at 200 Hz and whose second is cut to a limit in half of its ticks.
RecordedTrial buzzing_and_limited() {
  RecordedTrial trial = test::answered(test::set_up().plan[1], 0, 0);
  for (std::size_t i = 0; i < 3000; ++i) {
    const double time_s = 0.001 * static_cast<double>(i);
    TraceRow tick{.row = {.tick = i, .time_s = time_s}, .slot = static_cast<std::uint8_t>(i < 1500 ? 0 : 1)};
    tick.row.force_commanded[0] = 2.0 + (i < 1500 ? 0.1 * std::sin(400.0 * 3.14159265358979 * time_s) : 0.0);
    if (i >= 1500 && i % 2 == 0) tick.row.flags = schema::flag_slew_limited;
    trial.trace.push_back(tick);
  }
  return trial;
}

TEST(SlotLevels, AreOfTheForcesThatWereGiven) {
  const auto levels = slot_levels(buzzing_and_limited(), test::set_up().protocol);
  ASSERT_EQ(levels.size(), 3U);
  EXPECT_NEAR(levels[0].vibration_n, 0.1 / std::sqrt(2.0), 1e-3);
  EXPECT_EQ(levels[0].limited_share, 0.0);
  EXPECT_LT(levels[1].vibration_n, 1e-6);
  EXPECT_NEAR(levels[1].limited_share, 0.5, 1e-3);
  EXPECT_NEAR(levels[1].rms_n, 2.0, 1e-9);
  EXPECT_TRUE(std::isnan(levels[2].rms_n)) << "it never played";
}

TEST(SlotLevels, ComeIntoAStudyWithoutPractice) {
  const test::StoredSession session;
  {
    SessionStore run = session.run();
    RecordedTrial practice = buzzing_and_limited();
    practice.what = test::set_up().plan[0];
    run.append(practice);
    run.append(buzzing_and_limited());
    run.close();
  }
  const SessionStore store = session.read();
  const Study study = study_of({&store});
  ASSERT_EQ(study.felt.size(), 3U);
  EXPECT_EQ(study.felt[0].sample, 1U) << "A plays the second in this trial";
  EXPECT_EQ(study.felt[1].sample, 0U);
}

}  // namespace
}  // namespace kerf::bench
