#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/fit.h>

#include "fitting/strokes.h"
#include "training/training.h"

namespace kerf::fitting {
namespace {

using models::Law;
using test::Strokes;

const Law kelvin = Law::make("kelvin", std::vector{5.0, 8.0, 1.6});

TEST(SeveralRecordings, ShareTheirParameters) {
  const Strokes one(3000, 0.02, kelvin, 1);
  const Strokes two(3000, 0.02, kelvin, 2);
  const std::array both{one.series(), two.series()};
  const auto alone = fit("kelvin", one.series(), {.folds = 0});
  const auto together = fit("kelvin", both, {.folds = 0});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(together.parameters[i].value, kelvin.values()[i], 4.0 * together.parameters[i].std_error);
    EXPECT_NEAR(together.parameters[i].std_error / alone.parameters[i].std_error, std::sqrt(0.5), 0.12);
  }
}

TEST(SeveralRecordings, MayEachHaveADashpotOfTheirOwn) {
  const Law stiffer = Law::make("kelvin", std::vector{5.0, 8.0, 3.2});
  const Strokes one(3000, 0.0, kelvin);
  const Strokes two(3000, 0.0, stiffer);
  const std::array both{one.series(), two.series()};
  const auto result = fit("kelvin", both, {.folds = 0, .per_recording = {"damping"}});
  EXPECT_EQ(result.free_parameters, 4U);
  EXPECT_NEAR(result.law(0).values()[2], 1.6, 1e-6);
  EXPECT_NEAR(result.law(1).values()[2], 3.2, 1e-6);
  EXPECT_NEAR(result.law(1).values()[0], 5.0, 1e-6);
  ASSERT_EQ(result.others.size(), 1U);
  EXPECT_EQ(result.others[0].recording, 1U);
}

// Friction of which one recording has none is known of the other all the same.
TEST(SeveralRecordings, AreEachAsUncertainWhereOneLiesAtABound) {
  const Strokes rough(3000, 0.02, Law::make("friction", std::vector{0.0, 5.0, 0.5, 0.4, 0.01}), 1);
  const Strokes smooth(3000, 0.02, Law::make("friction", std::vector{0.0, 5.0, 0.5, 0.0, 0.01}), 2);
  const std::array both{rough.series(), smooth.series()};
  const auto result = fit("friction", both, {.folds = 0, .per_recording = {"coulomb"}});
  const auto alone = fit("friction", rough.series(), {.folds = 0});
  const Estimate& known = result.parameters[3];
  EXPECT_EQ(known.info.name, "coulomb");
  EXPECT_NE(known.by, IntervalBy::held);
  EXPECT_GT(known.std_error, 0.2 * alone.parameters[3].std_error)
      << "the other recording tells what they share";
  EXPECT_LT(known.std_error, 1.2 * alone.parameters[3].std_error);
  EXPECT_LT(result.others.at(0).value, 0.01);
}

TEST(SeveralRecordings, CountByTheirNoise) {
  // The noisy one lies, by a force that is 10 % too large; unknown noise is estimated, so it counts little.
  const Law louder = Law::make("kelvin", std::vector{5.5, 8.8, 1.76});
  const Strokes quiet(3000, 0.01, kelvin, 1);
  const Strokes noisy(3000, 1.0, louder, 2);
  const std::array both{quiet.series(), noisy.series()};
  EXPECT_NEAR(fit("kelvin", both, {.folds = 0}).parameters[0].value, 5.0, 0.02);
}

TEST(SeveralRecordings, RefuseANameThatIsNoParameter) {
  const Strokes one(3000, 0.0, kelvin);
  const std::array both{one.series(), one.series()};
  EXPECT_THROW((void)fit("kelvin", both, {.per_recording = {"speed"}}), std::invalid_argument);
}

TEST(Loss, OfHuberIsNotMovedByHits) {
  Strokes strokes(4000, 0.02, kelvin);
  for (std::size_t i = 0; i < strokes.force.size(); i += 25) strokes.force[i] += 5.0;  // 4 % of all
  const auto plain = fit("kelvin", strokes.series(), {.folds = 0});
  const double missed = std::abs(plain.parameters[0].value - 5.0);
  for (const Loss loss : {Loss::huber, Loss::soft_l1, Loss::cauchy}) {
    const auto robust = fit("kelvin", strokes.series(), {.folds = 0, .loss = loss});
    EXPECT_LT(std::abs(robust.parameters[0].value - 5.0), 0.1 * missed);
    EXPECT_TRUE(robust.converged);
  }
}

TEST(Loss, SaysTheScaleThatItTook) {
  const Strokes strokes(4000, 0.02, kelvin);
  const auto scale_of = [&](const FitOptions& options) {
    return fit("kelvin", strokes.series(), options).loss_scale_n;
  };
  EXPECT_NEAR(scale_of({.folds = 0, .loss = Loss::huber}), 1.345 * 0.02, 0.05 * 1.345 * 0.02);
  EXPECT_EQ(scale_of({.folds = 0, .loss = Loss::huber, .loss_scale_n = 0.1}), 0.1);
  EXPECT_EQ(scale_of({.folds = 0}), 0.0);
}

TEST(TestShare, IsSeenByNoFit) {
  Strokes strokes(8000, 0.0, kelvin);
  for (std::size_t i = 0; i < strokes.force.size(); ++i) {
    if (strokes.cycle[i] > 4) strokes.force[i] += 1.0;  // the last cycles are of another world
  }
  const auto result = fit("kelvin", strokes.series(true), {.test_share = 0.34});
  EXPECT_NEAR(result.parameters[0].value, 5.0, 1e-5);
  EXPECT_NEAR(result.test_rmse, 1.0, 1e-5);
  EXPECT_NEAR(result.cv_rmse, 0.0, 1e-5);
  EXPECT_TRUE(std::isnan(fit("kelvin", strokes.series(true), {.folds = 0}).cv_rmse));
}

TEST(TestShare, IsSeenByNoErrorEither) {
  constexpr std::size_t kept = 2250;
  const Strokes one(3000, 0.02, kelvin, 1);
  const Strokes two(3000, 0.02, kelvin, 2);
  const auto begin_of = [](const Strokes& strokes) {
    return Series{.time_s = std::span(strokes.time_s).first(kept),
                  .penetration = std::span(strokes.penetration).first(kept),
                  .velocity = std::span(strokes.velocity).first(kept),
                  .force = std::span(strokes.force).first(kept),
                  .cycle = {}};
  };
  const auto held_back =
      fit("kelvin", std::array{one.series(), two.series()}, {.folds = 0, .test_share = 0.25});
  const auto cut = fit("kelvin", std::array{begin_of(one), begin_of(two)}, {.folds = 0});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(held_back.parameters[i].value / cut.parameters[i].value, 1.0, 1e-6);
    EXPECT_NEAR(held_back.parameters[i].std_error / cut.parameters[i].std_error, 1.0, 1e-3);
  }
}

