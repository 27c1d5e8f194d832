#include "answers/analysis.h"

#include <cmath>
#include <stdexcept>
#include <tuple>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answer_pages/analysis_json.h"
#include "answers/answers_table.h"
#include "bench/sessions/answers/studies.h"

namespace kerf::bench {
namespace {

using test::abx_task;
using test::add_answers;
using test::add_wins;
using test::study_with;
using testing::Contains;
using testing::HasSubstr;

AnalysisOptions quick() { return {.bootstrap = 0}; }

Study table_of_okamura() {
  return read_answers(KERF_SOURCE_DIR "/examples/sessions/okamura2003-table-1.csv");
}

// P(X >= 12 | 16, 1/2) = 2517 / 65536; the interval and the power as R's binom.test and pbinom give them.
TEST(AnAbxSession, OfTwelveInSixteenIsRightOneSided) {
  Study study = study_with(Design::abx, abx_task());
  add_answers(study, "P1", "liver", 12, 4);
  const Analysis found = analyse(study, quick());
  ASSERT_TRUE(found.all);
  EXPECT_NEAR(found.p_value, 2517.0 / 65536.0, 1e-12);
  EXPECT_NEAR(found.all->p_two_sided, 2.0 * 2517.0 / 65536.0, 1e-12);
  EXPECT_NEAR(found.all->interval.lower, 0.476, 5e-4);
  EXPECT_NEAR(found.all->interval.upper, 0.927, 5e-4);
  ASSERT_EQ(found.all->power.front().truth, 0.75);
  EXPECT_NEAR(found.all->power.front().power, 0.630, 5e-4);
  ASSERT_TRUE(found.all->d_prime);
  EXPECT_NEAR(psychophysics::proportion_correct(abx_task(), found.all->d_prime->value), 0.75, 1e-9);
  EXPECT_FALSE(found.all->equivalence) << "nobody set a margin";
}

TEST(AnAbxSession, PrintsWhatOthersRelyOn) {
  Study study = study_with(Design::abx, abx_task());
  add_answers(study, "P1", "liver", 12, 4);
  add_answers(study, "P1", "liver", 5, 5);
  for (std::size_t i = 16; i < study.judgements.size(); ++i) study.judgements[i].practice = true;
  const auto json = analysis_as_json(analyse(study, quick()));
  EXPECT_EQ(json.at("trials"), 16);
  EXPECT_EQ(json.at("practice"), 10);
  EXPECT_EQ(json.at("correct"), 12);
  EXPECT_NEAR(json.at("p_value").get<double>(), 0.0384, 5e-5);
  EXPECT_NEAR(json.at("ci95").at(0).get<double>(), 0.476, 5e-4);
  EXPECT_TRUE(json.at("dprime").is_number());
  for (const char* key : {"by_subject", "by_tissue", "by_pair", "ranking", "psychometric", "equivalence",
                          "slot_bias", "warnings", "corrections", "shown", "not_shown", "response_times"})
    EXPECT_TRUE(json.contains(key)) << key;
}

// Ten of ten: p is 0.5^10, and the upper end of the share is 1, whose d' is infinite.
TEST(ASession, WithAllAnswersRightHasADPrimeWithoutAnUpperEnd) {
  Study study = study_with(Design::two_interval);
  add_answers(study, "P1", "", 10, 0);
  const Analysis found = analyse(study, quick());
  EXPECT_NEAR(found.p_value, std::pow(0.5, 10), 1e-15);
  EXPECT_TRUE(std::isfinite(found.all->d_prime->value));
  EXPECT_TRUE(std::isinf(found.all->d_prime->interval.upper));
  EXPECT_TRUE(std::isinf(found.all->excluded_d_prime));
  const auto json = analysis_as_json(found);
  EXPECT_TRUE(json.at("dprime_ci95").at(1).is_null());
  EXPECT_TRUE(json.at("equivalence").at("excluded_above").is_null());
}

TEST(ASession, WithAllAnswersWrongIsNoDiscrimination) {
  Study study = study_with(Design::three_interval, {.intervals = 3});
  add_answers(study, "P1", "", 0, 12);
  AnalysisOptions options = quick();
  options.d_prime_bound = 1.0;
  const Analysis found = analyse(study, options);
  EXPECT_DOUBLE_EQ(found.p_value, 1.0);
  EXPECT_NEAR(found.all->chance, 1.0 / 3.0, 1e-15);
  EXPECT_LT(found.all->d_prime->value, 0.0);
  EXPECT_TRUE(found.all->equivalence->is_shown);
}

TEST(ASession, WithoutAnswersSaysSo) {
  for (const Design design : {Design::preference, Design::abx, Design::two_interval, Design::three_interval,
                              Design::constant, Design::staircase, Design::quest_plus}) {
    const Study study = study_with(design);
    const Analysis found = analyse(study, quick());
    EXPECT_FALSE(found.all);
    EXPECT_THAT(found.warnings, Contains(HasSubstr("no answers")));
    EXPECT_TRUE(analysis_as_json(found).at("p_value").is_null());
    EXPECT_FALSE(summary_lines(found).empty());
    EXPECT_EQ(main_result(study).note, "there are no answers");
  }
}

TEST(ASession, OfOneSubjectSaysNothingOfPeople) {
  Study study = study_with(Design::abx, abx_task());
  add_answers(study, "P1", "", 20, 4);
  EXPECT_THAT(analyse(study, quick()).shows_not, Contains(HasSubstr("one subject")));
  const double excluded = psychophysics::excluded_d_prime(abx_task(), {.successes = 20, .trials = 24});
  EXPECT_THAT(analyse(study, quick()).shows,
              Contains(fmt::format("A d' above {:.2f} is unlikely (excluded at 5 %).", excluded)));
}

// 6 of 8 has p = 37/256, 10 of 10 has 1/1024; Holm takes the lesser twice.
TEST(Tissues, AreCorrectedAsOneFamily) {
  Study study = study_with(Design::two_interval);
  add_answers(study, "P1", "liver", 6, 2);
  add_answers(study, "P1", "skin", 10, 0);
  const Analysis found = analyse(study, quick());
  ASSERT_EQ(found.by_tissue.size(), 2U);
  EXPECT_NEAR(found.by_tissue[0].p_value, 37.0 / 256.0, 1e-12);
  EXPECT_NEAR(found.by_tissue[0].p_adjusted, 37.0 / 256.0, 1e-12);
  EXPECT_NEAR(found.by_tissue[1].p_adjusted, 2.0 / 1024.0, 1e-12);
}

// Half of the subjects hear it always, half guess: the pooled count hides it.
TEST(Subjects, WhoDifferAreWarnedOf) {
  Study study = study_with(Design::abx, abx_task());
  for (const char* subject : {"P1", "P2"}) add_answers(study, subject, "", 20, 0);
  for (const char* subject : {"P3", "P4"}) add_answers(study, subject, "", 10, 10);
  const Analysis found = analyse(study, quick());
  EXPECT_LT(found.spread.equal.p, 1e-3);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("Subjects differ")));
  // Shares 1, 1, 1/2, 1/2: mean 0.75, deviation 0.2887, t(0.975, 3) = 3.1824.
  ASSERT_TRUE(found.spread.population);
  EXPECT_NEAR(found.spread.population->mean, 0.75, 1e-12);
  EXPECT_NEAR(found.spread.population->interval.lower, 0.75 - 3.1824 * 0.288675 / 2.0, 1e-4);
  // t = 0.25 / 0.14434 = 1.7321 on 3: one-sided p = 0.0908.
  EXPECT_NEAR(found.spread.population->p_value, 0.0908, 1e-4);
}

