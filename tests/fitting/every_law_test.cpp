#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/fit.h>

#include "fitting/strokes.h"
#include "support/example_laws.h"

namespace kerf::fitting {
namespace {

using models::Law;
using models::Options;
using test::Strokes;

struct Case {
  std::string model;
  std::vector<double> values;
  models::Options options;
  double relative = 1e-6;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.model; }

class EveryLaw : public testing::TestWithParam<Case> {};

TEST_P(EveryLaw, IsFoundAgainWithoutNoise) {
  const auto& [model, values, options, relative] = GetParam();
  const Law law = Law::make(model, values, options);
  const auto result = fit(model, Strokes(6000, 0.0, law).series(), {.law_options = options, .folds = 0});
  ASSERT_EQ(result.parameters.size(), values.size()) << testing::PrintToString(result.warnings);
  EXPECT_TRUE(result.converged) << result.message;
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(result.parameters[i].value, values[i], relative * std::max(std::abs(values[i]), 1e-2))
        << result.parameters[i].info.name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Fit, EveryLaw,
    testing::Values(Case{"kelvin", {5.0, 8.0, 1.6}, {}}, Case{"exponential", {0.2, 0.5, 0.3}, {}},
                    Case{"exponential", {0.2, 0.5, -0.1, 0.4}, {{"offset", true}}},
                    Case{"exponential", {0.2, 0.5}, {{"viscous", false}}},
                    Case{"precontact", {300.0, 0.05}, {}},
                    Case{"scissors_analytic", {0.003, 0.4, 6.0}, {{"contact_angle", 0.5}}},
                    Case{"maxwell", {5.0, 8.0, 12.0, 0.05, 0.8}, {{"arms", 2.0}}, 1e-5},
                    Case{"springpot", {3.0, 2.0, 0.3}, {}, 1e-5},
                    Case{"friction", {0.3, 4.0, -0.2, 0.5, 0.01}, {}},
                    Case{"hunt_crossley", {2.0, -0.4, 1.5}, {{"reference_depth", 0.4}}}),
    [](const auto& one) { return one.param.model + std::to_string(one.index); });

/// Those that break are found from one push, below.
std::vector<std::string_view> laws_that_never_break() {
  std::vector<std::string_view> laws = fitted_laws();
  std::erase_if(laws, [](std::string_view law) {
    const models::Search search = models::law_facts(law).search;
    return search == models::Search::fracture || search == models::Search::ruptures;
  });
  return laws;
}

class Registered : public testing::TestWithParam<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(Fit, Registered, testing::ValuesIn(laws_that_never_break()),
                         [](const auto& name) { return std::string(name.param); });

/// The example of a law without what softens its turns in the hand, which a fit does not have.
Law without_aids(std::string_view model) {
  const Law law = test::example(model);
  Options options = law.options();
  for (const auto* aid : {"velocity_corner", "ramp_band", "reversal_scale"}) options.erase(aid);
  return Law::make(model, law.values(), options);
}

TEST_P(Registered, LawExplainsItsOwnForce) {
  const Law law = without_aids(GetParam());
  const Strokes strokes(6000, 0.0, law);
  const auto result = fit(GetParam(), strokes.series(true), {.law_options = law.options(), .folds = 0});
  EXPECT_GT(result.r2, 0.998) << result.message;
}

/// A steady push into tissue at 2 mm/s, sampled at 1 kHz.
struct Push {
  std::vector<double> time_s, penetration, velocity, force;
  Push(const Law& law, double depth_m) {
    Law::State state = law.initial_state();
    for (int i = 0; 2e-6 * i < depth_m; ++i) {
      time_s.push_back(1e-3 * i);
      penetration.push_back(2e-6 * i);
      velocity.push_back(2e-3);
      force.push_back(law.step(state, models::Motion{penetration.back(), 2e-3}, 1e-3).force);
    }
  }
  [[nodiscard]] Series series() const {
    return {.time_s = time_s, .penetration = penetration, .velocity = velocity, .force = force, .cycle = {}};
  }
};

TEST(Fracture, IsFoundByTheDepthWhereTheTissueYields) {
  // alpha L0 / beta expm1(beta d / L0) = Uy at d = 6 mm; cutting then takes Jc w = 1.5 N.
  const double energy = 0.05 * 0.1 / 40.0 * std::expm1(40.0 * 0.006 / 0.1);
  const Law law = Law::make("fracture", std::vector{0.05, 40.0, energy, 150.0, 0.01});
  const auto result = fit("fracture", Push(law, 0.012).series(), {.folds = 0});
  ASSERT_EQ(result.parameters.size(), 5U);
  EXPECT_NEAR(result.parameters[0].value, 0.05, 1e-4);
  EXPECT_NEAR(result.parameters[1].value, 40.0, 0.05);
  EXPECT_NEAR(result.parameters[2].value, energy, 0.01 * energy);
  EXPECT_NEAR(result.parameters[3].value, 150.0, 1.0);
  EXPECT_THAT(result.warnings, testing::Contains(testing::HasSubstr("'width' is held")));
}

TEST(Fracture, CutsWithTheForceOfTheRowsThatAreCutHoweverSoonThePushEnds) {
  const double energy = 0.05 * 0.1 / 40.0 * std::expm1(40.0 * 0.006 / 0.1);
  const Push push(Law::make("fracture", std::vector{0.05, 40.0, energy, 150.0, 0.01}), 0.0062);
  const auto result = fit("fracture", push.series(), {.folds = 0});
  ASSERT_EQ(result.parameters.size(), 5U);
  const auto value = [&](std::size_t parameter) { return result.parameters[parameter].value; };
  EXPECT_NEAR(value(3) * value(4), 1.5, 1e-6) << "not less for the tick of the fracture, whose force is none";
}

/// Tissue that yields between two of its few rows, and a tool that is free behind.
struct YieldsOnce {
  std::vector<double> time_s, penetration, velocity, force;
  explicit YieldsOnce(double behind_n = 0.0) {
    constexpr double depth_m = 0.284e-3;
    const double energy = 0.17655 * 0.1 / 125.0 * std::expm1(125.0 * depth_m / 0.1);
    const Law law = Law::make("fracture", std::vector{0.17655, 125.0, energy, 3.0, 0.01});
    Law::State state = law.initial_state();
    for (int i = 0; i < 700; ++i) {
      const models::Motion motion{0.84e-6 * i, 0.84e-4};
      time_s.push_back(0.01 * i);
      penetration.push_back(motion.penetration);
      velocity.push_back(motion.velocity);
      force.push_back(law.step(state, motion, 0.01).force + (motion.penetration > depth_m ? behind_n : 0.0));
    }
  }
  [[nodiscard]] FitResult fitted() const {
    return fit(
        "fracture",
        {.time_s = time_s, .penetration = penetration, .velocity = velocity, .force = force, .cycle = {}},
        {.folds = 0});
  }
};

// A grid of depths passes over what lies between two rows; the largest fall of the force does not.
TEST(Fracture, IsFoundWhereTheTissueYieldsBetweenTwoRows) { EXPECT_LT(YieldsOnce().fitted().rmse, 1e-4); }

// No tissue cuts with a force that pulls: starts that claimed to had left no place for any that does not.
TEST(Fracture, IsFoundWhereTheSensorPullsBehindIt) {
  const YieldsOnce yields(-0.03);
  const double behind =
      static_cast<double>(std::ranges::count_if(yields.penetration, [](double x) { return x > 0.284e-3; }));
  const double truth = 0.03 * std::sqrt(behind / static_cast<double>(yields.force.size()));
  EXPECT_LT(yields.fitted().rmse, 1.01 * truth);
}

TEST(FuzzyKelvin, IsFoundFromItsRuptures) {
  const std::vector<double> values{80.0, 70.0, 35.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.2};
  const models::Options options{{"memberships", 1.0}, {"most_depth", 1.0}, {"most_speed", 1.0}};
  const Law law = Law::make("fuzzy_kelvin", values, options);
  const auto result = fit("fuzzy_kelvin", Push(law, 0.03).series(), {.folds = 0});
  ASSERT_EQ(result.parameters.size(), values.size()) << result.message;
  EXPECT_NEAR(result.parameters[0].value + result.parameters[1].value, 150.0, 5.0);
  EXPECT_NEAR(result.parameters.back().value, 0.2, 2e-3) << "the force at which tissue breaks";
}

TEST(FuzzyKelvin, IsNotFoundWhereNothingBreaks) {
  const Law kelvin = Law::make("kelvin", std::vector{5.0, 8.0, 1.6});
  const auto result = fit("fuzzy_kelvin", Strokes(4000, 0.0, kelvin).series());
  EXPECT_FALSE(result.converged);
  EXPECT_THAT(result.message, testing::HasSubstr("never drops"));
}

TEST(FuzzyRupture, FollowsASurfaceOverDepthAndSpeed) {
  const Law spring = Law::make("exponential", std::vector{0.2, 0.5, 0.3});
  const auto result = fit("fuzzy_rupture", Strokes(4000, 0.0, spring).series(), {.folds = 0});
  ASSERT_FALSE(result.parameters.empty()) << result.message;
  EXPECT_LT(result.rmse, 0.3) << "it sees the speed but not its sign: 0.24 N of viscosity either way";
}

TEST(Maxwell, TakesAsManyArmsAsHeldOutStrokesPayFor) {
  const Law one = Law::make("maxwell", std::vector{5.0, 8.0, 0.2}, {{"arms", 1.0}});
  const Law two = Law::make("maxwell", std::vector{5.0, 8.0, 12.0, 0.03, 0.8}, {{"arms", 2.0}});
  const auto arms = [](const FitResult& result) { return std::get<double>(result.law_options.at("arms")); };
  EXPECT_EQ(arms(fit("maxwell", Strokes(8000, 0.02, one).series(true))), 1.0);
  EXPECT_EQ(arms(fit("maxwell", Strokes(8000, 0.02, two).series(true))), 2.0);
}

TEST(Maxwell, IsTheSameAtAnySamplingRate) {
  // A ramp and a hold are linear between samples at 10 Hz as at 1 kHz, so that both give one answer.
  const Law law = Law::make("maxwell", std::vector{5.0, 8.0, 12.0, 0.3, 3.0}, {{"arms", 2.0}});
  for (const double rate_hz : {10.0, 1000.0}) {
    std::vector<double> time, x, v, f;
    Law::State state = law.initial_state();
    for (int i = 0; i <= static_cast<int>(12.0 * rate_hz); ++i) {
      time.push_back(i / rate_hz);
      x.push_back(std::min(0.2 * time.back(), 0.2));
      v.push_back(time.back() < 1.0 ? 0.2 : 0.0);
      f.push_back(law.step(state, models::Motion{x.back(), v.back()}, 1.0 / rate_hz).force);
    }
    const auto result =
        fit("maxwell", {.time_s = time, .penetration = x, .velocity = v, .force = f, .cycle = {}},
            {.law_options = {{"arms", 2.0}}, .folds = 0});
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(result.parameters[i].value, law.values()[i], 1e-6 * law.values()[i])
          << rate_hz << " Hz, " << i;
    }
  }
}

}  // namespace
}  // namespace kerf::fitting
