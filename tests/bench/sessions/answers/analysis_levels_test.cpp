#include <cmath>
#include <stdexcept>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answer_pages/analysis_json.h"
#include "answers/analysis.h"
#include "answers/answers_table.h"
#include "bench/sessions/answers/studies.h"
#include "protocol/trial_sequence.h"

namespace kerf::bench {
namespace {

using psychophysics::Axis;
using psychophysics::Psychometric;
using psychophysics::Random;
using psychophysics::Shape;
using test::add_answers;
using test::add_observer;
using test::study_with;
using testing::Contains;
using testing::HasSubstr;

AnalysisOptions quick() { return {.bootstrap = 0}; }

Study constant_study(std::vector<double> levels) {
  Study study = study_with(Design::constant);
  study.scale.levels = std::move(levels);
  return study;
}

Study one_sided() { return constant_study({0.02, 0.04, 0.07, 0.1, 0.15, 0.25}); }

const Psychometric& truth() {
  static const Psychometric curve{.threshold = 0.1, .slope = 2.5, .guess = 0.5, .lapse = 0.02};
  return curve;
}

TEST(ConstantLevels, GiveTheJndOfTheObserver) {
  Study study = one_sided();
  Random random(11);
  add_observer(study, "P1", truth(), 60, random);
  const Analysis found = analyse(study, {.bootstrap = 40});
  ASSERT_TRUE(found.levels && found.levels->pooled.jnd);
  const auto& jnd = *found.levels->pooled.jnd;
  const double wanted = truth().intensity_at(0.75);
  EXPECT_DOUBLE_EQ(jnd.criterion, 0.75);
  EXPECT_LE(jnd.interval.lower, wanted);
  EXPECT_GE(jnd.interval.upper, wanted);
  EXPECT_NEAR(jnd.value, wanted, 0.3 * wanted);
  EXPECT_TRUE(found.levels->by_subject.empty());
  EXPECT_EQ(found.levels->shapes.size(), 3U);
  EXPECT_EQ(found.levels->shapes.front().shape, Shape::weibull);
  ASSERT_TRUE(found.levels->pooled.bootstrap);
  EXPECT_GT(found.levels->pooled.bootstrap->deviance_p, 0.01);
  EXPECT_FALSE(found.all->d_prime);
  EXPECT_THAT(found.all->note, HasSubstr("several levels"));
  EXPECT_DOUBLE_EQ(main_result(study).jnd, jnd.value);
  EXPECT_DOUBLE_EQ(main_result(study).jnd_interval.upper, jnd.interval.upper);
}

// Subjects of JND 5, 10 and 20 %: the geometric mean is 10 %.
TEST(Subjects, WithOtherJndsHaveAMeanWithStudentsInterval) {
  Study study = one_sided();
  Random random(12);
  for (const auto& [subject, factor] : {std::pair{"P1", 0.5}, {"P2", 1.0}, {"P3", 2.0}}) {
    Psychometric own = truth();
    own.threshold *= factor;
    add_observer(study, subject, own, 40, random);
  }
  const Analysis found = analyse(study, quick());
  ASSERT_EQ(found.levels->by_subject.size(), 3U);
  ASSERT_TRUE(found.levels->across);
  const double wanted = truth().intensity_at(0.75);
  EXPECT_NEAR(found.levels->across->mean, wanted, 0.3 * wanted);
  EXPECT_LT(found.levels->across->interval.lower, wanted);
  EXPECT_GT(found.levels->across->interval.upper, wanted);
  EXPECT_LT(found.levels->pooled.fit->overdispersion_p, 0.05);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("Subjects differ")));
}