TEST(Subjects, WhoAreAllAlikeGiveStudentNoWidth) {
  Study study = study_with(Design::abx, abx_task());
  for (const char* subject : {"P1", "P2", "P3"}) add_answers(study, subject, "", 15, 5);
  const Analysis found = analyse(study, quick());
  EXPECT_FALSE(found.spread.population);
  EXPECT_THAT(found.spread.note, HasSubstr("no width"));
}

/// Twelve answers of each.
Study study_of_twelve(Design design, const std::vector<int>& right) {
  Study study = study_with(design, abx_task());
  for (std::size_t subject = 0; subject < right.size(); ++subject)
    add_answers(study, fmt::format("P{}", subject + 1), "", right[subject], 12 - right[subject]);
  return study;
}

// Three of twelve hear it, the others guess. Of 4,096 flips of the shares less 1/2 as many as R counts by
// expand.grid() have their sum and more; the pooled test sees as many answers of independent people.
TEST(Subjects, OfWhomFewHearAreNoPeopleWhoHear) {
  const Study study = study_of_twelve(Design::abx, {12, 11, 12, 6, 5, 7, 6, 4, 7, 6, 5, 6});
  const Analysis found = analyse(study, quick());
  ASSERT_TRUE(found.all->tests_subjects);
  EXPECT_EQ(found.all->subjects, 12U);
  EXPECT_LT(found.all->p_greater, 0.01);
  EXPECT_DOUBLE_EQ(found.p_value, found.all->over_subjects->p_greater);
  EXPECT_GT(found.p_value, 0.05);
  EXPECT_THAT(found.shows, Contains(HasSubstr("by at least one of the subjects")));
  EXPECT_THAT(found.shows_not, Contains(HasSubstr("notice it on the average")));
  EXPECT_THAT(found.main_test, HasSubstr("flipped signs of the 12 subjects"));
  EXPECT_EQ(analysis_as_json(found).at("over_subjects").at("is_main"), true);
}

