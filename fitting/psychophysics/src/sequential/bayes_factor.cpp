#include <cmath>
#include <limits>

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/quadrature/gauss.hpp>

#include <kerf/psychophysics/sequential/bayes_factor.h>

#include "checks.h"
#include "normal.h"

namespace kerf::psychophysics {
namespace {

/// Of an effect that is N(0, g) beforehand.
class FactorOfVariance {
 public:
  FactorOfVariance(double t, int subjects, bool positive_alone)
      : t_(t), n_(subjects), positive_alone_(positive_alone) {}

  [[nodiscard]] double operator()(double g) const {
    const double nu = n_ - 1.0;
    const double grown = 1.0 + n_ * g;
    const double left = nu + t_ * t_ / grown;
    const double factor = std::exp(-0.5 * std::log(grown) - 0.5 * n_ * std::log(left / (nu + t_ * t_)));
    if (!positive_alone_) return factor;
    const double at = t_ * std::sqrt(n_ * n_ * g / grown / left);
    return 2.0 * factor * boost::math::cdf(boost::math::students_t(n_), at);
  }

 private:
  double t_;
  double n_;
  bool positive_alone_;
};

}  // namespace

double bayes_factor_of_t(double t, int subjects, const BayesFactorOptions& options) {
  require(std::isfinite(t), "a Bayes factor needs a t that is finite");
  require(subjects >= 2, "a Bayes factor needs two subjects at least");
  require(options.scale > 0.0, "the scale of an effect has to be above 0");
  const FactorOfVariance factor(t, subjects, options.positive_alone);
  constexpr double farthest = 9.0;
  constexpr int panels = 18;
  double mean = 0.0;
  for (int panel = 0; panel < panels; ++panel) {
    const double lower = farthest * panel / panels;
    mean += boost::math::quadrature::gauss<double, 20>::integrate(
        [&](double x) {
          const double scale = options.scale / x;
          return 2.0 * normal_density(x) * factor(scale * scale);
        },
        lower, lower + farthest / panels);
  }
  return mean;
}

double bayes_factor(std::span<const double> values, const BayesFactorOptions& options) {
  require(values.size() >= 2, "a Bayes factor needs two subjects at least");
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) {
    require(std::isfinite(value), "a value of a Bayes factor is not finite");
    sum += value;
  }
  const double mean = sum / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double deviation = std::sqrt(squares / (n - 1.0));
  if (deviation <= 1e-12 * (1.0 + std::abs(mean))) return std::numeric_limits<double>::quiet_NaN();
  return bayes_factor_of_t(mean / deviation * std::sqrt(n), static_cast<int>(values.size()), options);
}

}  // namespace kerf::psychophysics
