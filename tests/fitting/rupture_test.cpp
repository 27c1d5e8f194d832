#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/rupture.h>

namespace kerf::fitting {
namespace {

using testing::HasSubstr;

/// Samples of a formula on a grid of 1 to 10 mm and 0.5 to 10 mm/s.
template <typename F>
RuptureSamples on_grid(F&& force) {
  RuptureSamples samples;
  for (int depth = 1; depth <= 10; ++depth) {
    for (const double speed : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0}) {
      samples.depth_m.push_back(1e-3 * depth);
      samples.speed_m_per_s.push_back(1e-3 * speed);
      samples.force_n.push_back(force(1e-3 * depth, 1e-3 * speed));
    }
  }
  return samples;
}
double liver(double d, double s) {
  return 0.05 * std::pow(d / 5e-3, 1.2) * (0.6 + 0.4 * std::sqrt(s / 2e-3));
}
double at(const models::Law& law, double d, double s) {
  auto state = law.initial_state();
  return law.step(state, models::Motion{d, s}, 1e-3).force;
}

TEST(TrainRupture, FollowsItsSamplesToATenthOfAPercent) {
  const auto fit = train_rupture(on_grid(liver));
  EXPECT_TRUE(fit.converged);
  EXPECT_LT(fit.rmse_n, 1e-4);
  EXPECT_LT(fit.max_abs_n, 2e-4) << "of forces up to 0.17 N";
}

TEST(TrainRupture, RisesWithDepthAndNonlinearlyWithSpeedAndNeverPulls) {
  const models::Law law = train_rupture(on_grid(liver)).law;
  for (int i = 0; i <= 60; ++i) {
    for (int j = 0; j <= 60; ++j) {
      const double d = 1e-3 + 9e-3 * i / 60;
      const double s = 0.5e-3 + 9.5e-3 * j / 60;
      const double force = at(law, d, s);
      ASSERT_GE(force, 0.0);
      ASSERT_NEAR(force, liver(d, s), 1e-3) << "between the samples too";
      if (i > 0) {
        ASSERT_GT(force, at(law, d - 9e-3 / 60, s)) << d << ' ' << s;
      }
      if (j > 0) {
        ASSERT_GT(force, at(law, d, s - 9.5e-3 / 60)) << d << ' ' << s;
      }
    }
  }
  const double early = at(law, 5e-3, 2e-3) - at(law, 5e-3, 1e-3);
  const double late = at(law, 5e-3, 10e-3) - at(law, 5e-3, 9e-3);
  EXPECT_GT(early, 1.5 * late) << "a square root bends";
}

TEST(TrainRupture, AssumesNoSignOfTheSpeed) {
  const auto needle = [](double d, double s) { return 5.0 * d * (1.5 - 0.8 * std::sqrt(s / 10e-3)); };
  const models::Law law = train_rupture(on_grid(needle)).law;
  EXPECT_NEAR(at(law, 4.5e-3, 7e-3), needle(4.5e-3, 7e-3), 1e-3);
  EXPECT_LT(at(law, 5e-3, 9e-3), at(law, 5e-3, 1e-3));
}

TEST(TrainRupture, ProjectionEndsLowerThanPlainBackPropagation) {
  const auto samples = on_grid(liver);
  const auto projected = train_rupture(samples);
  const auto descended = train_rupture(samples, {.learning = Learning::back_propagation});
  EXPECT_LT(projected.rmse_n, 0.5 * descended.rmse_n);
  EXPECT_LT(100 * projected.iterations, descended.iterations);
  EXPECT_LT(descended.rmse_n, 1e-3) << "which learns too, given time";
}

TEST(TrainRupture, OneMembershipIsAPlane) {
  // Whatever its width, so that the projection alone finds it.
  const auto plane = [](double d, double s) { return 3.0 * d + 2.0 * s + 0.01; };
  const auto fit = train_rupture(on_grid(plane), {.memberships = 1});
  EXPECT_LT(fit.max_abs_n, 1e-8);
}

std::string refusal(const RuptureSamples& samples, const RuptureOptions& options = {}) {
  try {
    (void)train_rupture(samples, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TrainRupture, RefusesSamplesThatCannotTell) {
  auto samples = on_grid(liver);
  RuptureSamples few = samples;
  for (auto* values : {&few.depth_m, &few.speed_m_per_s, &few.force_n}) values->resize(30);
  EXPECT_THAT(refusal(few), HasSubstr("only 30 samples for the 39"));
  samples.speed_m_per_s.assign(100, 1e-3);
  EXPECT_THAT(refusal(samples), HasSubstr("same speed"));
  samples = on_grid(liver);
  samples.force_n[7] = std::nan("");
  EXPECT_THAT(refusal(samples), HasSubstr("not a finite number"));
  samples = on_grid(liver);
  samples.depth_m[3] = -1e-3;
  EXPECT_THAT(refusal(samples), HasSubstr("negative"));
}

}  // namespace
}  // namespace kerf::fitting