TEST(Subjects, WhoAllHearALittleAreFoundAsPeople) {
  const Analysis found = analyse(study_of_twelve(Design::abx, {8, 7, 9, 8, 6, 7, 8, 9}), quick());
  EXPECT_LT(found.p_value, 0.01);
  EXPECT_THAT(found.shows, Contains(HasSubstr("noticed on the average of people")));
}

// One of twelve at d' 3, the others guess: over all answers d' is far below 1, for one of them it is not.
TEST(Subjects, OfWhomOneHearsAreNotShownToBeDeaf) {
  AnalysisOptions options = quick();
  options.d_prime_bound = 1.5;
  const Study study = study_of_twelve(Design::abx, {11, 6, 5, 7, 6, 6, 5, 6, 7, 6, 5, 7});
  const Analysis found = analyse(study, options);
  const GroupEquivalence& equivalence = *found.all->equivalence;
  EXPECT_LT(equivalence.p, 0.05);
  EXPECT_TRUE(equivalence.subjects_differ);
  EXPECT_FALSE(equivalence.is_shown);
  EXPECT_THAT(found.shows_not, Contains(HasSubstr("the subjects differ")));
  const auto json = analysis_as_json(found).at("equivalence");
  EXPECT_EQ(json.at("shown"), false);
  EXPECT_EQ(json.at("subjects_differ"), true);
  EXPECT_EQ(main_result(study, options).equivalent, false);
}

TEST(Subjects, WhoAllGuessAreShownToBeBelowABoundThatWasSet) {
  AnalysisOptions options = quick();
  options.d_prime_bound = 1.5;
  const Analysis found = analyse(study_of_twelve(Design::abx, {6, 6, 5, 7, 6, 6, 5, 6, 7, 6, 5, 7}), options);
  EXPECT_TRUE(found.all->equivalence->is_shown);
  EXPECT_THAT(found.shows, Contains(HasSubstr("On the average of the subjects d' is below 1.5")));
}

TEST(Equivalence, OfTwoSubjectsIsThatOfTheWorse) {
  AnalysisOptions options = quick();
  options.d_prime_bound = 1.5;
  const Analysis found = analyse(study_of_twelve(Design::abx, {4, 6}), options);
  const double alone = psychophysics::below_d_prime(abx_task(), {.successes = 6, .trials = 12}, 1.5).p;
  EXPECT_DOUBLE_EQ(found.all->equivalence->p, alone);
}

TEST(Equivalence, IsUnknownWithoutAMargin) {
  const auto json = analysis_as_json(analyse(study_of_twelve(Design::abx, {6, 6, 5}), quick()));
  EXPECT_TRUE(json.at("equivalence").at("shown").is_null());
  EXPECT_TRUE(json.at("equivalence").at("bound").is_null());
  EXPECT_TRUE(json.at("equivalence").at("excluded_above").is_number());
}

