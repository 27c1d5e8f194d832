#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/psychophysics/dprime.h>

#include "answer_pages/analysis_json.h"
#include "answers/analysis.h"
#include "answers/answers_table.h"
#include "bench/sessions/answers/studies.h"

// Same-different, and yes-no with confidence: answers that are words, and a tendency to one of them.

namespace kerf::bench {
namespace {

using test::study_with;
using testing::HasSubstr;

AnalysisOptions without_bootstrap() { return {.bootstrap = 0}; }

/// So many words of each kind from one subject.
void add_words(Study& study, const std::string& subject, psychophysics::Count hits,
               psychophysics::Count false_alarms, std::size_t confidence = 0) {
  const auto add = [&](std::size_t right, psychophysics::Count count) {
    for (int i = 0; i < count.trials; ++i) {
      study.judgements.push_back({.subject = subject,
                                  .pair = {0, 1},
                                  .right = right,
                                  .answer = i < count.successes ? 1U : 0U,
                                  .confidence = confidence});
    }
  };
  add(1, hits);
  add(0, false_alarms);
}

TEST(SameDifferentAnswers, HaveADPrimeFreedOfTheLeaning) {
  Study study =
      study_with(Design::same_different, {.decision = psychophysics::Decision::same_different_differencing});
  add_words(study, "P1", {38, 50}, {15, 50});
  const Analysis found = analyse(study, without_bootstrap());
  EXPECT_EQ(found.all->count.successes, 38 + 35);
  ASSERT_TRUE(found.all->d_prime);
  EXPECT_NEAR(found.all->d_prime->value, 2.45189788, 1e-6);
  EXPECT_NEAR(found.all->d_prime->interval.lower, 1.7530303944, 1e-5);
  ASSERT_TRUE(found.bias.detection);
  EXPECT_NEAR(found.bias.detection->criterion, 1.46573816, 1e-6);
  EXPECT_TRUE(std::isinf(found.all->excluded_d_prime)) << "a share says less than d' where somebody leans";
  study.task = psychophysics::Task{psychophysics::Decision::same_different};
  EXPECT_LT(analyse(study, without_bootstrap()).all->d_prime->value, 2.0) << "by likelihood it takes less";
  const Study again = parse_answers(answers_csv(study), "answers.csv");
  EXPECT_EQ(again.task->decision, psychophysics::Decision::same_different);
  EXPECT_EQ(analyse(again, without_bootstrap()).all->d_prime->value,
            analyse(study, without_bootstrap()).all->d_prime->value);
}

TEST(SameDifferentAnswers, AreTestedOverPeople) {
  Study study = study_with(Design::same_different, {.decision = psychophysics::Decision::same_different});
  for (int i = 0; i < 8; ++i) add_words(study, fmt::format("S{}", i), {14, 20}, {9 - i % 3, 20});
  const Analysis found = analyse(study, without_bootstrap());
  EXPECT_TRUE(found.all->tests_subjects);
  EXPECT_NEAR(found.p_value, 1.0 / 256.0, 1e-12);
}

TEST(YesNoAnswers, HaveRatingsAndAnArea) {
  Study study = study_with(Design::yes_no, {.decision = psychophysics::Decision::yes_no});
  study.confidence_levels = 3;
  const std::vector<int> noise{174, 172, 104, 92, 41, 8};
  const std::vector<int> signal{46, 57, 66, 101, 154, 173};
  for (std::size_t category = 0; category < 6; ++category) {
    const bool yes = category > 2;
    for (int i = 0; i < noise[category] + signal[category]; ++i) {
      study.judgements.push_back({.subject = "P1",
                                  .pair = {0, 1},
                                  .right = i < noise[category] ? 0U : 1U,
                                  .answer = yes ? 1U : 0U,
                                  .confidence = yes ? category - 2 : 3 - category});
    }
  }
  const Analysis found = analyse(study, without_bootstrap());
  ASSERT_TRUE(found.ratings && found.ratings->all.area && found.ratings->all.fit);
  EXPECT_NEAR(found.ratings->all.area->value, 0.8031188089, 1e-9);
  EXPECT_NEAR(found.ratings->all.fit->d_a, 1.2387338, 1e-5);
  // Twice the log-likelihoods' difference is 31.49, of one degree.
  EXPECT_NEAR(*found.ratings->all.equal_variances_p, 2.0e-8, 5e-9);
  ASSERT_TRUE(found.all->d_prime);
  const double hits = (101.0 + 154.0 + 173.0) / 597.0;
  const double alarms = (92.0 + 41.0 + 8.0) / 591.0;
  const auto z = [](double p) { return psychophysics::d_prime({psychophysics::Decision::yes_no}, p) / 2.0; };
  EXPECT_NEAR(found.all->d_prime->value, z(hits) - z(alarms), 1e-12);
  const auto json = analysis_as_json(found);
  EXPECT_NEAR(json.at("ratings").at("all").at("normal").at("deviation").get<double>(), 1.4168960, 2e-5);
  const Study again = parse_answers(answers_csv(study), "answers.csv");
  EXPECT_EQ(again.confidence_levels, 3U);
  EXPECT_EQ(analyse(again, without_bootstrap()).ratings->all.area->value, found.ratings->all.area->value);
}

TEST(YesNoAnswers, HaveAMeanDPrimeOfPeople) {
  Study study = study_with(Design::yes_no, {.decision = psychophysics::Decision::yes_no});
  add_words(study, "P1", {80, 100}, {30, 100});
  add_words(study, "P2", {60, 100}, {30, 100});
  add_words(study, "P3", {70, 100}, {10, 100});
  const Analysis found = analyse(study, without_bootstrap());
  ASSERT_TRUE(found.spread.population && found.spread.population->d_prime);
  // In SciPy: 1.366022, 0.777748, 1.805952, their mean and Student's interval of two degrees.
  EXPECT_NEAR(found.spread.population->d_prime_of_mean, 1.3165738, 1e-6);
  EXPECT_NEAR(found.spread.population->d_prime->lower, 0.0350502, 1e-6);
  EXPECT_NEAR(found.spread.population->d_prime->upper, 2.5980974, 1e-6);
}

TEST(YesNoAnswers, OfOneKindAloneHaveNoDPrime) {
  Study study = study_with(Design::yes_no, {.decision = psychophysics::Decision::yes_no});
  add_words(study, "P1", {8, 10}, {0, 0});
  const Analysis found = analyse(study, without_bootstrap());
  EXPECT_FALSE(found.all->d_prime);
  EXPECT_THAT(found.all->note, HasSubstr("trials of both kinds"));
  study.judgements[0].answer = 2;
  EXPECT_THROW((void)analyse(study, without_bootstrap()), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