TEST(People, HaveAJndAndAPseOfAMixedModelInPlaceOfThoseOfPooledAnswers) {
  Study study = constant_study({-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3});
  study.task.reset();
  Random random(3);
  for (int subject = 0; subject < 8; ++subject) {
    Psychometric own{
        .shape = Shape::gaussian, .axis = Axis::linear, .slope = 8.0, .guess = 0.0, .lapse = 0.0};
    own.threshold = 0.03 + 0.08 * random.normal();
    add_observer(study, fmt::format("P{}", subject), own, 16, random);
  }
  AnalysisOptions options = quick();
  options.lapse = 0.0;
  options.jnd_margins = psychophysics::Interval{.lower = 0.04, .upper = 0.2};
  const Analysis found = analyse(study, options);
  ASSERT_TRUE(found.levels->people);
  const PeopleFit& people = *found.levels->people;
  EXPECT_LT(people.equality->interval().lower, 0.03);
  EXPECT_GT(people.equality->interval().upper, 0.03);
  EXPECT_NEAR(people.equality->deviation, 0.08, 0.04);
  EXPECT_LT(people.jnd.interval().lower, 0.6744898 / 8.0);
  EXPECT_GT(people.jnd.interval().upper, 0.6744898 / 8.0);
  EXPECT_EQ(people.jnd_within, true);
  // The pooled curve is flatter than that of any subject: they differ in where it lies.
  EXPECT_GT(found.levels->pooled.jnd->value, 1.15 * people.jnd.mean);
  EXPECT_DOUBLE_EQ(main_result(study, options).jnd, people.jnd.mean);
  EXPECT_DOUBLE_EQ(main_result(study, options).equality, people.equality->mean);
  EXPECT_THAT(found.shows, Contains(HasSubstr("JND of people")));
  const auto json = analysis_as_json(found).at("psychometric").at("people");
  EXPECT_EQ(json.at("subjects"), 8);
  EXPECT_DOUBLE_EQ(json.at("pse").at("value").get<double>(), people.equality->mean);
}

TEST(LevelsOnBothSides, GivePointOfEqualityAndJnd) {
  Study study = constant_study({-0.2, -0.1, -0.05, 0.0, 0.05, 0.1, 0.2});
  study.task.reset();
  const Psychometric curve{.shape = Shape::gaussian,
                           .axis = Axis::linear,
                           .threshold = 0.03,
                           .slope = 12.5,
                           .guess = 0.02,
                           .lapse = 0.02};
  Random random(14);
  add_observer(study, "P1", curve, 60, random);
  const Analysis found = analyse(study, quick());
  ASSERT_TRUE(found.levels->pooled.equality && found.levels->pooled.jnd);
  const auto& equality = *found.levels->pooled.equality;
  const auto& jnd = *found.levels->pooled.jnd;
  EXPECT_LE(equality.interval.lower, 0.03);
  EXPECT_GE(equality.interval.upper, 0.03);
  EXPECT_LE(jnd.interval.lower, 0.6744898 / 12.5);
  EXPECT_GE(jnd.interval.upper, 0.6744898 / 12.5);
  // Level 0 is stronger on neither side: six of seven levels are right or wrong.
  EXPECT_EQ(found.all->count.trials, 360);
  EXPECT_LT(found.p_value, 1e-6);
  EXPECT_DOUBLE_EQ(main_result(study).equality, equality.value);
  EXPECT_EQ(found.levels->shapes.size(), 2U);
}

TEST(AJnd, IsHeldAgainstItsMargins) {
  Study study = one_sided();
  Random random(11);
  add_observer(study, "P1", truth(), 60, random);
  AnalysisOptions options = quick();
  options.jnd_margins = psychophysics::Interval{.lower = 0.0, .upper = 0.5};
  EXPECT_TRUE(analyse(study, options).levels->pooled.jnd_within.value());
  EXPECT_EQ(main_result(study, options).equivalent, true);
  options.jnd_margins = psychophysics::Interval{.lower = 0.0, .upper = 0.05};
  EXPECT_FALSE(analyse(study, options).levels->pooled.jnd_within.value());
}

TEST(Levels, OfWhichAllAnswersAreRightHaveNoJnd) {
  Study study = one_sided();
  Random random(1);
  add_observer(study, "P1", {.threshold = 1e-6, .slope = 5.0, .guess = 0.5, .lapse = 0.0}, 5, random);
  const Analysis found = analyse(study, quick());
  EXPECT_FALSE(found.levels->pooled.fit);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("all 30 answers are right")));
  const auto json = analysis_as_json(found);
  EXPECT_TRUE(json.at("psychometric").at("all").at("jnd").is_null());
  EXPECT_FALSE(json.at("psychometric").at("all").at("notes").empty());
  EXPECT_THAT(main_result(study).note, HasSubstr("all 30 answers are right"));
}

TEST(Levels, OfWhichNoAnswerIsRightHaveNoJnd) {
  Study study = one_sided();
  for (const double level : study.scale.levels)
    study.judgements.push_back({.subject = "P1", .level = level, .right = 0, .answer = 1});
  EXPECT_THAT(analyse(study, quick()).warnings, Contains(HasSubstr("no answer is right")));
}

TEST(Levels, OfASubjectWhoGuessesHaveNoJnd) {
  Study study = one_sided();
  Random random(5);
  add_observer(study, "P1", {.threshold = 1e6, .slope = 5.0, .guess = 0.5, .lapse = 0.0}, 20, random);
  const Analysis found = analyse(study, quick());
  EXPECT_FALSE(found.levels->pooled.jnd);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("o JND")));
  EXPECT_TRUE(std::isnan(main_result(study).jnd));
}