// Right 18 of 20 when it is the first, 6 of 20 when the second. R: fisher.test gives p = 0.00024.
TEST(Answers, WithAResponseBiasAreWarnedOf) {
  Study study = study_with(Design::two_interval);
  for (std::size_t i = 0; i < 40; ++i) {
    const std::size_t right = i % 2;
    const bool is_right = right == 0 ? i < 36 : i < 12;
    study.judgements.push_back(
        {.subject = "P1", .pair = {0, 1}, .right = right, .answer = is_right ? right : 1 - right});
  }
  const Analysis found = analyse(study, quick());
  EXPECT_EQ(found.bias.answers, (std::vector<int>{32, 8}));
  EXPECT_NEAR(found.bias.test.p, 2.4436e-4, 1e-8);
  ASSERT_TRUE(found.bias.detection);
  // z(0.9) - z(0.7) = 1.2816 - 0.5244, over the root of two.
  EXPECT_NEAR(found.bias.detection->d_prime, (1.2815516 - 0.5244005) / std::sqrt(2.0), 1e-6);
  EXPECT_LT(found.bias.detection->criterion, 0.0);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("response bias to one slot")));
}

TEST(Answers, WithAnEqualShareInEachSlotHaveNoBias) {
  Study study = study_with(Design::two_interval);
  add_answers(study, "P1", "", 20, 20);
  EXPECT_NEAR(analyse(study, quick()).bias.test.p, 1.0, 1e-12);
}

// docs/psychophysics.md, "Table 1 of [Okamura2003], in numbers".
TEST(TheTableOf004, GivesTheNumbersOfTheDocs) {
  const Analysis found = analyse(table_of_okamura(), quick());
  ASSERT_TRUE(found.all);
  EXPECT_EQ(found.all->count.successes, 6);
  EXPECT_EQ(found.all->count.trials, 12);
  EXPECT_EQ(found.all->counted, "recording preferred");
  EXPECT_DOUBLE_EQ(found.p_value, 1.0);
  EXPECT_NEAR(found.all->interval.lower, 0.2109, 5e-5);
  EXPECT_NEAR(found.all->interval.upper, 0.7891, 5e-5);
  EXPECT_FALSE(found.all->tests_subjects) << "three subjects";
  EXPECT_NEAR(found.all->power[0].power, 0.391, 5e-4);
  EXPECT_EQ(found.all->power[0].trials_needed, 35);
  EXPECT_NEAR(found.all->power[1].power, 0.0863, 5e-5);
  EXPECT_EQ(found.all->power[1].trials_needed, 210);
  ASSERT_EQ(found.by_tissue.size(), 4U);
  for (const AnswerGroup& tissue : found.by_tissue) {
    EXPECT_DOUBLE_EQ(tissue.p_value, tissue.name == "empty" ? 0.25 : 1.0);
    EXPECT_DOUBLE_EQ(tissue.p_adjusted, 1.0);
    EXPECT_EQ(tissue.count.successes, tissue.name == "empty" ? 0 : 2);
    EXPECT_EQ(tissue.count.trials, 3);
  }
  EXPECT_NEAR(found.spread.equal.p, 708.0 / 924.0, 1e-12);
  EXPECT_EQ(found.preferred, (std::vector<std::size_t>{6, 6}));
}

// Shares 3/4, 1/4, 1/2: mean 0.5, error 0.25 / sqrt(3); against 0.25 t = 1.7321 on 2, one-sided p = 0.1127.
// R: pt().
TEST(TheTableOf004, IsFarFromShowingAMarginOfAQuarterForPeople) {
  AnalysisOptions options = quick();
  options.margin = 0.25;
  const Analysis found = analyse(table_of_okamura(), options);
  EXPECT_NEAR(found.all->equivalence->p, 0.1127, 5e-5);
  EXPECT_FALSE(found.all->equivalence->is_shown);
  EXPECT_FALSE(found.all->equivalence->subjects_differ);
  EXPECT_EQ(found.all->equivalence->subjects_shown, 0U);
}