TEST(Table, IsAsUncertainAsItsNoiseMakesIt) {
  const Law spring = Law::make("exponential", std::vector{1.0, 2.0, 1e-6});
  const auto truth = fit("recording", Strokes(6000, 0.0, spring).series(), {.folds = 0});
  const auto noisy = fit("recording", Strokes(6000, 0.02, spring).series(), {.folds = 0});
  int known = 0;
  for (std::size_t i = 0; i < noisy.parameters.size(); ++i) {
    const Estimate& found = noisy.parameters[i];
    if (!std::isfinite(found.std_error)) continue;
    ++known;
    EXPECT_LT(found.std_error, 0.1) << i;
    EXPECT_LT(std::abs(found.value - truth.parameters[i].value), 6.0 * found.std_error) << i;
  }
  EXPECT_GT(known, static_cast<int>(noisy.parameters.size()) / 2);
}

TEST(Table, IsLessUncertainUnderALossThatForgives) {
  Strokes strokes(6000, 0.01, Law::make("exponential", std::vector{1.0, 2.0, 1e-6}));
  for (std::size_t i = 0; i < strokes.force.size(); i += 25) strokes.force[i] += i % 2 == 0 ? 5.0 : -5.0;
  const auto errors_of = [&](Loss loss) {
    std::vector<double> errors;
    for (const Estimate& one : fit("recording", strokes.series(), {.folds = 0, .loss = loss}).parameters)
      errors.push_back(one.std_error);
    std::ranges::nth_element(errors, errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2));
    return errors[errors.size() / 2];
  };
  EXPECT_LT(errors_of(Loss::cauchy), 0.1 * errors_of(Loss::squares));
}

