#include "observers/observer.h"

#include <numbers>

#include <gtest/gtest.h>

#include <kerf/psychophysics/dprime.h>

namespace kerf::bench {

/// Told by name where a case fails; its padding would differ from run to run.
void PrintTo(const FeltTrial& trial, std::ostream* out);
void PrintTo(const FeltTrial& trial, std::ostream* out) {
  *out << "judging " << static_cast<int>(trial.judging) << ", slots";
  for (std::size_t slot = 0; slot < trial.slots; ++slot) *out << ' ' << int{trial.plays[slot]};
  *out << ", d' " << trial.d_prime;
}

namespace {

using psychophysics::Decision;
using psychophysics::proportion_correct;

double normal(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

Observer attentive() { return {.lapse = 0.0}; }

TEST(Observer, FeelsOneJndWhereAForceIsStrongerByItsWeberFraction) {
  const Observer observer{.jnd = 0.07};
  EXPECT_NEAR(strength_in_jnds(observer, 2.14) - strength_in_jnds(observer, 2.0), 1.0, 1e-12);
  EXPECT_NEAR(strength_in_jnds(observer, 7.0 * 1.07) - strength_in_jnds(observer, 7.0), 1.0, 1e-12);
}

TEST(Observer, FeelsWeakForcesByTheirDifferenceInNewtons) {
  const Observer observer{.jnd = 0.07, .least_jnd_n = 0.05};
  EXPECT_NEAR(strength_in_jnds(observer, 0.35) - strength_in_jnds(observer, 0.3), 1.0, 1e-12);
  EXPECT_EQ(strength_in_jnds(observer, 0.0), 0.0);
}

TEST(Observer, StrengthIsTheIntegralOfOneOverTheJnd) {
  const Observer observer{.jnd = 0.1, .least_jnd_n = 0.04};
  double sum = 0.0;
  const double step = 1e-5;
  for (double force = 0.5 * step; force < 3.0; force += step) sum += step / jnd_at(observer, force);
  EXPECT_NEAR(strength_in_jnds(observer, 3.0), sum, 1e-4);
}

TEST(Observer, TellsTwoForcesOneJndApartInTheShareThatTheJndBelongsTo) {
  for (const double criterion : {0.71, 0.75, 0.84}) {
    Observer observer = attentive();
    observer.criterion = criterion;
    const FeltTrial trial{.plays = {1, 0, 0}, .d_prime = d_prime_per_jnd(observer)};
    EXPECT_NEAR(answer_probability(observer, trial, 0), criterion, 1e-12);
  }
  EXPECT_NEAR(d_prime_per_jnd(attentive()), 0.9539, 1e-4);
}

TEST(Observer, IsRightAsOftenAsThePublishedEquationsSay) {
  const Observer observer = attentive();
  for (const double d : {0.0, 0.7, 1.5, 3.0}) {
    const auto right = [&](Judging judging, std::size_t slots, std::array<std::uint8_t, 3> plays,
                           std::size_t slot) {
      return answer_probability(observer, {judging, slots, plays, d}, slot);
    };
    EXPECT_NEAR(right(Judging::strongest, 2, {0, 1, 0}, 1), proportion_correct({.intervals = 2}, d), 1e-12);
    EXPECT_NEAR(right(Judging::strongest, 3, {0, 0, 1}, 2), proportion_correct({.intervals = 3}, d), 1e-9);
    EXPECT_NEAR(right(Judging::odd_one_out, 3, {1, 0, 1}, 1),
                proportion_correct({.decision = Decision::oddity}, d), 1e-12);
    EXPECT_NEAR(right(Judging::abx_independent, 3, {0, 1, 1}, 1),
                proportion_correct({.decision = Decision::abx_independent}, d), 1e-12);
    EXPECT_NEAR(right(Judging::abx_differencing, 3, {0, 1, 0}, 0),
                proportion_correct({.decision = Decision::abx_differencing}, d), 1e-12);
  }
}

TEST(Observer, WithLapsesIsNeverAlwaysRight) {
  const Observer observer{.lapse = 0.06};
  EXPECT_NEAR(answer_probability(observer, {.plays = {0, 1, 0}, .d_prime = 30.0}, 1), 0.97, 1e-12);
  EXPECT_NEAR(answer_probability(observer, {Judging::odd_one_out, 3, {1, 0, 0}, 30.0}, 0), 0.96, 1e-9);
}

TEST(Observer, WithABiasNamesTheFirstOfTwoThatAreTheSame) {
  Observer observer = attentive();
  observer.bias = 0.5;
  EXPECT_NEAR(answer_probability(observer, {.plays = {0, 1, 0}}, 0), normal(0.5 / std::numbers::sqrt2),
              1e-12);
}

TEST(Observer, HasNoPreferenceForWhatCannotBeTold) {
  Observer observer = attentive();
  observer.preference = 2.0;
  const auto second_preferred = [&](double d) {
    return answer_probability(observer, {Judging::preference, 2, {0, 1, 0}, d}, 1);
  };
  EXPECT_NEAR(second_preferred(0.0), 0.5, 1e-12);
  EXPECT_NEAR(second_preferred(30.0), normal(2.0 / std::numbers::sqrt2), 1e-12);
  observer.preference = 0.0;
  EXPECT_NEAR(second_preferred(30.0), 0.5, 1e-12);
}

TEST(Observer, IsRefusedWithWhatCannotBe) {
  EXPECT_THROW(require_observer({.jnd = 0.0}), std::invalid_argument);
  EXPECT_THROW(require_observer({.least_jnd_n = 0.0}), std::invalid_argument);
  EXPECT_THROW(require_observer({.criterion = 0.5}), std::invalid_argument);
  EXPECT_THROW(require_observer({.lapse = 1.0}), std::invalid_argument);
  EXPECT_THROW(require_observer({.bias = NAN}), std::invalid_argument);
  EXPECT_THROW(require_observer({.spread = -0.1}), std::invalid_argument);
  EXPECT_NO_THROW(require_observer({}));
}

class Drawn : public testing::TestWithParam<FeltTrial> {};

TEST_P(Drawn, AnswersComeAsOftenAsTheyShould) {
  constexpr int draws = 20000;
  const Observer observer{.lapse = 0.05, .bias = 0.4, .preference = 1.2};
  psychophysics::Random random(7);
  std::array<int, 3> answers{};
  for (int i = 0; i < draws; ++i) ++answers[drawn_answer(observer, GetParam(), random)];
  double sum = 0.0;
  for (std::size_t slot = 0; slot < 3; ++slot) {
    const bool is_answer = slot < 2 || GetParam().judging == Judging::odd_one_out ||
                           (GetParam().judging == Judging::strongest && GetParam().slots == 3);
    if (!is_answer) {
      EXPECT_EQ(answers[slot], 0);
      continue;
    }
    const double p = answer_probability(observer, GetParam(), slot);
    sum += p;
    EXPECT_NEAR(answers[slot] / double{draws}, p, 4.0 * std::sqrt(p * (1.0 - p) / draws)) << "slot " << slot;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(EveryDesign, Drawn,
                         testing::Values(FeltTrial{Judging::strongest, 2, {1, 0, 0}, 0.9},
                                         FeltTrial{Judging::strongest, 2, {0, 1, 0}, 0.9},
                                         FeltTrial{Judging::strongest, 2, {0, 1, 0}, -0.7},
                                         FeltTrial{Judging::strongest, 3, {1, 0, 0}, 1.1},
                                         FeltTrial{Judging::strongest, 3, {0, 0, 1}, 1.1},
                                         FeltTrial{Judging::abx_independent, 3, {0, 1, 1}, 1.4},
                                         FeltTrial{Judging::abx_independent, 3, {1, 0, 1}, 1.4},
                                         FeltTrial{Judging::abx_differencing, 3, {0, 1, 1}, 1.4},
                                         FeltTrial{Judging::abx_differencing, 3, {1, 0, 0}, 2.5},
                                         FeltTrial{Judging::odd_one_out, 3, {0, 1, 0}, 2.0},
                                         FeltTrial{Judging::odd_one_out, 3, {1, 1, 0}, 2.0},
                                         FeltTrial{Judging::preference, 2, {0, 1, 0}, 1.5},
                                         FeltTrial{Judging::preference, 2, {1, 0, 0}, 1.5}));

class DrawnWords : public testing::TestWithParam<FeltTrial> {};

TEST_P(DrawnWords, ComeAsOftenAsTheyShould) {
  constexpr int draws = 20000;
  const Observer observer{.lapse = 0.05, .bias = 0.3};
  const std::size_t choices = 2 * std::max<std::size_t>(1, GetParam().confidence);
  psychophysics::Random random(7);
  std::vector<int> answers(choices);
  for (int i = 0; i < draws; ++i) ++answers.at(drawn_answer(observer, GetParam(), random));
  double sum = 0.0;
  for (std::size_t choice = 0; choice < choices; ++choice) {
    const double p = answer_probability(observer, GetParam(), choice);
    sum += p;
    EXPECT_NEAR(answers[choice] / double{draws}, p, 4.0 * std::sqrt(p * (1.0 - p) / draws)) << choice;
  }
  EXPECT_NEAR(sum, 1.0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    EveryRule, DrawnWords,
    testing::Values(
        FeltTrial{.judging = Judging::same_by_likelihood, .plays = {0, 1, 0}, .d_prime = 1.7},
        FeltTrial{.judging = Judging::same_by_likelihood, .plays = {1, 1, 0}, .d_prime = 1.7},
        FeltTrial{.judging = Judging::same_by_likelihood, .plays = {1, 0, 0}, .d_prime = 0.0},
        FeltTrial{.judging = Judging::same_by_differencing, .plays = {1, 0, 0}, .d_prime = 1.7},
        FeltTrial{.judging = Judging::same_by_differencing, .plays = {0, 0, 0}, .d_prime = 0.0},
        FeltTrial{
            .judging = Judging::yes_no, .slots = 1, .plays = {1, 0, 0}, .d_prime = 1.2, .confidence = 3},
        FeltTrial{
            .judging = Judging::yes_no, .slots = 1, .plays = {0, 0, 0}, .d_prime = 1.2, .confidence = 3},
        FeltTrial{.judging = Judging::yes_no, .slots = 1, .plays = {1, 0, 0}, .d_prime = 1.2}));

}  // namespace
}  // namespace kerf::bench