TEST(TheTableOf004, SaysWhatItCannotSupport) {
  const Analysis found = analyse(table_of_okamura(), quick());
  EXPECT_THAT(found.shows, Contains(HasSubstr("No sign of a preference")));
  EXPECT_THAT(found.shows_not, Contains(HasSubstr("39 % to notice 75 %")));
  EXPECT_THAT(found.shows_not, Contains(HasSubstr("cannot be told apart")));
  EXPECT_THAT(found.shows_not, Contains(HasSubstr("empty (3)")));
  EXPECT_THAT(found.warnings, Contains(HasSubstr("not as many independent")));
  EXPECT_TRUE(found.bias.answers.empty());
  const auto json = analysis_as_json(found);
  EXPECT_TRUE(json.at("correct").is_null());
  EXPECT_TRUE(json.at("dprime").is_null());
  EXPECT_EQ(json.at("preferred").at("recording"), 6);
}

// [Agresti], American League 1987; worth over Baltimore.
TEST(Preferences, AmongManyAreRankedAsAgrestisBaseball) {
  const std::vector<std::vector<int>> wins{
      {0, 7, 9, 7, 7, 9, 11}, {6, 0, 7, 5, 11, 9, 9}, {4, 6, 0, 7, 7, 8, 12}, {6, 8, 6, 0, 6, 7, 10},
      {6, 2, 6, 7, 0, 7, 12}, {4, 4, 5, 6, 6, 0, 6},  {2, 4, 1, 3, 1, 7, 0}};
  Study study = study_with(Design::preference);
  study.samples = {"Milwaukee", "Detroit", "Toronto", "New York", "Boston", "Cleveland", "Baltimore"};
  for (std::size_t i = 0; i < wins.size(); ++i) {
    for (std::size_t j = i + 1; j < wins.size(); ++j) add_wins(study, i, j, wins[i][j], wins[j][i]);
  }
  const Analysis found = analyse(study, quick());
  ASSERT_EQ(found.rankings.size(), 1U);
  ASSERT_TRUE(found.rankings[0].bradley_terry);
  const double worth[] = {1.581, 1.436, 1.294, 1.248, 1.108, 0.684};
  std::size_t team = 0;
  for (const RankedPair& pair : found.rankings[0].pairs) {
    if (pair.second != 6) continue;
    EXPECT_NEAR(pair.difference.value, worth[team++], 1e-3);
    EXPECT_GE(pair.p_adjusted, pair.difference.p);
  }
  EXPECT_EQ(found.rankings[0].pairs.size(), 21U);
  EXPECT_EQ(found.by_pair.size(), 21U);
  EXPECT_FALSE(found.all);
  EXPECT_DOUBLE_EQ(found.p_value, found.rankings[0].bradley_terry->ratio_p);
  EXPECT_DOUBLE_EQ(main_result(study).p_value, found.p_value);
  EXPECT_EQ(analysis_as_json(found).at("preferred").at("Milwaukee"), 50);
}

// Six subjects with one taste each, and six with the opposite: many answers, and nothing that people prefer.
TEST(Preferences, ThatDifferFromSubjectToSubjectAreNoPreferenceOfPeople) {
  Study study = study_with(Design::preference);
  study.samples = {"a", "A", "c"};
  for (int subject = 0; subject < 12; ++subject) {
    const bool turned = subject % 2 == 1;
    const std::size_t before = study.judgements.size();
    for (const auto& [first, second, wins] : {std::tuple{0U, 1U, 9}, {0U, 2U, 10}, {1U, 2U, 7}})
      add_wins(study, first, second, turned ? 12 - wins + (subject == 1 ? 0 : 1) : wins,
               turned ? wins - (subject == 1 ? 0 : 1) : 12 - wins);
    for (std::size_t i = before; i < study.judgements.size(); ++i)
      study.judgements[i].subject = fmt::format("P{}", subject);
  }
  const Analysis found = analyse(study, quick());
  ASSERT_EQ(found.rankings.size(), 1U);
  EXPECT_TRUE(found.rankings[0].tests_subjects);
  EXPECT_GT(found.p_value, 0.3);
  EXPECT_LT(found.rankings[0].bradley_terry->ratio_p, 0.5);
  EXPECT_GT(found.rankings[0].error_of(0), found.rankings[0].bradley_terry->standard_error[0]);
  EXPECT_DOUBLE_EQ(main_result(study).p_value, found.p_value);
  EXPECT_EQ(analysis_as_json(found).at("ranking").at(0).at("over_subjects").at("is_main"), true);
}

