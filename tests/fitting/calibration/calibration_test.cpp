#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/calibration/calibration.h>

#include "fitting/calibration/calibration_oracle.h"
#include "fitting/calibration/simulated_holds.h"

namespace kerf::fitting::calibration {
namespace {

using testing::HasSubstr;

/// What calibration_oracle.py has made of a case.
struct Oracle {
  std::size_t components;
  std::size_t signals;
  const std::vector<double>& loads;
  const std::vector<double>& values;
  const std::vector<double>& times;
  const std::vector<double>& load_error;
};

Holds holds_of(const Oracle& oracle) {
  Holds holds;
  for (std::size_t k = 0; k < oracle.components; ++k) holds.components.push_back("f" + std::to_string(k));
  for (std::size_t i = 0; i < oracle.signals; ++i) holds.signals.push_back("u" + std::to_string(i));
  for (std::size_t h = 0; h < oracle.times.size(); ++h) {
    Hold hold{.load = {}, .signal = {}, .time_s = oracle.times[h], .load_number = h, .row = h + 1};
    for (std::size_t k = 0; k < oracle.components; ++k)
      hold.load.push_back(oracle.loads[h * oracle.components + k]);
    for (std::size_t i = 0; i < oracle.signals; ++i)
      hold.signal.push_back(oracle.values[h * oracle.signals + i]);
    holds.holds.push_back(hold);
  }
  const auto rows = static_cast<Eigen::Index>(oracle.loads.size());
  const Eigen::Index sources = static_cast<Eigen::Index>(oracle.load_error.size()) / rows;
  holds.load_error.resize(rows, sources);
  for (Eigen::Index r = 0; r < rows; ++r) {
    for (Eigen::Index c = 0; c < sources; ++c)
      holds.load_error(r, c) = oracle.load_error[static_cast<std::size_t>(r * sources + c)];
  }
  return holds;
}

/// Every number of `found`, row by row, within a share of those of the oracle.
void expect_all(const Eigen::MatrixXd& found, const std::vector<double>& expected, double share) {
  ASSERT_EQ(static_cast<std::size_t>(found.size()), expected.size());
  for (Eigen::Index r = 0; r < found.rows(); ++r) {
    for (Eigen::Index c = 0; c < found.cols(); ++c) {
      const double one = expected[static_cast<std::size_t>(r * found.cols() + c)];
      EXPECT_NEAR(found(r, c), one, share * std::abs(one)) << r << ", " << c;
    }
  }
}

TEST(Calibration, IsThatOfNumPyWithWeightsThatAreNotKnownExactly) {
  namespace is = oracle::square;
  const auto found =
      calibrate(holds_of({is::components, is::signals, is::loads, is::values, is::times, is::load_error}),
                {.hysteresis = false});
  expect_all(found.matrix, is::matrix, 1e-6);
  expect_all(found.matrix_half_width, is::matrix_half, 1e-4);
  expect_all(found.bias, is::bias, 1e-6);
  expect_all(found.bias_half_width, is::bias_half, 1e-4);
  for (std::size_t i = 0; i < is::signals; ++i) {
    EXPECT_NEAR(found.signals[i].repeatability, is::sigma[i], 1e-4 * is::sigma[i]);
    EXPECT_NEAR(found.signals[i].degrees_of_freedom, is::free[i], 1e-3 * is::free[i]);
    EXPECT_NEAR(found.signals[i].drift_per_s->value, is::drift[i], 1e-5 * std::abs(is::drift[i]));
    EXPECT_NEAR(found.signals[i].drift_per_s->half_width, is::drift_half[i], 1e-4 * is::drift_half[i]);
  }
}

TEST(Calibration, IsThatOfNumPyWithMoreSignalsThanComponents) {
  namespace is = oracle::wide;
  const auto found =
      calibrate(holds_of({is::components, is::signals, is::loads, is::values, is::times, is::load_error}),
                {.hysteresis = false});
  expect_all(found.matrix, is::matrix, 1e-5);
  expect_all(found.matrix_half_width, is::matrix_half, 1e-4);
  EXPECT_NEAR(found.signals[0].degrees_of_freedom, 16 - 4, 1e-9);
}

TEST(Calibration, TakesASensorWithoutNoiseAsItIs) {
  Simulated truth;
  truth.noise = truth.weight_share = 0.0;
  const SimulatedHolds made = simulate(truth, 1);
  const auto found = calibrate(made.holds);
  EXPECT_TRUE(found.matrix.isApprox(made.matrix, 1e-9));
  EXPECT_TRUE(found.bias.isApprox(made.bias_at_end, 1e-9));
  for (std::size_t i = 0; i < found.signals.size(); ++i) {
    EXPECT_NEAR(found.signals[i].drift_per_s->value, made.drift_per_s(static_cast<Eigen::Index>(i)), 1e-12);
    EXPECT_NEAR(found.signals[i].hysteresis_width->value, made.hysteresis(static_cast<Eigen::Index>(i)),
                1e-6 * made.hysteresis(static_cast<Eigen::Index>(i)));
    EXPECT_NEAR(found.signals[i].per_kelvin->value, made.per_kelvin(static_cast<Eigen::Index>(i)), 1e-9);
  }
}

// A small version of `scripts/benchmark calibrate`: 60 sensors of 36 elements each. The elements of one
// sensor share errors, so that the share is held to what 120 independent ones would allow at 99.9 %.
TEST(Calibration, HoldsTheTruthInItsIntervals) {
  constexpr std::uint64_t sensors = 60;
  double held = 0.0;
  double all = 0.0;
  for (std::uint64_t seed = 1; seed <= sensors; ++seed) {
    const SimulatedHolds made = simulate(Simulated{}, seed);
    const auto found = calibrate(made.holds);
    const Eigen::ArrayXXd error = (found.matrix - made.matrix).cwiseAbs();
    held += static_cast<double>((error <= found.matrix_half_width.array()).count());
    all += static_cast<double>(error.size());
  }
  EXPECT_GT(held / all, 0.91);
  EXPECT_LT(held / all, 0.98);
}

TEST(Calibration, LeavesOutALoadAsAFitWithoutItDoes) {
  const SimulatedHolds made = simulate(Simulated{.hysteresis_share = 0.0}, 3);
  const Options plain{.hysteresis = false};
  Holds exact = made.holds;
  exact.load_error.resize(exact.load_error.rows(), 0);
  const auto all = calibrate(exact, plain);
  Holds without = exact;
  const std::size_t last = 20;
  const std::size_t load = without.holds[last].load_number;
  std::erase_if(without.holds, [&](const Hold& hold) { return hold.load_number == load; });
  const auto other = calibrate(without, plain);
  // Told by the other calibration, in signals: what it predicts for that hold.
  const Hold& hold = exact.holds[last];
  const double t_end = without.holds.back().time_s;
  const double mean = *other.temperature;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double predicted =
        other.sensitivity.row(i).dot(Eigen::Map<const Eigen::VectorXd>(hold.load.data(), 6)) + other.bias(i) +
        other.signals[at].drift_per_s->value * (hold.time_s - t_end) +
        other.signals[at].per_kelvin->value * (hold.temperature - mean);
    const double told = (all.sensitivity * all.left_out.row(static_cast<Eigen::Index>(last)).transpose())(i);
    EXPECT_NEAR(told, hold.signal[at] - predicted, 1e-9);
  }
}

std::string refusal(const Holds& holds) {
  try {
    (void)calibrate(holds);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

TEST(Calibration, NamesTheLoadThatIsMissing) {
  Holds holds = simulate(Simulated{}, 1).holds;
  for (Hold& hold : holds.holds) hold.load[1] = 0.0;
  EXPECT_THAT(refusal(holds), HasSubstr("no load along fy: add one"));
}

TEST(Calibration, NamesLoadsThatComeTogetherAlone) {
  Holds holds = simulate(Simulated{}, 1).holds;
  for (Hold& hold : holds.holds) hold.load[4] = 0.02 * hold.load[0];
  EXPECT_THAT(refusal(holds), HasSubstr("fx and ty cannot be told apart"));
}

TEST(Calibration, RefusesWhatIsNoNumber) {
  Holds holds = simulate(Simulated{}, 1).holds;
  holds.holds[4].signal[2] = std::nan("");
  EXPECT_THAT(refusal(holds), HasSubstr("row 5: not every number is finite"));
  EXPECT_THAT(refusal(Holds{.components = {"fx"}, .signals = {"u"}, .holds = {}, .load_error = {}}),
              HasSubstr("there is no load"));
}

}  // namespace
}  // namespace kerf::fitting::calibration
