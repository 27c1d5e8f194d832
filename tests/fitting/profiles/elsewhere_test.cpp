#include "profiles/elsewhere.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "fitting/profiles/fitted_strokes.h"

namespace kerf::fitting {
namespace {

/// Dahl's friction along strokes, in columns that are walked here, the least of its squares found by a
/// decomposition of their rows: one of them may be held.
class Dahl {
 public:
  explicit Dahl(const FittedStrokes& strokes) : strokes_(strokes) {
    for (double log_travel = -13.0; log_travel < 0.9; log_travel += 0.1)
      travels_.push_back(std::exp(log_travel));
  }

  /// Root of the rise above the fit, in standard errors, where the least is looked for over all travels.
  [[nodiscard]] double deviation(Eigen::Index held, double value, double unit) const {
    double least = std::numeric_limits<double>::infinity();
    for (const double travel : travels_) least = std::min(least, left(held, value, travel));
    return std::sqrt(std::max(0.0, least - squares_of_fit()) / unit);
  }
  [[nodiscard]] double squares_of_fit() const { return strokes_.linear().residuals.squaredNorm(); }

 private:
  [[nodiscard]] double left(Eigen::Index held, double value, double travel) const {
    const Samples& samples = strokes_.samples;
    const auto count = static_cast<Eigen::Index>(samples.size());
    Eigen::MatrixXd columns(count, 4);
    Eigen::VectorXd force(count);
    double z = 0.0;
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const double x = samples.motion[row].penetration;
      const double moved = i == 0 ? 0.0 : x - samples.motion[row - 1].penetration;
      const double way = moved > 0.0 ? 1.0 : -1.0;
      if (moved != 0.0) z = way + (z - way) * std::exp(-std::abs(moved) / travel);
      const double root = std::sqrt(strokes_.weights[row]);
      columns.row(i) << root, root * x, root * samples.motion[row].velocity, root * z;
      force[i] = root * samples.force[row];
    }
    std::vector<Eigen::Index> rest;
    for (Eigen::Index k = 0; k < 4; ++k) {
      if (k != held) rest.push_back(k);
    }
    const Eigen::VectorXd wanted = force - value * columns.col(held);
    Eigen::MatrixXd those = columns(Eigen::all, rest);
    Eigen::VectorXd best = those.colPivHouseholderQr().solve(wanted);
    if (held != 3 && best[2] < 0.0) {  // friction does not drive
      those = Eigen::MatrixXd(those.leftCols(2));
      best = those.colPivHouseholderQr().solve(wanted);
    }
    return (those * best - wanted).squaredNorm();
  }

  const FittedStrokes& strokes_;
  std::vector<double> travels_;
};

// Friction fitted to an element without any: a stiff spring may be made up for by much friction that builds
// up over a long way, far from where the fit lies.
TEST(Elsewhere, LimitsAreThoseOfTheLeastOverAllTravels) {
  const FittedStrokes strokes("kelvin", {500.0, 800.0, 160.0}, "friction", 0.02, 0.0);
  const Dahl dahl(strokes);
  const Linearisation linear = strokes.linear();
  const Uncertainty uncertainty = uncertainty_of(linear, 0.95);
  const Eigen::MatrixXd inverse = linear.normal.inverse();
  const std::vector<Limits> found = limits(strokes, {});
  int ends = 0;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const auto place = static_cast<std::size_t>(k);
    if (found[place].by != IntervalBy::profile && found[place].by != IntervalBy::none) continue;
    const double unit = uncertainty.covariance(k, k) / inverse(k, k);
    const double quantile = uncertainty.quantile[place];
    for (const double end : {found[place].lower, found[place].upper}) {
      if (end == 0.0 || std::isinf(end)) continue;  // friction that may as well be none; nothing sets a limit
      EXPECT_NEAR(dahl.deviation(k, end, unit), quantile, 0.03 * quantile) << k << " at " << end;
      ++ends;
    }
  }
  EXPECT_GE(ends, 2) << "some are profiles";
}

TEST(Elsewhere, LeastOfOneHeldIsThatOfTheLawAtTheBestOfTheValues) {
  const FittedStrokes strokes("kelvin", {60.0, 90.0, 4.0}, "friction", 0.02);
  const LawObjective objective = strokes.objective();
  const Elsewhere elsewhere(strokes.problem, objective);
  EXPECT_FALSE(elsewhere.least(4, std::log(0.01))) << "which takes the values";
  const auto place = elsewhere.least(1, 200.0);
  ASSERT_TRUE(place);
  EXPECT_EQ((*place)[1], 200.0);
  Sums sums;
  ASSERT_TRUE(objective.evaluate(*place, sums));
  for (const Eigen::Index k : {0, 2})
    EXPECT_NEAR(sums.score[k], 0.0, 1e-6 * std::sqrt(sums.squares * sums.normal(k, k)));
}

TEST(Elsewhere, IsNothingOfALawThatIsNotLinearButForOne) {
  const FittedStrokes strokes("kelvin", {60.0, 90.0, 4.0}, "kelvin", 0.02);
  const LawObjective objective = strokes.objective();
  EXPECT_FALSE(Elsewhere(strokes.problem, objective).least(1, 0.0));
}

}  // namespace
}  // namespace kerf::fitting
