#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/blade.h>

#include "blade/blade_peaks.h"
#include "blade/blade_phases.h"
#include "fitting/blade/blade_strokes.h"

namespace kerf::fitting {
namespace {

using test::BladeStrokes;
using test::scalpel;
using test::with;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

const std::vector truth{5.0, 2e4, 4e3};

models::Law friction(const models::Options& shape = scalpel, const std::vector<double>& values = truth) {
  return models::Law::make("blade", values, with(shape, "thresholds", false));
}

TEST(BladeFit, FindsFrictionExactlyWhereNothingIsInItsWay) {
  for (const auto* fidelity : {"exact", "strips", "paper"}) {
    const models::Options shape = with(scalpel, "fidelity", std::string(fidelity));
    const BladeFit fit = fit_blade(BladeStrokes(friction(shape), {}).series(), {.law_options = shape});
    ASSERT_EQ(fit.parameters.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(fit.parameters[k].value / truth[k], 1.0, 1e-9) << fidelity;
    EXPECT_THAT(fit.warnings, testing::IsEmpty());
    EXPECT_EQ(fit.parameters[0].info.name, "edge_damping");
  }
}

TEST(BladeFit, GivesTheLawBackThatItWasMadeFrom) {
  const BladeFit fit = fit_blade(BladeStrokes(friction(), {}).series(), {.law_options = scalpel});
  EXPECT_EQ(fit.law().model(), "blade");
  EXPECT_EQ(std::get<std::string>(fit.law().options().at("edge")), "0.005 0 -0.03, 0.005 0 0");
  for (const double error : fit.rmse_rendered) EXPECT_LT(error, 1e-12);
}

TEST(BladeFit, ItsIntervalsHoldTheTruthAboutAsOftenAsTheySay) {
  constexpr int seeds = 40;
  std::array<int, 3> hits{};
  std::array<double, 3> squares{};
  std::array<double, 3> claimed{};
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const BladeStrokes strokes(friction(), {.noise_n = 0.02, .noise_n_m = 2e-4, .seed = seed});
    const BladeFit fit = fit_blade(strokes.series(), {.law_options = scalpel});
    for (std::size_t k = 0; k < 3; ++k) {
      hits[k] += fit.parameters[k].lower <= truth[k] && truth[k] <= fit.parameters[k].upper ? 1 : 0;
      squares[k] += std::pow(fit.parameters[k].value - truth[k], 2) / seeds;
      claimed[k] += fit.parameters[k].std_error / seeds;
    }
  }
  // 38 of 40 are expected; fewer than 34 have a probability of 1 %.
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GE(hits[k], 34) << k;
    EXPECT_NEAR(claimed[k] / std::sqrt(squares[k]), 1.1, 0.4) << k;
  }
}

TEST(BladeFit, WeightsForceAndTorqueByTheirOwnNoise) {
  const BladeStrokes strokes(friction(), {.noise_n = 0.02, .noise_n_m = 2e-4});
  const BladeFit fit = fit_blade(strokes.series(), {.law_options = scalpel});
  for (std::size_t axis = 0; axis < 6; ++axis) {
    EXPECT_NEAR(fit.noise[axis] / (axis < 3 ? 0.02 : 2e-4), 1.0, 0.05);
  }
  // Torques this good say more than forces this bad: equal weights would throw that away.
  const BladeFit equal =
      fit_blade(strokes.series(), {.law_options = scalpel, .noise = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0}});
  EXPECT_GT(equal.parameters[1].std_error, 2.0 * fit.parameters[1].std_error);
}

TEST(BladeFit, OfThePaperMissesTheTorquesOfATurningBlade) {
  // About the long axis, upright, deep in the tissue: there the paper knows no torque at all.
  const BladeStrokes strokes(friction(), {.reach = {0.01, 0.01, 0.005, 0.0, 0.0, 0.5}, .noise_n_m = 2e-6});
  const BladeFit exact = fit_blade(strokes.series(), {.law_options = scalpel});
  const BladeFit paper =
      fit_blade(strokes.series(), {.law_options = with(scalpel, "fidelity", std::string("paper"))});
  EXPECT_NEAR(exact.rmse[5], 2e-6, 1e-7);
  EXPECT_GT(paper.rmse[5], 20.0 * exact.rmse[5]);
}