// One level is no curve, but a forced choice of two like any other: d' of 15 in 20.
TEST(OneLevelAlone, HasADPrimeInPlaceOfAJnd) {
  Study study = constant_study({0.1});
  add_answers(study, "P1", "", 15, 5);
  for (Judgement& judgement : study.judgements) judgement.level = 0.1;
  const Analysis found = analyse(study, quick());
  EXPECT_FALSE(found.levels->pooled.fit);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("at one level")));
  ASSERT_TRUE(found.all->d_prime);
  EXPECT_NEAR(found.all->d_prime->value, std::sqrt(2.0) * 0.6744898, 1e-6);
}

TEST(Levels, ThatAreNoNumbersAreRefused) {
  Study study = one_sided();
  add_answers(study, "P1", "", 1, 1);
  EXPECT_THROW((void)analyse(study, quick()), std::invalid_argument);
}

Study staircase_study(double threshold, std::uint64_t seed) {
  Study study = study_with(Design::staircase);
  study.scale.staircase.start = 0.4;
  study.scale.staircase.least = 0.001;
  study.scale.staircase.most = 2.0;
  study.scale.staircase.reversals = 24;
  psychophysics::Staircase staircase(study.scale.staircase);
  const Psychometric observer{.threshold = threshold, .slope = 2.5, .guess = 0.5, .lapse = 0.0};
  Random random(seed);
  while (!staircase.finished()) {
    const double level = staircase.next();
    const bool is_right = random.chance(observer.probability(level));
    const std::size_t slot = random.below(2);
    study.judgements.push_back(
        {.subject = "P1", .level = level, .right = slot, .answer = is_right ? slot : 1 - slot});
    staircase.answer(is_right);
  }
  return study;
}

TEST(AStaircase, HasTheMeanOfItsReversalsAndACurve) {
  const Study study = staircase_study(0.1, 3);
  const Analysis found = analyse(study, quick());
  ASSERT_EQ(found.tracks.size(), 1U);
  ASSERT_TRUE(found.tracks[0].staircase);
  EXPECT_NEAR(found.tracks[0].staircase->probability, std::sqrt(0.5), 1e-9);
  EXPECT_EQ(found.tracks[0].reversals.size(), 24U);
  EXPECT_NEAR(found.tracks[0].staircase->threshold, 0.1, 0.04);
  ASSERT_TRUE(found.levels->pooled.jnd);
  EXPECT_LE(found.levels->pooled.jnd->interval.lower, 0.0864);  // where the observer is right in 75 %
  EXPECT_GE(found.levels->pooled.jnd->interval.upper, 0.0864);
}

TEST(AStaircase, HasTheJndOfItsPosterior) {
  const Analysis found = analyse(staircase_study(0.1, 3), quick());
  ASSERT_TRUE(found.levels->pooled.jnd);
  EXPECT_TRUE(found.levels->pooled.by_posterior);
  EXPECT_THAT(found.warnings, Not(Contains(HasSubstr("too narrow"))));
}

TEST(AStaircase, OfSeveralSubjectsSaysThatItsPooledIntervalIsTooNarrow) {
  Study study = staircase_study(0.1, 3);
  for (Judgement judgement : staircase_study(0.1, 4).judgements) {
    judgement.subject = "another";
    study.judgements.push_back(judgement);
  }
  const Analysis found = analyse(study, quick());
  EXPECT_FALSE(found.levels->pooled.by_posterior);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("too narrow")));
  ASSERT_EQ(found.levels->by_subject.size(), 2U);
  EXPECT_TRUE(found.levels->by_subject[0].by_posterior);
}

TEST(AStaircase, HasNoTestOfItsCount) {
  const Analysis found = analyse(staircase_study(0.1, 3), quick());
  EXPECT_TRUE(std::isnan(found.p_value));
  EXPECT_THAT(found.main_test, HasSubstr("follows the answers"));
  EXPECT_TRUE(analysis_as_json(found).at("p_value").is_null());
}

TEST(AStaircase, WhoseLevelsAreNotThoseOfItsRuleHasNoMeanOfReversals) {
  Study study = staircase_study(0.1, 3);
  study.judgements[5].level *= 1.01;
  const Analysis found = analyse(study, quick());
  EXPECT_FALSE(found.tracks[0].staircase);
  EXPECT_THAT(found.tracks[0].note, HasSubstr("trial 6"));
}

