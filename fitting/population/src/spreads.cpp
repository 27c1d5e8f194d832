#include "spreads.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/toms748_solve.hpp>

namespace kerf::population {
namespace {

constexpr unsigned within_nodes = 20;
constexpr unsigned between_nodes = 30;

struct Node {
  double u = 0.0;  ///< in (0, 1)
  double weight = 0.0;
};

template <unsigned count>
std::vector<Node> nodes() {
  using Gauss = boost::math::quadrature::gauss<double, count>;
  std::vector<Node> all;
  for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
    for (const double sign : {-1.0, 1.0})
      all.push_back({0.5 + 0.5 * sign * Gauss::abscissa()[i], 0.5 * Gauss::weights()[i]});
  }
  return all;
}

/// Where f, which falls from `least` on, comes down to zero; `least` if it is there already.
template <typename F>
double where_falls(const F& f, double least, double start) {
  if (f(least) <= 0.0) return least;
  double low = least;
  double high = std::max(2.0 * least, start);
  while (f(high) > 0.0 && high < 1e150) {
    low = high;
    high *= 8.0;
  }
  std::uintmax_t most = 100;
  const auto ends =
      boost::math::tools::toms748_solve(f, low, high, boost::math::tools::eps_tolerance<double>(40), most);
  return 0.5 * (ends.first + ends.second);
}

double chi_quantile(double degrees, double u) {
  return boost::math::quantile(boost::math::chi_squared(degrees), u);
}

double within_degrees(const std::vector<Specimen>& specimens) {
  double degrees = 0.0;
  for (const Specimen& specimen : specimens) degrees += static_cast<double>(specimen.values.size()) - 1.0;
  return degrees;
}

double within_at(const std::vector<Specimen>& specimens, const Model& model, double q) {
  return where_falls(
      [&](double within) { return fitted(specimens, {.between = 1.0, .within = within}).within_q - q; },
      model.least.within, 1e-2);
}

double normal(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

double zero_if(double variance, double least) { return variance > 2.0 * least ? std::sqrt(variance) : 0.0; }

/// The upper tail of a limit, where so much of what is open lies below a spread of 0 that the limit would be
/// 0 too: then of the part above 0 alone. That specimens are alike by chance does not show that they are.
double tail_above(double tail, double above_zero) { return above_zero > tail ? tail : tail * above_zero; }

}  // namespace

Interval within_limits(const std::vector<Specimen>& specimens, const Model& model, double confidence) {
  const double degrees = within_degrees(specimens);
  const double tail = 0.5 * (1.0 - confidence);
  const auto limit = [&](double u) {
    return zero_if(within_at(specimens, model, chi_quantile(degrees, u)), model.least.within);
  };
  const double at_zero = fitted(specimens, {.between = 1.0, .within = model.least.within}).within_q;
  const double above_zero = boost::math::cdf(boost::math::chi_squared(degrees), at_zero);
  return {.lower = limit(1.0 - tail), .upper = above_zero > 0.0 ? limit(tail_above(tail, above_zero)) : 0.0};
}

OpenVariances::OpenVariances(const std::vector<Specimen>& specimens, const Model& model)
    : specimens_(specimens), model_(model) {
  if (!model.has_within) {
    within_.push_back({model.least.within, 1.0});
    return;
  }
  const double degrees = within_degrees(specimens);
  for (const Node& node : nodes<within_nodes>())
    within_.push_back({within_at(specimens, model, chi_quantile(degrees, node.u)), node.weight});
}

Interval OpenVariances::between_limits(double confidence) const {
  const boost::math::chi_squared chi(static_cast<double>(specimens_.size()) - 1.0);
  // The chance that t_b^2 is more than `between`.
  const auto chance_of_more = [&](double between) {
    double sum = 0.0;
    for (const Within& within : within_)
      sum += within.weight *
             boost::math::cdf(chi, fitted(specimens_, {.between = between, .within = within.variance}).q);
    return sum;
  };
  const auto limit = [&](double chance) {
    const double variance = where_falls([&](double between) { return chance_of_more(between) - chance; },
                                        model_.least.between, 1e-2);
    return zero_if(variance, model_.least.between);
  };
  const double tail = 0.5 * (1.0 - confidence);
  const double above_zero = chance_of_more(model_.least.between);
  return {.lower = limit(1.0 - tail), .upper = above_zero > 0.0 ? limit(tail_above(tail, above_zero)) : 0.0};
}

double OpenVariances::between_at(double q, double within) const {
  return where_falls(
      [&](double between) { return fitted(specimens_, {.between = between, .within = within}).q - q; },
      model_.least.between, 1e-2);
}

Interval OpenVariances::of_the_next(double confidence) const {
  struct Normal {
    double mean, deviation, weight;
  };
  const double degrees = static_cast<double>(specimens_.size()) - 1.0;
  std::vector<Normal> mixture;
  for (const Node& node : nodes<between_nodes>()) {
    const double q = chi_quantile(degrees, node.u);
    for (const Within& within : within_) {
      const double between = between_at(q, within.variance);
      const Fitted fit = fitted(specimens_, {.between = between, .within = within.variance});
      mixture.push_back({fit.mean, std::sqrt(between + 1.0 / fit.weight), node.weight * within.weight});
    }
  }
  const auto quantile = [&](double probability) {
    const auto short_of = [&](double x) {
      double sum = probability;
      for (const Normal& one : mixture) sum -= one.weight * normal((x - one.mean) / one.deviation);
      return sum;
    };
    double low = -1.0;
    double high = 1.0;
    while (short_of(low) < 0.0 && low > -1e150) low *= 4.0;
    while (short_of(high) > 0.0 && high < 1e150) high *= 4.0;
    std::uintmax_t most = 200;
    const auto ends = boost::math::tools::toms748_solve(short_of, low, high,
                                                        boost::math::tools::eps_tolerance<double>(40), most);
    return 0.5 * (ends.first + ends.second);
  };
  const double tail = 0.5 * (1.0 - confidence);
  return {.lower = quantile(tail), .upper = quantile(1.0 - tail)};
}

}  // namespace kerf::population