TEST(BladeFit, WithHubersLossForgivesBlowsToTheSensor) {
  BladeStrokes strokes(friction(), {.noise_n = 0.01, .noise_n_m = 1e-4});
  for (std::size_t i = 0; i < strokes.time_s.size(); i += 40) {
    for (std::size_t axis = 0; axis < 6; ++axis) strokes.force[6 * i + axis] += axis < 3 ? 1.0 : 0.02;
  }
  const BladeFit plain = fit_blade(strokes.series(), {.law_options = scalpel});
  const BladeFit robust = fit_blade(strokes.series(), {.law_options = scalpel, .robust = true});
  EXPECT_LT(std::abs(robust.parameters[1].value - 2e4), 0.5 * std::abs(plain.parameters[1].value - 2e4));
  EXPECT_LT(robust.parameters[1].std_error, 0.7 * plain.parameters[1].std_error);
}

TEST(BladeFit, LeavesOutAnAxisOfInfiniteNoiseWhateverItHas) {
  BladeStrokes strokes(friction(), {});
  for (std::size_t i = 0; i < strokes.time_s.size(); ++i) {
    strokes.force[6 * i + 4] = std::numeric_limits<double>::quiet_NaN();
  }
  BladeFitOptions options{.law_options = scalpel};
  options.noise[4] = std::numeric_limits<double>::infinity();
  const BladeFit fit = fit_blade(strokes.series(), options);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(fit.parameters[k].value / truth[k], 1.0, 1e-9);
}

TEST(BladeFit, KeepsParametersFromGoingBelowZero) {
  const auto no_edge_force = friction(scalpel, {0.0, 2e4, 4e3});
  int at_bound = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const BladeStrokes strokes(no_edge_force, {.noise_n = 0.02, .noise_n_m = 2e-4, .seed = seed});
    const BladeFit fit = fit_blade(strokes.series(), {.law_options = scalpel});
    EXPECT_GE(fit.parameters[0].value, 0.0);
    if (fit.parameters[0].value > 0.0) continue;
    ++at_bound;
    EXPECT_THAT(fit.warnings, Contains(HasSubstr("'edge_damping' lies at its bound of zero")));
  }
  EXPECT_GT(at_bound, 0);
  EXPECT_LT(at_bound, 10);
}

std::vector<std::string> warnings(const models::Options& shape, const std::array<double, 6>& reach) {
  const BladeStrokes strokes(friction(shape), {.reach = reach, .height_m = -0.01, .noise_n = 0.001});
  return fit_blade(strokes.series(), {.law_options = shape}).warnings;
}

TEST(BladeFit, NamesWhatTheMotionCannotTell) {
  EXPECT_THAT(warnings(with(scalpel, "edge", std::string()), {0.02, 0.02, 0.01, 0.2, 0.2, 0.2}),
              Contains("the data do not determine 'edge_damping': the shape has no edge"));
  EXPECT_THAT(
      warnings(scalpel, {0.02, 0.0, 0.01, 0.0, 0.2, 0.0}),
      Contains("the data do not determine 'normal_damping': no surface ever moved along its normal in "
               "the tissue"));
  EXPECT_THAT(
      warnings(scalpel, {0.0, 0.02, 0.0, 0.0, 0.0, 0.0}),
      Contains(HasSubstr("the data do not determine 'tangential_damping': no surface ever moved in its")));
  EXPECT_THAT(warnings(scalpel, {0.02, 0.02, 0.01, 0.2, 0.2, 0.2}), testing::IsEmpty());
}

TEST(BladeFit, NamesWhatItCannotTellApart) {
  // Straight down the middle: an edge along the middle of its surface drags as the surface does.
  const models::Options middle = with(scalpel, "edge", std::string("0 0 -0.03, 0 0 0"));
  const std::array<double, 6> along_z{0.0, 0.0, 0.01, 0.0, 0.0, 0.0};
  const BladeStrokes strokes(friction(middle), {.reach = along_z, .height_m = -0.01});
  const BladeFit fit = fit_blade(strokes.series(), {.law_options = middle});
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("cannot tell 'edge_damping', 'tangential_damping' apart")));
  EXPECT_TRUE(std::isinf(fit.parameters[0].std_error));
  EXPECT_TRUE(std::isnan(fit.correlation(0, 2)));
}