TEST(AQuestSession, HasItsPosteriorAndACurve) {
  Study study = study_with(Design::quest_plus);
  study.scale.levels = psychophysics::geometric_grid(0.01, 1.0, 17);
  psychophysics::QuestPlus quest(quest_options_of(study.scale, 0.5));
  Random random(10);
  while (!quest.finished()) {
    const double level = quest.next();
    const bool is_right = random.chance(truth().probability(level));
    const std::size_t slot = random.below(2);
    study.judgements.push_back(
        {.subject = "P1", .level = level, .right = slot, .answer = is_right ? slot : 1 - slot});
    quest.answer(is_right);
  }
  const Analysis found = analyse(study, quick());
  ASSERT_EQ(found.tracks.size(), 1U);
  ASSERT_TRUE(found.tracks[0].quest);
  EXPECT_NEAR(found.tracks[0].quest->threshold, quest.estimate().threshold, 1e-9);
  EXPECT_LE(found.tracks[0].quest->interval.lower, 0.1);
  EXPECT_GE(found.tracks[0].quest->interval.upper, 0.1);
  EXPECT_TRUE(found.levels->pooled.jnd);
}

TEST(InterleavedStaircases, HaveTheMeanOfTheirReversalsEach) {
  Study study = staircase_study(0.1, 3);
  const std::size_t first = study.judgements.size();
  study.scale.interleaved = {study.scale.staircase};
  study.scale.interleaved[0].down = 3;
  study.scale.interleaved[0].start = 0.03;
  Study other = study;
  other.scale.staircase = study.scale.interleaved[0];
  other.judgements.clear();
  psychophysics::Staircase staircase(other.scale.staircase);
  Random random(8);
  const Psychometric observer{.threshold = 0.1, .slope = 2.5, .guess = 0.5, .lapse = 0.0};
  while (!staircase.finished()) {
    const double level = staircase.next();
    const bool is_right = random.chance(observer.probability(level));
    study.judgements.push_back(
        {.subject = "P1", .level = level, .track = 1, .right = 0, .answer = is_right ? 0U : 1U});
    staircase.answer(is_right);
  }
  const Analysis found = analyse(study, quick());
  ASSERT_EQ(found.tracks.size(), 2U);
  EXPECT_EQ(found.tracks[0].levels.size(), first);
  ASSERT_TRUE(found.tracks[0].staircase && found.tracks[1].staircase);
  EXPECT_NEAR(found.tracks[1].staircase->probability, std::cbrt(0.5), 1e-9);
  EXPECT_EQ(found.tracks[1].staircase->threshold, staircase.estimate().threshold);
  EXPECT_EQ(found.levels->pooled.fit->degrees_of_freedom > 0, true);
  EXPECT_EQ(analysis_as_json(found).at("tracks")[1].at("staircase"), 2);
  // As a table whose rules are not known.
  const Study again = parse_answers(answers_csv(study), "answers.csv");
  EXPECT_EQ(again.judgements.back().track, 1U);
  const Analysis of_table = analyse(again, quick());
  ASSERT_EQ(of_table.tracks.size(), 2U);
  EXPECT_THAT(of_table.tracks[1].note, HasSubstr("staircase 2 is not known"));
}

TEST(AQuestSession, ThatEndsByAnIntervalHasNoTestOfItsCount) {
  Study study = study_with(Design::quest_plus);
  study.scale.levels = {0.05, 0.1, 0.2};
  for (const double level : {0.05, 0.1, 0.2, 0.2, 0.1, 0.05, 0.1, 0.2})
    study.judgements.push_back(
        {.subject = "P1", .level = level, .right = 0, .answer = level < 0.1 ? 1U : 0U});
  EXPECT_LT(analyse(study, quick()).p_value, 1.0);
  study.scale.quest.narrow = 2.5;
  const Analysis found = analyse(study, quick());
  EXPECT_TRUE(std::isnan(found.p_value));
  EXPECT_THAT(found.main_test, HasSubstr("QUEST+ that ends by an interval"));
  const Study again = parse_answers(answers_csv(study), "answers.csv");
  EXPECT_EQ(again.scale.quest.narrow, 2.5);
  EXPECT_TRUE(std::isnan(analyse(again, quick()).p_value));
}

TEST(TheSessions, OfASubjectHaveATrackEach) {
  Study study = staircase_study(0.1, 3);
  Study again = staircase_study(0.1, 4);
  for (Judgement& judgement : again.judgements) {
    judgement.session = 2;
    study.judgements.push_back(judgement);
  }
  const Analysis found = analyse(study, quick());
  ASSERT_EQ(found.tracks.size(), 2U);
  EXPECT_TRUE(found.tracks[0].staircase && found.tracks[1].staircase);
}

}  // namespace
}  // namespace kerf::bench