TEST(Findings, LeaveTheNamesOfSamplesAsTheyAre) {
  Study study = study_with(Design::preference);
  study.samples = {"a", "b", "c"};
  add_wins(study, 0, 1, 28, 2);
  add_wins(study, 0, 2, 28, 2);
  add_wins(study, 1, 2, 15, 15);
  EXPECT_THAT(analyse(study, quick()).shows, Contains(HasSubstr("referred is a to b")));
}

// [Ford1957]: an item that never lost has no finite worth.
TEST(Preferences, OfASampleThatNeverLostHaveNoRankingAndSayWhy) {
  Study study = study_with(Design::preference);
  study.samples = {"a", "b", "c"};
  add_wins(study, 0, 1, 5, 0);
  add_wins(study, 0, 2, 5, 0);
  add_wins(study, 1, 2, 3, 2);
  const Analysis found = analyse(study, quick());
  ASSERT_EQ(found.rankings.size(), 1U);
  EXPECT_FALSE(found.rankings[0].bradley_terry);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("never won")));
  EXPECT_TRUE(analysis_as_json(found).at("ranking").at(0).at("bradley_terry").is_null());
  EXPECT_THAT(main_result(study).note, HasSubstr("never won"));
  EXPECT_FALSE(summary_lines(found).empty());
}

// Mann and Whitney: 1, 2, 3 right and 4, 5, 6 wrong; U = 0, variance 5.25, with continuity z = 4 / 2.2913.
TEST(ResponseTimes, SayWhetherRightAnswersAreFaster) {
  Study study = study_with(Design::two_interval);
  add_answers(study, "P1", "", 3, 3);
  for (std::size_t i = 0; i < 6; ++i) study.judgements[i].response_s = static_cast<double>(i) + 1.0;
  const ResponseTimes times = analyse(study, quick()).times;
  EXPECT_DOUBLE_EQ(times.median_s, 3.5);
  EXPECT_DOUBLE_EQ(times.median_right_s, 2.0);
  EXPECT_DOUBLE_EQ(times.median_wrong_s, 5.0);
  EXPECT_DOUBLE_EQ(times.right_is_faster, 1.0);
  EXPECT_NEAR(times.p_value, 0.0809, 1e-4);
}

TEST(TheMainResult, IsThatOfTheAnalysis) {
  Study study = study_with(Design::abx, abx_task());
  add_answers(study, "P1", "liver", 31, 17);
  const Analysis whole = analyse(study, quick());
  const MainResult result = main_result(study);
  EXPECT_EQ(result.trials, 48U);
  EXPECT_DOUBLE_EQ(result.p_value, whole.p_value);
  EXPECT_DOUBLE_EQ(result.d_prime, whole.all->d_prime->value);
  EXPECT_DOUBLE_EQ(result.d_prime_interval.upper, whole.all->d_prime->interval.upper);
  EXPECT_TRUE(std::isnan(result.jnd));
}

TEST(TheSummary, SaysCountIntervalTestAndSensitivity) {
  Study study = study_with(Design::abx, abx_task());
  add_answers(study, "P1", "liver", 31, 17);
  EXPECT_THAT(summary_lines(analyse(study, quick())),
              Contains(HasSubstr("31 of 48 right (64.6 %, 95 % 49.5 to 77.8 %), p = 0.030 (one-sided")));
}

TEST(Options, OutOfTheirRangeAreRefused) {
  const Study study = study_with(Design::abx, abx_task());
  EXPECT_THROW((void)analyse(study, {.confidence = 1.5}), std::invalid_argument);
  EXPECT_THROW((void)analyse(study, {.level = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)analyse(study, {.margin = -0.1}), std::invalid_argument);
  EXPECT_THROW((void)analyse(study, {.d_prime_bound = 0.0}), std::invalid_argument);
}

TEST(AStudy, ThatNamesASampleOrASlotThatIsNoneIsRefused) {
  Study study = study_with(Design::abx, abx_task());
  add_answers(study, "P1", "", 1, 1);
  study.judgements[0].pair = {0, 7};
  EXPECT_THROW((void)analyse(study, quick()), std::invalid_argument);
  study.judgements[0].pair = {0, 1};
  study.judgements[0].right = 2;
  EXPECT_THROW((void)analyse(study, quick()), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