std::string refusal(const BladeStrokes& strokes, const BladeFitOptions& options = {.law_options = scalpel}) {
  try {
    (void)fit_blade(strokes.series(), options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BladeFit, RefusesWhatIsNoSeries) {
  const BladeStrokes good(friction(), {});
  BladeStrokes bad = good;
  bad.force[6 * 17 + 3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(bad), HasSubstr("the force along 'rx' of sample 17 is not finite"));
  bad = good;
  bad.time_s[9] = bad.time_s[8];
  EXPECT_THAT(refusal(bad), HasSubstr("the time does not increase at sample 9"));
  bad = good;
  bad.velocity.pop_back();
  EXPECT_THAT(refusal(bad), HasSubstr("differ in length"));
  EXPECT_THAT(refusal(BladeStrokes(friction(), {.seconds = 0.005})), HasSubstr("only 5 samples"));
  EXPECT_THAT(
      refusal(BladeStrokes(friction(), {.height_m = 0.5})),
      HasSubstr("in the tissue (a corner or an end of its edge under z = 0) in only 0 of 4000 samples"));
  EXPECT_THAT(refusal(good, {.law_options = with(scalpel, "edge", std::string("0 0"))}),
              HasSubstr("is not a point"));
  EXPECT_THAT(refusal(good, {.law_options = with(scalpel, "sharpness", 3.0)}), HasSubstr("'sharpness'"));
}

TEST(BladeFit, SaysThatNoForceWasMeasured) {
  BladeStrokes strokes(friction(), {});
  std::fill(strokes.force.begin(), strokes.force.end(), 0.0);
  EXPECT_THAT(fit_blade(strokes.series(), {.law_options = scalpel}).warnings,
              Contains("the force is zero throughout"));
}

const std::vector cut_truth{5.0, 2e4, 4e3, 500.0, 1e6, 6e5, 0.1, 0.3};

models::Law cutting(const std::vector<double>& values = cut_truth) {
  return models::Law::make("blade", values, with(scalpel, "form", std::string("paper")));
}

TEST(BladeJumps, AreWhereTheForceJumpsAndNotBesideIt) {
  constexpr std::size_t count = 400;
  constexpr std::size_t jump = 170;
  BladeRows rows{
      .pose = std::vector<models::Pose>(count), .in_tissue = std::vector(count, true), .period_s = 1e-3};
  for (std::size_t row = 0; row < count; ++row) {
    rows.time_s.push_back(1e-3 * static_cast<double>(row));
    rows.force.emplace_back(Vector6d::Unit(0) * (row < jump ? 3.0 : 1.0));
  }
  // So low a prominence that the rows beside it count as well.
  const std::vector<Jump> jumps = find_jumps(rows, Vector6d::Constant(0.1), {.peaks = {.prominence = 2.0}});
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_EQ(jumps[0].row, jump);
  EXPECT_NEAR(jumps[0].before[0], 3.0, 1e-9);
  EXPECT_NEAR(jumps[0].after[0], 1.0, 1e-9);
}

TEST(BladeThresholds, AreFoundFromThePeaksOfTheForce) {
  const BladeStrokes strokes(cutting(), {.seconds = 20.0, .noise_n = 0.005, .noise_n_m = 5e-5});
  const BladeFit fit = fit_blade(strokes.series(), {.law_options = scalpel, .thresholds = true});
  EXPECT_EQ(fit.law().options().at("form"), models::OptionValue(std::string("paper"))) << "as it was fitted";
  ASSERT_EQ(fit.parameters.size(), 8U);
  for (std::size_t k = 0; k < 8; ++k) {
    const Estimate& estimate = fit.parameters[k];
    EXPECT_NEAR(estimate.value / cut_truth[k], 1.0, k == 3 ? 0.1 : 0.03) << estimate.info.name;
    EXPECT_NEAR(estimate.value, cut_truth[k], 5.0 * estimate.std_error) << estimate.info.name;
  }
  EXPECT_GE(fit.phases.iterations, 1U);
  EXPECT_GT(fit.phases.ruptures.force_n.size(), 30U);
  EXPECT_GT(fit.phases.releases.force_n.size(), 20U);
  EXPECT_TRUE(fit.phases.settled);
  EXPECT_GT(fit.phases.agreement, 0.98);
  EXPECT_NEAR(fit.rmse[1] / 0.005, 1.0, 0.05);
  EXPECT_THAT(fit.warnings, testing::IsEmpty());
}

TEST(BladeThresholds, LeaveNothingThatTheElasticFieldExplainsEvenWhereTheAnchorIsOutOfReach) {
  // A sensor that lags by 4 ms: the tissue seems to hold from later on than an anchor may be shifted.
  constexpr std::size_t lag = 6 * 4;
  BladeStrokes strokes(cutting(), {});
  std::copy_backward(strokes.force.begin(), strokes.force.end() - lag, strokes.force.end());
  const BladeFitOptions options{
      .law_options = scalpel, .thresholds = true, .noise = {0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4}};
  const Vector6d weight = Eigen::Map<const Vector6d>(options.noise.data()).cwiseAbs2().cwiseInverse();
  const BladeRows rows = rows_of(strokes.series(), options);
  const PhaseFit fit = fit_phases(rows, options);
  ASSERT_TRUE(fit.settled);
  double common = 0.0;
  double explained = 0.0;
  int at_the_end = 0;
  for (const BladePhase& phase : fit.phases) {
    if (!phase.elastic) continue;
    at_the_end += std::abs(phase.shift) >= 1.5 ? 1 : 0;
    for (std::size_t i = first_fitted_row(phase); i < phase.end; ++i) {
      const Vector6d field = rows.force[i] - fit.residuals[i];
      common += field.dot(weight.cwiseProduct(fit.residuals[i]));
      explained += field.dot(weight.cwiseProduct(field));
    }
  }
  EXPECT_GE(at_the_end, 1);
  EXPECT_NEAR(common / explained, 0.0, 1e-5);
}

TEST(BladeThresholds, HoldATissueThatNeverTearsElastically) {
  std::vector strong = cut_truth;
  strong[7] = 100.0;
  const BladeStrokes strokes(cutting(strong), {.noise_n = 0.005, .noise_n_m = 5e-5});
  const BladeFit fit = fit_blade(strokes.series(), {.law_options = scalpel, .thresholds = true});
  EXPECT_EQ(fit.phases.cutting_rows, 0U);
  EXPECT_TRUE(std::isinf(fit.parameters[0].std_error));
  EXPECT_TRUE(std::isinf(fit.parameters[7].upper));
  EXPECT_NEAR(fit.parameters[4].value / 1e6, 1.0, 0.01);
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("'rupture_force': no rupture found")));
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("'release_force': no release found")));
  EXPECT_NO_THROW((void)fit.law());
}