// A tool that comes from 0.1 m above the tissue: of its force nothing counts before it is felt.
TEST(Table, IsFreeWhereNothingIsFelt) {
  Strokes strokes(6000, 0.02, Law::make("exponential", std::vector{0.05, 1.2, 1e-6}));
  std::vector<std::uint8_t> counts;
  for (std::size_t i = 0; i < strokes.force.size(); ++i) {
    const bool is_free = strokes.penetration[i] < 0.2;
    if (is_free) strokes.force[i] = i % 2 == 0 ? 0.02 : -0.02;
    counts.push_back(is_free ? 0 : 1);
  }
  Series series = strokes.series();
  series.counts = counts;
  const auto found = fit("recording", series, {.folds = 0});
  EXPECT_LT(std::abs(found.parameters.front().value), 0.02);
  EXPECT_LT(std::abs(found.parameters[20].value), 0.02);
  EXPECT_LT(found.free_fraction, 0.05) << "at its edge";
}

// The line through what is felt of a tissue that stiffens pulls where the tool is free.
TEST(Choice, LeavesOutALawThatIsFeltInFreeAir) {
  Strokes strokes(6000, 0.002, Law::make("exponential", std::vector{0.01, 1.5, 1e-6}));
  std::vector<std::uint8_t> counts;
  for (const double force : strokes.force) counts.push_back(force > 0.05 ? 1 : 0);
  Series series = strokes.series(true);
  series.counts = counts;
  const FitOptions options{.law_options = {{"segments", 1.0}}};
  const std::array results{fit("piecewise", series, options), fit("exponential", series, {})};
  EXPECT_GT(results[0].free_fraction, 0.5);
  EXPECT_GE(results[0].r2, 0.0);
  EXPECT_FALSE(results[0].can_be_chosen());
  EXPECT_EQ(choose_simplest(results, series, {}).model, "exponential");
}

TEST(Table, SettlesUnderALossThatForgives) {
  const auto found =
      fit("recording", Strokes(3000, 0.02, kelvin).series(), {.folds = 0, .loss = Loss::huber});
  EXPECT_TRUE(found.converged);
  EXPECT_GT(found.iterations, 1);
  EXPECT_LT(found.iterations, 50) << "as many as it may take";
}

TEST(CrossValidation, ByTwoFoldsOfCyclesSeesTheNoiseAlone) {
  const Strokes strokes(6000, 0.02, kelvin);
  EXPECT_NEAR(fit("kelvin", strokes.series(true), {.folds = 2}).cv_rmse, 0.02, 1e-3);
}

TEST(CrossValidation, SaysHowWellItsErrorIsKnown) {
  // The root of the mean square of n independent samples of noise s varies by s / sqrt(2 n).
  const auto result = fit("kelvin", Strokes(6000, 0.02, kelvin).series(), {.folds = 20});
  const double known = 0.02 / std::sqrt(2.0 * 6000.0);
  EXPECT_NEAR(result.cv_std_error, known, 0.5 * known);
  ASSERT_EQ(result.cv_folds.size(), 20U);
  double squares = 0.0;
  for (const double fold : result.cv_folds) squares += fold * fold / 20.0;
  EXPECT_NEAR(std::sqrt(squares), result.cv_rmse, 1e-9) << "folds of 300 samples each";
  EXPECT_TRUE(std::isnan(fit("kelvin", Strokes(6000, 0.02, kelvin).series(), {.folds = 0}).cv_std_error));
}

