#include <cmath>
#include <tuple>
#include <vector>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <kerf/models/registry.h>

#include "support/example_laws.h"

namespace kerf::models {
namespace {

constexpr int most = 10;
using Jet = ceres::Jet<double, most>;

/// The force after some ticks of a stroke, of a law on any scalar.
template <template <typename> typename L, typename T>
T force_after(const std::vector<T>& values, const Options& options) {
  const auto law = L<T>::make(values, options);
  typename L<T>::State state;
  T force(0.0);
  for (int tick = 0; tick <= 300; ++tick) {
    const double phase = 4e-3 * tick;
    force = law.step(state, {.penetration = 0.2 * (1.0 - std::cos(phase)), .velocity = 0.8 * std::sin(phase)},
                     1e-3);
  }
  return force;
}

/// The dual numbers of a fit against central differences of the rendered law.
template <template <typename> typename L>
void expect_exact_derivatives(const std::vector<double>& values, const Options& options = {}) {
  std::vector<Jet> jets;
  for (std::size_t i = 0; i < values.size(); ++i) jets.emplace_back(values[i], static_cast<int>(i));
  const Jet force = force_after<L, Jet>(jets, options);
  EXPECT_NEAR(force.a, (force_after<L, double>(values, options)), 1e-14);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double step = 1e-6 * std::max(std::abs(values[i]), 0.1);
    auto above = values;
    auto below = values;
    above[i] += step;
    below[i] -= step;
    const double slope =
        (force_after<L, double>(above, options) - force_after<L, double>(below, options)) / (2.0 * step);
    EXPECT_NEAR(force.v[static_cast<int>(i)], slope, 1e-6 * std::max(1.0, std::abs(slope)))
        << "parameter " << i;
  }
}

template <template <typename> typename L>
void expect_of_example(const L<double>*) {
  if constexpr (L<double>::facts.search == Search::descent) {
    SCOPED_TRACE(L<double>::name);
    const Law example = test::example(L<double>::name);
    expect_exact_derivatives<L>(example.values(), example.options());
  }
}
void expect_of_example(const void*) {}  // of several axes: not fitted so

template <typename... L>
void expect_of_all(const std::tuple<L...>*) {
  (expect_of_example(static_cast<const L*>(nullptr)), ...);
}

TEST(Derivatives, OfEveryLawThatASearchDescends) { expect_of_all(static_cast<const Registry*>(nullptr)); }
TEST(Derivatives, OfKelvin) { expect_exact_derivatives<Kelvin>({5.0, 8.0, 1.6}); }
TEST(Derivatives, OfKelvinByEuler) {
  expect_exact_derivatives<Kelvin>({5.0, 8.0, 1.6}, {{"integrator", std::string("euler")}});
}
TEST(Derivatives, OfExponential) { expect_exact_derivatives<Exponential>({0.2, 0.5, 0.3}); }
TEST(Derivatives, OfExponentialWithAnOffset) {
  expect_exact_derivatives<Exponential>({0.2, 0.5, 0.3, -0.4}, {{"offset", true}});
  expect_exact_derivatives<Exponential>({0.2, 0.5, -0.4}, {{"viscous", false}, {"offset", true}});
}
TEST(Derivatives, OfMaxwell) {
  expect_exact_derivatives<Maxwell>({2.0, 1.0, 3.0, 0.05, 0.4});
  expect_exact_derivatives<Maxwell>({2.0, 1.0, 0.5}, {{"arms", 1.0}});
}
TEST(Derivatives, OfSpringpot) {
  for (const double order : {0.02, 0.3, 0.6, 0.97}) {
    expect_exact_derivatives<Springpot>({2.0, 1.0, order}, {{"reference_time", 0.2}});
    expect_exact_derivatives<Springpot>({1.0, order}, {{"spring", false}});
  }
}
TEST(Derivatives, OfHuntCrossley) {
  expect_exact_derivatives<HuntCrossley>({0.2, 0.1, 1.4}, {{"reference_depth", 0.1}});
}
TEST(Derivatives, OfFriction) { expect_exact_derivatives<Friction>({-0.1, 2.0, 0.3, 0.8, 0.1}); }
TEST(Derivatives, OfPiecewise) {
  expect_exact_derivatives<Piecewise>({0.0, 0.15, 0.4, 0.2, 2.0, 2.5, -0.1, 0.5, 2.0},
                                      {{"segments", 2.0}, {"loop", true}, {"reversal_scale", 2.0}});
}
TEST(Derivatives, OfRecording) {
  expect_exact_derivatives<Recording>({0.2, 2.0, 2.5, -0.1, 0.5, 2.0},
                                      {{"points", 3.0}, {"last", 0.4}, {"loop", true}});
}

TEST(Derivatives, OfPrecontact) { expect_exact_derivatives<Precontact>({30.0, 0.05}); }
TEST(Derivatives, OfAnalyticalScissors) { expect_exact_derivatives<ScissorsAnalytic>({0.003, 0.4, 6.0}); }
TEST(Derivatives, OfFractureWhileItDeforms) {
  expect_exact_derivatives<Fracture>({0.02, 0.5, 10.0, 2000.0, 0.001});
}
TEST(Derivatives, OfFuzzyRuptureAndWhatItBreaks) {
  const Options one{{"memberships", 1.0}, {"most_depth", 1.0}, {"most_speed", 1.0}};
  expect_exact_derivatives<FuzzyRupture>({0.1, 0.5, 0.2, 0.5, 8.0, 2.0, 0.1}, one);
  expect_exact_derivatives<FuzzyKelvin>({5.0, 8.0, 1.6, 0.1, 0.5, 0.2, 0.5, 8.0, 2.0, 50.0}, one);
}

}  // namespace
}  // namespace kerf::models