TEST(BladeThresholds, AreFoundByABladeThatLeavesTheTissueAndComesBack) {
  const BladeStrokes strokes(cutting(),
                             {.seconds = 20.0, .height_m = 0.022, .noise_n = 0.003, .noise_n_m = 3e-5});
  const BladeFit fit = fit_blade(strokes.series(), {.law_options = scalpel, .thresholds = true});
  EXPECT_LT(fit.rows_in_tissue, fit.rows);
  EXPECT_NEAR(fit.parameters[1].value / 2e4, 1.0, 0.02);
  EXPECT_NEAR(fit.parameters[4].value / 1e6, 1.0, 0.02);
  EXPECT_NEAR(fit.parameters[6].value / 0.1, 1.0, 0.05);
  EXPECT_NEAR(fit.parameters[7].value / 0.3, 1.0, 0.02);
}

TEST(BladeThresholds, AreFoundWhereReleasesAreTooSmallToBeSeenAsJumps) {
  std::vector faint = cut_truth;
  faint[1] = 1e4;
  faint[6] = 0.02;
  // To and fro across the blade: at each end the force falls below F0, itself no more than the noise.
  const BladeStrokes strokes(
      cutting(faint),
      {.seconds = 20.0, .reach = {0.0, 0.02, 0.0, 0.0, 0.0, 0.0}, .noise_n = 0.02, .noise_n_m = 2e-4});
  const BladeFit fit = fit_blade(strokes.series(), {.law_options = scalpel, .thresholds = true});
  EXPECT_GE(fit.phases.releases.force_n.size(), 35U);
  EXPECT_NEAR(fit.parameters[6].value, 0.02, 0.01);
  EXPECT_NEAR(fit.parameters[7].value / 0.3, 1.0, 0.03);
}

TEST(BladeThresholds, TakeASteadyCutForWhatItIs) {
  const BladeStrokes strokes(friction(), {.noise_n = 0.005, .noise_n_m = 5e-5});
  const BladeFit fit = fit_blade(strokes.series(), {.law_options = scalpel, .thresholds = true});
  EXPECT_EQ(fit.phases.elastic_rows, 0U);
  EXPECT_NEAR(fit.parameters[1].value / 2e4, 1.0, 0.01);
  EXPECT_TRUE(std::isinf(fit.parameters[4].upper));
}

TEST(BladeThresholds, NeedEveryForce) {
  BladeFitOptions options{.law_options = scalpel, .thresholds = true};
  options.noise[1] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(BladeStrokes(cutting(), {}), options), HasSubstr("a force is missing"));
}

}  // namespace
}  // namespace kerf::fitting