TEST(CrossValidation, FindsTheNumberOfSegmentsByTheSamplesShown) {
  // A line with a knee at 0.3, and what lies beyond 0.25 not shown.
  const Law line = Law::make("piecewise", std::vector{0.0, 0.3, 0.4, 0.0, 1.5, 8.0}, {{"segments", 2.0}});
  const Strokes strokes(6000, 0.01, line);
  const Series series = strokes.series();
  const Samples samples = check_series(std::span(&series, 1), {.folds = 2});
  Weights before = all_of(samples);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (strokes.penetration[i] > 0.25) before[i] = 0.0;
  }
  const FitOptions options{.segments = CountBy::bic};
  const auto segments = [&](const Weights& seen) {
    return std::get<double>(train("piecewise", options, samples, seen).problem.law_options.at("segments"));
  };
  EXPECT_EQ(segments(before), 1.0);
  EXPECT_EQ(segments(all_of(samples)), 2.0);
}

TEST(Segments, OfFewerPointsFitNoWorse) {
  const Law line = Law::make("piecewise", std::vector{0.0, 0.4, 0.0, 2.0}, {{"segments", 1.0}});
  const Strokes few(40, 0.1, line);
  const auto rmse = [&](std::size_t points) {
    return fit("piecewise", few.series(),
               {.law_options = {{"segments", 6.0}}, .folds = 0, .points_per_segment = points})
        .rmse;
  };
  EXPECT_LT(rmse(2), 0.99 * rmse(4));
}

TEST(Intervals, OfWhiteNoiseAreNearlyThoseOfNoiseThatProvesWhite) {
  const Strokes strokes(6000, 0.02, kelvin);
  const auto white = fit("kelvin", strokes.series(), {.folds = 0, .intervals = Intervals::white});
  const auto correlated = fit("kelvin", strokes.series(), {.folds = 0});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(white.parameters[i].std_error, correlated.parameters[i].std_error,
                0.1 * correlated.parameters[i].std_error);
  }
}

// An arm that fades within twenty samples is known too badly for Wald's interval. The data have it: along one
// that they do not have, rounding decides where the least lies.
TEST(Intervals, OfWhiteNoiseAskForNoProfile) {
  const Strokes strokes(2000, 0.1, Law::make("maxwell", std::vector{100.0, 60.0, 30.0, 0.02, 0.4}));
  const FitOptions with{.law_options = {{"arms", 2.0}}, .folds = 0};
  FitOptions without(with);
  without.intervals = Intervals::white;
  const auto is_profile = [](const Estimate& estimate) { return estimate.by == IntervalBy::profile; };
  EXPECT_TRUE(std::ranges::any_of(fit("maxwell", strokes.series(), with).parameters, is_profile));
  EXPECT_TRUE(std::ranges::none_of(fit("maxwell", strokes.series(), without).parameters, is_profile));
}

TEST(Brief, EndsAtTheSameErrorAndNearlyTheSameLaw) {
  const Strokes strokes(4000, 0.05, kelvin);
  for (const char* law : {"kelvin", "maxwell", "exponential", "springpot", "piecewise"}) {
    const auto whole = fit(law, strokes.series(), {.folds = 0});
    const auto brief = fit(law, strokes.series(), {.folds = 0, .brief = true});
    EXPECT_TRUE(brief.converged) << law;
    EXPECT_NEAR(brief.rmse, whole.rmse, 2e-3 * whole.rmse) << law;
    EXPECT_GE(brief.rmse, (1.0 - 1e-9) * whole.rmse) << law;
  }
}

TEST(Rows, ThatDoNotCountAtTheEndChangeNothing) {
  Strokes strokes(3000, 0.05, kelvin);
  const auto before = fit("kelvin", strokes.series(), {.folds = 0});
  std::vector<std::uint8_t> counts(strokes.force.size(), 1);
  for (int i = 0; i < 5000; ++i) {
    strokes.time_s.push_back(strokes.time_s.back() + 1e-3);
    strokes.penetration.push_back(0.01);
    strokes.velocity.push_back(0.0);
    strokes.force.push_back(1.0);
    counts.push_back(0);
  }
  Series series = strokes.series();
  series.counts = counts;
  const auto after = fit("kelvin", series, {.folds = 0});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(after.parameters[i].value, before.parameters[i].value, 1e-9 * before.parameters[i].value);
    EXPECT_NEAR(after.parameters[i].std_error, before.parameters[i].std_error,
                1e-6 * before.parameters[i].std_error);
  }
  EXPECT_EQ(after.samples, before.samples);
}

