#include "psychometric/likelihood.h"

#include <algorithm>
#include <cmath>

#include "psychometric/shape.h"

namespace kerf::psychophysics {
namespace {

constexpr double least_probability = 1e-150;

struct CellTerms {
  double value = 0.0;
  double slope = 0.0;           ///< d/dpsi
  double per_dispersion = 0.0;  ///< d/dtheta
  double curvature = 0.0;       ///< -d2/dtheta2
};

/// The part of the urn's product that belongs to `count` answers of a kind: (p + 0) (p + theta) (p + 2 theta)
/// ...
CellTerms urn(int count, double p, double theta) {
  CellTerms terms;
  double product = 1.0;  // one logarithm for many factors
  for (int j = 0; j < count; ++j) {
    const double factor = p + j * theta;
    const double inverse = 1.0 / factor;
    product *= factor;
    if (product < 1e-100 || product > 1e100) {
      terms.value += std::log(product);
      product = 1.0;
    }
    terms.slope += inverse;
    terms.per_dispersion += j * inverse;
    terms.curvature += j * inverse * (j * inverse);
  }
  terms.value += std::log(product);
  return terms;
}

/// Beta-binomial as the product that Polya's urn gives, binomial where the dispersion is held at zero.
CellTerms cell_terms(const Count& answers, double right, double wrong, double theta, bool is_dispersed) {
  const auto [k, n] = answers;
  CellTerms terms;
  if (!is_dispersed) {
    if (k > 0) terms = {.value = k * std::log(right), .slope = k / right};
    if (k < n) {
      terms.value += (n - k) * std::log(wrong);
      terms.slope -= (n - k) / wrong;
    }
    return terms;
  }
  const CellTerms of_right = urn(k, right, theta);
  const CellTerms of_wrong = urn(n - k, wrong, theta);
  const CellTerms of_all = urn(n, 1.0, theta);
  return {.value = of_right.value + of_wrong.value - of_all.value,
          .slope = of_right.slope - of_wrong.slope,
          .per_dispersion = of_right.per_dispersion + of_wrong.per_dispersion - of_all.per_dispersion,
          .curvature = of_right.curvature + of_wrong.curvature - of_all.curvature};
}

bool is_dispersed(const Problem& problem) { return problem.upper[dispersion_index] > 0.0; }

struct Curve {
  double quantile = 0.0;
  double quantile_per_lapse = 0.0;
  double slope = 0.0;
  double range = 0.0;  ///< 1 - guess - lapse
};

Curve curve_at(const Problem& problem, const Point& point) {
  Curve curve;
  curve.range = 1.0 - problem.guess - point[lapse_index];
  curve.slope = std::exp(point[slope_index]);
  curve.quantile = criterion_quantile(problem, point[lapse_index]);
  const double level = (problem.criterion - problem.guess) / curve.range;
  curve.quantile_per_lapse = level / curve.range / shape_at(problem.shape, curve.quantile).density;
  return curve;
}

struct Probabilities {
  ShapeAt shape;
  double right = 0.0;
  double wrong = 0.0;
};

Probabilities probabilities(const Problem& problem, const Curve& curve, const Point& point, double at) {
  Probabilities p;
  p.shape = shape_at(problem.shape, curve.slope * (at - point[threshold_index]) + curve.quantile);
  p.right = std::max(least_probability, problem.guess + curve.range * p.shape.below);
  p.wrong = std::max(least_probability, point[lapse_index] + curve.range * p.shape.above);
  return p;
}

/// Solves the part of (information + damping) x = gradient that is free, by Cholesky; false where it has no
/// solution.
bool solve(const Score& s, const Held& fixed, double damping, Point& step) {
  std::array<Point, parameters> root{};
  step = {};
  for (std::size_t i = 0; i < parameters; ++i) {
    if (fixed[i]) continue;
    for (std::size_t j = 0; j <= i; ++j) {
      if (fixed[j]) continue;
      double sum = s.information[i][j];
      if (i == j) sum = sum * (1.0 + damping) + 1e-12;
      for (std::size_t k = 0; k < j; ++k) sum -= fixed[k] ? 0.0 : root[i][k] * root[j][k];
      if (i == j && !(sum > 0.0)) return false;
      root[i][j] = i == j ? std::sqrt(sum) : sum / root[j][j];
    }
  }
  for (std::size_t i = 0; i < parameters; ++i) {
    if (fixed[i]) continue;
    double sum = s.gradient[i];
    for (std::size_t k = 0; k < i; ++k) sum -= fixed[k] ? 0.0 : root[i][k] * step[k];
    step[i] = sum / root[i][i];
  }
  for (std::size_t i = parameters; i-- > 0;) {
    if (fixed[i]) continue;
    for (std::size_t k = i + 1; k < parameters; ++k) step[i] -= fixed[k] ? 0.0 : root[k][i] * step[k];
    step[i] /= root[i][i];
  }
  return true;
}

/// Held, or at a bound that the likelihood presses against.
Held fixed_at(const Problem& problem, const Point& point, const Point& gradient, const Held& held) {
  Held fixed = held;
  for (std::size_t i = 0; i < parameters; ++i) {
    if (point[i] <= problem.lower[i] && gradient[i] <= 0.0) fixed[i] = true;
    if (point[i] >= problem.upper[i] && gradient[i] >= 0.0) fixed[i] = true;
  }
  return fixed;
}

}  // namespace

double criterion_quantile(const Problem& problem, double lapse) {
  return shape_quantile(problem.shape, (problem.criterion - problem.guess) / (1.0 - problem.guess - lapse));
}

double log_likelihood(const Problem& problem, const Point& point) {
  const Curve curve = curve_at(problem, point);
  const bool dispersed = is_dispersed(problem);
  double sum = 0.0;
  for (const Cell& cell : problem.cells) {
    const Probabilities p = probabilities(problem, curve, point, cell.at);
    sum += cell_terms(cell.answers, p.right, p.wrong, point[dispersion_index], dispersed).value;
  }
  return sum;
}

Score score(const Problem& problem, const Point& point) {
  const Curve curve = curve_at(problem, point);
  const bool dispersed = is_dispersed(problem);
  const double rho = point[dispersion_index] / (1.0 + point[dispersion_index]);
  double curvature = 0.0;
  Score result;
  for (const Cell& cell : problem.cells) {
    const Probabilities p = probabilities(problem, curve, point, cell.at);
    const CellTerms terms = cell_terms(cell.answers, p.right, p.wrong, point[dispersion_index], dispersed);
    result.log_likelihood += terms.value;
    const double steepness = curve.range * p.shape.density;
    const Point change{-curve.slope * steepness,
                       steepness == 0.0 ? 0.0 : curve.slope * (cell.at - point[threshold_index]) * steepness,
                       -p.shape.below + steepness * curve.quantile_per_lapse, 0.0};
    result.gradient[dispersion_index] += terms.per_dispersion;
    curvature += terms.curvature;
    const double n = cell.answers.trials;
    const double weight = n / (p.right * p.wrong) / (1.0 + (n - 1.0) * rho);
    for (std::size_t i = 0; i < parameters; ++i) {
      result.gradient[i] += terms.slope * change[i];
      for (std::size_t j = 0; j <= i; ++j) result.information[i][j] += weight * change[i] * change[j];
    }
  }
  // Far from the maximum the curvature may be of the wrong sign; the damping then finds the length of the
  // step.
  result.information[dispersion_index][dispersion_index] =
      std::max(curvature, 0.1 * std::abs(result.gradient[dispersion_index]) + 1e-6);
  return result;
}

Maximum maximise(const Problem& problem, const Point& start, const Held& held) {
  constexpr int max_rounds = 300;
  constexpr double least_gain = 1e-11;
  const double rounding = 1e-14 * std::abs(log_likelihood(problem, start));
  Point at = start;
  for (std::size_t i = 0; i < parameters; ++i)
    at[i] = held[i] ? at[i] : std::clamp(at[i], problem.lower[i], problem.upper[i]);
  Score now = score(problem, at);
  double damping = 1e-3;
  int calm = 0;
  for (int round = 0; round < max_rounds && damping < 1e12 && calm < 2; ++round) {
    const Held fixed = fixed_at(problem, at, now.gradient, held);
    Point step{};
    if (!solve(now, fixed, damping, step)) {
      damping *= 10.0;
      continue;
    }
    Point next = at;
    for (std::size_t i = 0; i < parameters; ++i)
      next[i] = fixed[i] ? at[i] : std::clamp(at[i] + step[i], problem.lower[i], problem.upper[i]);
    const Score there = score(problem, next);
    const double gain = there.log_likelihood - now.log_likelihood;
    if (next == at) break;
    if (gain >= -rounding) {
      at = next;
      now = there;
      damping = std::max(1e-9, damping * 0.2);
      calm = gain < least_gain ? calm + 1 : 0;
    } else {
      damping *= 5.0;
    }
  }
  return {.at = at, .log_likelihood = now.log_likelihood};
}

Maximum maximise_from_many(const Problem& problem, const Point& like, const Held& held) {
  constexpr std::size_t polished = 3;
  std::vector<Maximum> starts;
  const auto values = [&](std::size_t i, const std::vector<double>& all) {
    return held[i] || problem.lower[i] == problem.upper[i] ? std::vector<double>{like[i]} : all;
  };
  for (const double threshold : values(threshold_index, {-0.2, 0.0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1.1})) {
    for (const double slope :
         values(slope_index, {0.0, 0.8, 1.5, 2.2, 3.0, 4.0, 5.3, problem.upper[slope_index]})) {
      for (const double lapse :
           values(lapse_index, {0.25 * problem.upper[lapse_index], 0.75 * problem.upper[lapse_index]})) {
        const Point at{threshold, slope, lapse, like[dispersion_index]};
        starts.push_back({.at = at, .log_likelihood = log_likelihood(problem, at)});
      }
    }
  }
  const auto kept = std::min(polished, starts.size());
  std::partial_sort(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(kept), starts.end(),
                    [](const Maximum& a, const Maximum& b) { return a.log_likelihood > b.log_likelihood; });
  Maximum best;
  for (std::size_t i = 0; i < kept; ++i) {
    const Maximum found = maximise(problem, starts[i].at, held);
    if (found.log_likelihood > best.log_likelihood) best = found;
  }
  return best;
}

}  // namespace kerf::psychophysics
