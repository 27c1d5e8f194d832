#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>

#include <kerf/psychophysics/sequential/alpha_spending.h>

#include "checks.h"
#include "normal.h"

namespace kerf::psychophysics {
namespace {

constexpr std::size_t most_looks = 200;
constexpr double farthest_z = 10.0;  ///< beyond lies 1e-23
constexpr double least_spent = 1e-15;

double tail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

double spent_of_one_side(SpendingFunction function, double alpha, double fraction) {
  if (fraction >= 1.0) return alpha;
  if (function == SpendingFunction::pocock) return alpha * std::log1p(std::expm1(1.0) * fraction);
  return 2.0 * tail(normal_quantile(1.0 - 0.5 * alpha) / std::sqrt(fraction));
}

/// Weighted places of the score S = Z sqrt(I) while a study goes on: the sum of f(score) over them is the
/// integral of f times the density.
struct GoingOn {
  std::vector<double> score;
  std::vector<double> weight;

  /// The probability to be at `least` or beyond it, either way if `two_sided`, after so much information
  /// more.
  [[nodiscard]] double crossing(double least, double step, bool two_sided) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < score.size(); ++i) {
      double beyond = tail((least - score[i]) / step);
      if (two_sided) beyond += tail((least + score[i]) / step);
      sum += weight[i] * beyond;
    }
    return sum;
  }

  [[nodiscard]] double density(double at, double step) const {
    constexpr double root_of_two_pi = 2.5066282746310002;
    double sum = 0.0;
    for (std::size_t i = 0; i < score.size(); ++i) {
      const double z = (at - score[i]) / step;
      sum += weight[i] * std::exp(-0.5 * z * z);
    }
    return sum / (step * root_of_two_pi);
  }

  /// What goes on between two scores, by Gauss and Legendre in panels no wider than a step's deviation.
  [[nodiscard]] GoingOn within(double lower, double upper, double step, double next_step) const {
    using Rule = boost::math::quadrature::gauss<double, 10>;
    const double widest = std::min(step, next_step);
    const auto panels = static_cast<int>(std::ceil((upper - lower) / widest));
    const double half = 0.5 * (upper - lower) / panels;
    GoingOn next;
    const auto add = [&](double at, double rule_weight) {
      next.score.push_back(at);
      next.weight.push_back(half * rule_weight * density(at, step));
    };
    for (int panel = 0; panel < panels; ++panel) {
      const double middle = lower + (2.0 * panel + 1.0) * half;
      for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
        const double away = half * Rule::abscissa()[i];
        add(middle - away, Rule::weights()[i]);
        add(middle + away, Rule::weights()[i]);
      }
    }
    return next;
  }
};

/// The score that is reached with this probability.
double score_that_spends(const GoingOn& before, double spends, double step, double farthest, bool two_sided) {
  const auto excess = [&](double least) { return before.crossing(least, step, two_sided) - spends; };
  const double nearest = two_sided ? 0.0 : -farthest;
  if (excess(nearest) <= 0.0) return nearest;
  if (excess(farthest) >= 0.0) return farthest;
  std::uintmax_t rounds = 200;
  const auto [lower, upper] = boost::math::tools::toms748_solve(
      excess, nearest, farthest, boost::math::tools::eps_tolerance<double>(48), rounds);
  return 0.5 * (lower + upper);
}

void require_information(std::span<const double> information, double full) {
  require(!information.empty() && information.size() <= most_looks,
          "a study with alpha spending has 1 to 200 looks");
  double before = 0.0;
  for (const double each : information) {
    require(std::isfinite(each) && each > before, "the information of looks has to ascend from above 0");
    before = each;
  }
  require(std::isfinite(full) && full > 0.0, "the information that was planned has to be above 0");
}

}  // namespace

double alpha_spent(const AlphaSpending& spending, double fraction) {
  require(spending.alpha > 0.0 && spending.alpha < 0.5, "alpha has to lie between 0 and 0.5");
  require(fraction > 0.0, "a fraction of the information has to be above 0");
  const double sides = spending.two_sided ? 2.0 : 1.0;
  return sides * spent_of_one_side(spending.function, spending.alpha / sides, fraction);
}

std::vector<SpendingBound> spending_bounds(const AlphaSpending& spending, std::span<const double> information,
                                           double full) {
  require_information(information, full);
  const bool two_sided = spending.two_sided;
  std::vector<SpendingBound> bounds;
  GoingOn going{.score = {0.0}, .weight = {1.0}};
  double before = 0.0;
  double spent_before = 0.0;
  for (std::size_t look = 0; look < information.size(); ++look) {
    const double root = std::sqrt(information[look]);
    const double step = std::sqrt(information[look] - before);
    const double fraction = information[look] / full;
    const double spent = std::max(spent_before, alpha_spent(spending, fraction));
    double score = farthest_z * root;
    SpendingBound bound{.fraction = fraction, .spent = spent, .z = std::numeric_limits<double>::infinity()};
    if (spent - spent_before > least_spent) {
      score = score_that_spends(going, spent - spent_before, step, score, two_sided);
      bound.z = score / root;
      bound.nominal = (two_sided ? 2.0 : 1.0) * tail(bound.z);
    }
    bounds.push_back(bound);
    if (look + 1 == information.size()) break;
    const double next_step = std::sqrt(information[look + 1] - information[look]);
    going = going.within(two_sided ? -score : -farthest_z * root, score, step, next_step);
    before = information[look];
    spent_before = spent;
  }
  return bounds;
}

}  // namespace kerf::psychophysics