TEST(CrossValidation, DoesNotDependOnTheNumberOfThreads) {
  const Strokes strokes(6000, 0.02, kelvin);
  const double one = fit("kelvin", strokes.series(), {.threads = 1}).cv_rmse;
  EXPECT_EQ(fit("kelvin", strokes.series(), {.threads = 2}).cv_rmse, one);
  EXPECT_EQ(fit("kelvin", strokes.series(), {.threads = 7}).cv_rmse, one);
}

TEST(Profile, AgreesWithTheIntervalWhereTheLawIsNearlyLinear) {
  const auto result = fit("kelvin", Strokes(6000, 0.02, kelvin).series(), {.folds = 0, .profile = true});
  ASSERT_EQ(result.profiles.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const Estimate& estimate = result.parameters[i];
    const double width = estimate.upper - estimate.lower;
    EXPECT_NEAR(result.profiles[i].lower, estimate.lower, 0.05 * width) << estimate.info.name;
    EXPECT_NEAR(result.profiles[i].upper, estimate.upper, 0.05 * width);
  }
}

TEST(Profile, SaysWhereAParameterHasNoEnd) {
  // A ramp that is sampled every other second: of an arm that relaxes in 0.2 s only the dashpot is felt, and
  // its spring may be as stiff as it likes.
  const Strokes noise(300, 1e-3, Law::make("precontact", std::vector{1e-9, 1e-9}), 5);
  std::vector<double> time, x, v, f;
  Law::State state = kelvin.initial_state();
  for (std::size_t i = 0; i < 300; ++i) {
    time.push_back(2.0 * static_cast<double>(i));
    x.push_back(0.01 * time.back());
    v.push_back(0.01);
    f.push_back(kelvin.step(state, models::Motion{x.back(), 0.01}, 2.0).force + noise.force[i]);
  }
  const auto result =
      fit("kelvin", {.time_s = time, .penetration = x, .velocity = v, .force = f, .cycle = {}},
          {.folds = 0, .profile = true});
  EXPECT_FALSE(result.warnings.empty());
  EXPECT_NEAR(result.parameters[0].value, 5.0, 4.0 * result.parameters[0].std_error);
  EXPECT_GT(result.parameters[1].upper, 100.0) << "no confident number";
  for (const Profile& profile : result.profiles) {
    if (profile.parameter == "series_stiffness") {
      EXPECT_GT(profile.upper, 100.0);
    }
  }
}

TEST(Segments, AreCountedByBicOrTheJnd) {
  const Law broken =
      Law::make("piecewise", std::vector{0.0, 0.1, 0.25, 0.4, 0.0, 1.5, 1.8, 4.0}, {{"segments", 3.0}});
  const Strokes strokes(6000, 0.05, broken);
  const auto by_bic = fit("piecewise", strokes.series(), {.folds = 0, .segments = CountBy::bic});
  EXPECT_EQ(std::get<double>(by_bic.law_options.at("segments")), 3.0);
  const auto by_jnd =
      fit("piecewise", strokes.series(),
          {.jnd = {.weber_fraction = 0.0, .threshold = 0.6}, .folds = 0, .segments = CountBy::jnd});
  EXPECT_EQ(std::get<double>(by_jnd.law_options.at("segments")), 1.0) << "nobody feels more";
}

TEST(Segments, StandWhereTheHandPutsThem) {
  const Law broken =
      Law::make("piecewise", std::vector{0.0, 0.1, 0.25, 0.4, 0.0, 1.5, 1.8, 4.0}, {{"segments", 3.0}});
  const auto result =
      fit("piecewise", Strokes(6000, 0.0, broken).series(), {.folds = 0, .breakpoints = {0.1, 0.25}});
  EXPECT_EQ(result.free_parameters, 4U);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(result.parameters[i].value, broken.values()[i], 1e-5);
}

TEST(Warning, OfASensorAtTheEndOfItsRange) {
  Strokes strokes(4000, 0.0, kelvin);
  for (double& force : strokes.force) force = std::min(force, 2.0);
  EXPECT_THAT(fit("kelvin", strokes.series(), {.folds = 0}).warnings,
              testing::Contains(testing::HasSubstr("may be saturated")));
}

}  // namespace
}  // namespace kerf::fitting
