#include "profiles/limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "infinite.h"
#include "profiles/ridge.h"
#include "share_out.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

using Eigen::Index;

constexpr double short_half = 0.1;  ///< of an interval that is taken as it is
constexpr double like_a_parabola = 0.1;
constexpr double near_enough = 0.005;  ///< of a deviation, to the limit that it should reach
/// Samples that a knot goes past leave one line for another: where few lie within its interval, the sum of
/// squares bends by turns more and less than J'J says, and so it does for the forces beside. What J'J lacks
/// is, in itself, a share that falls with the fourth root of the number of samples.
constexpr double enough_for_knots = 3000.0;
constexpr double zero_beside = 1e-6;  ///< of the upper bound: a lower one this small stands for none

/// A column of the inverse of second derivatives whose scales may be far apart.
Eigen::VectorXd inverse_column(const Eigen::MatrixXd& hessian, Index k) {
  const Eigen::VectorXd length = hessian.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd scale = (length.array() > 0.0).select(length.cwiseInverse(), 0.0);
  const Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  return scale[k] * scale.cwiseProduct(solve_normal(scaled, Eigen::VectorXd::Unit(hessian.cols(), k)));
}

/// The rise of a sum of squares in one standard error of a coordinate: its variance over what it were if the
/// residuals were white and of variance one.
double unit_of_rise(const Uncertainty& uncertainty, const Eigen::MatrixXd& hessian, const Sums& sums,
                    Index k) {
  const double inverse = inverse_column(hessian, k)[k];
  if (uncertainty.determined[static_cast<std::size_t>(k)] && inverse > 0.0) {
    const double unit = uncertainty.covariance(k, k) / inverse;
    if (std::isfinite(unit) && unit > 0.0) return unit;
  }
  return std::max(sums.squares / std::max(1.0, uncertainty.effective_samples), 1e-300);
}

/// The value, outwards from the best, where the deviation reaches the limit; none where it does not before
/// the bound, or falls short of it there, or only because another one came to the end of its range.
std::optional<double> where_it_reaches(Ridge& ridge, double best, double step, double bound,
                                       const Bounds& ends, double limit) {
  constexpr int most_steps = 60;
  constexpr int few_steps = 3;  // after which the bound itself is asked: there may be no limit at all
  ridge.begin_anew();
  double inner = best;
  double inner_miss = -limit;
  double outer = best;
  double outer_miss = 0.0;
  for (int i = 0; true; ++i) {
    if (i == few_steps && ridge.deviation(bound, limit) < limit) return std::nullopt;
    outer = step < 0.0 ? std::max(best + step, bound) : std::min(best + step, bound);
    outer_miss = ridge.deviation(outer, limit) - limit;
    if (outer_miss >= 0.0) break;
    if (outer == bound || i == most_steps || ridge.came_to_an_end(ends)) return std::nullopt;
    ridge.keep();
    inner = outer;
    inner_miss = outer_miss;
    step *= 2.0;
  }
  // Halves while the outer end is far beyond, then regula falsi that halves what stays (Illinois).
  constexpr double far_beyond = 4.0;
  double inner_weight = inner_miss;
  double outer_weight = outer_miss;
  for (int i = 0; i < most_steps; ++i) {
    if (outer_miss <= near_enough * limit || std::abs(outer - inner) < 1e-9 * (1.0 + std::abs(outer))) break;
    const double share =
        outer_miss <= far_beyond * limit ? inner_weight / (inner_weight - outer_weight) : 0.5;
    const double between = inner + std::clamp(share, 0.02, 0.98) * (outer - inner);
    const double miss = ridge.deviation(between, limit) - limit;
    if (miss < 0.0) {
      ridge.keep();
      inner = between;
      inner_miss = inner_weight = miss;
      outer_weight *= 0.5;
      if (miss >= -near_enough * limit) return inner;
    } else {
      outer = between;
      outer_miss = outer_weight = miss;
      inner_weight *= 0.5;
    }
  }
  return outer;
}

/// One coordinate and what is asked of it, on the search scale.
struct Question {
  const models::ParameterInfo& info;
  Index k = 0;
  double best = 0.0;
  double half = 0.0;  ///< of Wald's interval
  double quantile = 0.0;
  double degrees_of_freedom = 0.0;
  double scale = 1.0;  ///< of a change that counts
  double unit = 1.0;   ///< of the rise of the sum of squares
  /// Numbers that mean nothing where this one is none; asked for where it matters.
  std::function<std::size_t()> without_meaning = [] { return std::size_t{0}; };
};

Question question_of(const models::ParameterInfo& info, const Eigen::VectorXd& at, Index k,
                     const Uncertainty& uncertainty) {
  const auto place = static_cast<std::size_t>(k);
  const double error = uncertainty.determined[place] ? std::sqrt(uncertainty.covariance(k, k)) : infinite;
  return {.info = info,
          .k = k,
          .best = at[k],
          .half = uncertainty.quantile[place] * error,
          .quantile = uncertainty.quantile[place],
          .degrees_of_freedom = uncertainty.degrees_of_freedom[place]};
}

bool is_like_a_parabola(const LawObjective& objective, const Eigen::VectorXd& at, const Sums& sums,
                        const Eigen::MatrixXd& hessian, const Bounds& bounds, const Question& asked) {
  const Eigen::VectorXd inverse = inverse_column(hessian, asked.k);
  const Eigen::VectorXd direction = inverse / inverse[asked.k];
  for (const double side : {-1.0, 1.0}) {
    const Eigen::VectorXd end = at + side * asked.half * direction;
    if ((end.array() < bounds.lower.array()).any() || (end.array() > bounds.upper.array()).any())
      return false;
    Sums there;
    if (!objective.evaluate(end, there)) return false;
    const double deviation = std::sqrt(std::max(0.0, there.squares - sums.squares) / asked.unit);
    if (!(std::abs(deviation - asked.quantile) <= like_a_parabola * asked.quantile)) return false;
  }
  return true;
}

/// The others follow as if the sum of squares were a parabola, as far as Wald's interval goes.
RidgeAhead ahead_of(const Eigen::MatrixXd& hessian, const Question& asked) {
  if (!(std::isfinite(asked.half) && asked.half > 0.0)) return {};
  const Eigen::VectorXd inverse = inverse_column(hessian, asked.k);
  return {.slope = without(inverse, asked.k) / inverse[asked.k], .reach = asked.half};
}

/// Where none is on the search scale; its deviation is asked there.
double none_on_scale(const models::ParameterInfo& info) {
  return info.scale == models::Scale::logarithmic ? std::log(info.lower) : 0.0;
}
bool is_one_sided(const models::ParameterInfo& info) {
  return info.scale == models::Scale::logarithmic || info.lower == 0.0;
}

/// How likely so large an estimate is where there is nothing. What means nothing then is fitted to the noise
/// as well: as many numbers are free.
double p_of(double deviation, const Question& asked) {
  constexpr double beyond_doubt = 1e-6;
  if (std::isnan(deviation)) return deviation;
  const double sides = is_one_sided(asked.info) ? 0.5 : 1.0;
  const double alone = sides * two_sided_p(deviation, asked.degrees_of_freedom);
  if (!(alone > beyond_doubt)) return alone;
  const std::size_t others = asked.without_meaning();
  return others == 0 ? alone : sides * two_sided_p(deviation, asked.degrees_of_freedom, 1 + others);
}

/// Whether none lies within the interval.
bool may_be_none(double p_zero, const Question& asked) {
  return is_one_sided(asked.info) &&
         p_zero >= 0.5 * two_sided_p((1.0 + near_enough) * asked.quantile, asked.degrees_of_freedom);
}

/// How many other coordinates move nothing where one of them is none.
std::size_t count_without_meaning(const Objective& objective, const Eigen::VectorXd& at,
                                  const Eigen::MatrixXd& normal, Index k, double none) {
  constexpr double nothing = 1e-6;  // of what it moved
  Eigen::VectorXd there = at;
  there[k] = none;
  Sums sums;
  if (!objective.evaluate(there, sums)) return 0;
  std::size_t count = 0;
  for (Index j = 0; j < at.size(); ++j)
    count += j != k && normal(j, j) > 0.0 && sums.normal(j, j) <= nothing * nothing * normal(j, j) ? 1 : 0;
  return count;
}

Limits by_wald(const Question& asked) {
  const double lower = from_search_scale(asked.info, asked.best - asked.half);
  const double upper = from_search_scale(asked.info, asked.best + asked.half);
  const double value = from_search_scale(asked.info, asked.best);
  Limits limits{.lower = std::max(lower, std::min(asked.info.lower, value)),
                .upper = std::min(upper, std::max(asked.info.upper, value)),
                .by = IntervalBy::wald};
  if (may_be_zero(asked.info) && asked.half > 0.0) {
    const double in_errors = asked.info.scale == models::Scale::logarithmic
                                 ? asked.quantile / asked.half
                                 : std::abs(asked.best) * asked.quantile / asked.half;
    limits.p_zero = p_of(in_errors, asked);
    if (may_be_none(limits.p_zero, asked)) limits.lower = std::min(limits.lower, 0.0);
  }
  return limits;
}

/// The ends of the ranges that are none of nature's: to be without is an end like any other value.
Bounds ends_of(const Problem& problem) {
  Bounds ends = problem.bounds();
  const auto coordinates = problem.all();
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    if (may_be_zero(problem.parameters[coordinates[k].parameter]))
      ends.lower[static_cast<Index>(k)] = -infinite;
  }
  return ends;
}

/// None where what the ridge says at an end is not so by the law itself.
std::optional<Limits> by_profile(Ridge ridge, const Objective& law, const Bounds& bounds, const Bounds& ends,
                                 const Question& asked) {
  const double step =
      std::isfinite(asked.half) && asked.half > 0.0 ? std::min(asked.half, asked.scale) : asked.scale;
  Limits limits{.by = IntervalBy::profile};
  bool is_so = true;
  const auto reached = [&](double way, double bound) {
    const auto at = where_it_reaches(ridge, asked.best, way, bound, ends, asked.quantile);
    is_so = is_so && ridge.is_so_by(law);
    return at && !ridge.came_to_an_end(ends) ? at : std::nullopt;
  };
  if (may_be_zero(asked.info)) {
    ridge.begin_anew();
    const double without_it = ridge.deviation(none_on_scale(asked.info));
    is_so = is_so && ridge.is_so_by(law);
    limits.p_zero = p_of(without_it, asked);
  }
  const bool down_to_none = may_be_none(limits.p_zero, asked);
  const auto upper = reached(step, bounds.upper[asked.k]);
  if (upper) limits.upper = from_search_scale(asked.info, *upper);
  if (down_to_none) {
    if (upper) limits.lower = 0.0;  // else nothing is known of it
  } else if (const auto lower = reached(-step, bounds.lower[asked.k])) {
    limits.lower = from_search_scale(asked.info, *lower);
  }
  if (!is_so) return std::nullopt;
  if (std::isinf(limits.lower) && std::isinf(limits.upper)) limits.by = IntervalBy::none;
  return limits;
}

}  // namespace

bool may_be_zero(const models::ParameterInfo& info) {
  if (info.scale == models::Scale::logarithmic)
    return info.quantity != models::Quantity::time && info.lower <= zero_beside * info.upper;
  return info.lower <= 0.0 && info.upper >= 0.0 && info.quantity != models::Quantity::position;
}

Eigen::MatrixXd hessian_of(const Objective& objective, const Eigen::VectorXd& at, const Sums& sums) {
  constexpr double small = 1e-4;  // of the change that adds as much to the squares as there is
  constexpr double least = 0.1;   // of J'J along any direction, that is still a minimum to speak of
  constexpr double most = 10.0;
  Eigen::MatrixXd hessian(at.size(), at.size());
  Sums there;
  for (Index k = 0; k < at.size(); ++k) {
    if (!(sums.normal(k, k) > 0.0)) return sums.normal;
    Eigen::VectorXd moved = at;
    moved[k] += small * std::min(1.0, std::sqrt(sums.squares / sums.normal(k, k)));
    if (!(moved[k] != at[k]) || !objective.evaluate(moved, there)) return sums.normal;
    hessian.col(k) = (there.score - sums.score) / (moved[k] - at[k]);
  }
  hessian = 0.5 * (hessian + hessian.transpose()).eval();
  const Eigen::VectorXd scale = sums.normal.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * sums.normal * scale.asDiagonal());
  if (factor.info() != Eigen::Success || !hessian.allFinite()) return sums.normal;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  const Eigen::MatrixXd half = factor.matrixL().solve(scaled);
  const Eigen::MatrixXd relative = factor.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(relative, Eigen::EigenvaluesOnly);
  const auto& values = spectrum.eigenvalues();
  return values.minCoeff() > least && values.maxCoeff() < most ? hessian : sums.normal;
}

void take_curvature(Uncertainty& uncertainty, const Sums& sums, const Eigen::MatrixXd& hessian) {
  if (!uncertainty.covariance.allFinite()) return;
  Eigen::MatrixXd inverse(hessian.rows(), hessian.cols());
  for (Index k = 0; k < hessian.cols(); ++k) inverse.col(k) = inverse_column(hessian, k);
  const Eigen::MatrixXd change = inverse * sums.normal;
  uncertainty.covariance = change * uncertainty.covariance * change.transpose();
  uncertainty.correlation = correlation_of(uncertainty.covariance);
}

std::vector<Limits> wald_limits_of(const Problem& problem, const Eigen::VectorXd& at,
                                   const Uncertainty& uncertainty) {
  const auto coordinates = problem.all();
  std::vector<Limits> all;
  for (Index k = 0; k < at.size(); ++k) {
    const models::ParameterInfo& info =
        problem.parameters[coordinates[static_cast<std::size_t>(k)].parameter];
    const Question asked = question_of(info, at, k, uncertainty);
    all.push_back(std::isfinite(asked.half) ? by_wald(asked) : Limits{});
  }
  return all;
}

std::vector<Limits> limits_of(const Problem& problem, const LawObjective& objective,
                              const Eigen::VectorXd& at, const Sums& sums, const Eigen::MatrixXd& hessian,
                              const Uncertainty& uncertainty, const std::vector<double>& scale,
                              std::size_t threads,
                              const std::function<std::unique_ptr<const Objective>()>& cheaper) {
  const Bounds bounds = problem.bounds();
  const auto coordinates = problem.all();
  const Bounds ends = ends_of(problem);
  const bool smooth = problem.facts().search == models::Search::descent;
  std::vector<Question> questions;
  for (std::size_t place = 0; place < coordinates.size(); ++place) {
    const auto k = static_cast<Index>(place);
    questions.push_back(question_of(problem.parameters[coordinates[place].parameter], at, k, uncertainty));
    questions.back().scale = scale[place];
    questions.back().unit = unit_of_rise(uncertainty, hessian, sums, k);
    if (smooth)
      questions.back().without_meaning = [&, k, none = none_on_scale(questions.back().info)] {
        return count_without_meaning(objective, at, sums.normal, k, none);
      };
  }
  const auto bends_evenly = [&](const Question& asked) {
    return uncertainty.determined[static_cast<std::size_t>(asked.k)] &&
           is_like_a_parabola(objective, at, sums, hessian, bounds, asked);
  };
  const bool uneven = problem.facts().search == models::Search::segments &&
                      uncertainty.correlation_time < no_misfit_below &&
                      uncertainty.effective_samples < enough_for_knots &&
                      std::ranges::any_of(questions, [&](const Question& asked) {
                        return asked.info.quantity == models::Quantity::position && !bends_evenly(asked);
                      });
  enum class Rule : std::uint8_t { none, wald, profile };
  std::vector<Rule> rules(questions.size(), Rule::none);
  share_out(questions.size(), threads, [&](std::size_t place) {
    const Question& asked = questions[place];
    if (!smooth && !uncertainty.determined[place]) return;
    const bool like_wald = smooth ? asked.half <= short_half * asked.scale || bends_evenly(asked) : !uneven;
    rules[place] = like_wald ? Rule::wald : Rule::profile;
  });
  const bool any_profile = std::ranges::find(rules, Rule::profile) != rules.end();
  const auto near = any_profile && cheaper ? cheaper() : nullptr;
  std::optional<Elsewhere> elsewhere;
  if (any_profile) elsewhere.emplace(problem, objective);
  std::vector<Limits> all(questions.size());
  share_out(questions.size(), threads, [&](std::size_t place) {
    const Question& asked = questions[place];
    if (rules[place] == Rule::wald) all[place] = by_wald(asked);
    if (rules[place] != Rule::profile) return;
    const RidgeAhead ahead = ahead_of(hessian, asked);
    const auto along = [&](const Objective& by) {
      return by_profile(Ridge(by, bounds, at, asked.k, sums.squares, asked.unit, *elsewhere, ahead),
                        objective, bounds, ends, asked);
    };
    std::optional<Limits> found;
    if (near) found = along(*near);
    if (!found) found = along(objective);
    all[place] = found.value_or(Limits{});
  });
  return all;
}

AboveZero limits_above_zero(const Problem& problem, const LawObjective& objective, const Eigen::VectorXd& at,
                            Index held, const Sums& sums, const Uncertainty& uncertainty) {
  constexpr std::array shares{0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.0};
  const Bounds bounds = problem.bounds();
  const auto place = static_cast<std::size_t>(held);
  const models::ParameterInfo& info = problem.parameters[problem.all()[place].parameter];
  const double unit = unit_of_rise(uncertainty, sums.normal, sums, held);
  const Elsewhere elsewhere(problem, objective);
  Ridge ridge(objective, bounds, at, held, sums.squares, unit, elsewhere);
  const double step = info.scale == models::Scale::logarithmic ? 1.0 : 1e-6 * info.upper;
  const Bounds ends = ends_of(problem);
  const double quantile = uncertainty.quantile[place];
  const auto upper = where_it_reaches(ridge, at[held], step, bounds.upper[held], ends, quantile);
  if (!upper || ridge.came_to_an_end(ends)) return {};
  const double limit = from_search_scale(info, *upper);
  AboveZero above{.limits = {.lower = 0.0, .upper = limit, .by = IntervalBy::profile, .p_zero = 0.5},
                  .beside = {}};
  ridge.begin_anew();
  for (const double share : shares) {
    const double deviation = ridge.deviation(to_search_scale(info, share * limit));
    ridge.keep();
    const double of_limit = std::min(1.0, deviation / quantile);
    above.beside.push_back({.others = ridge.last(), .left = std::sqrt(1.0 - of_limit * of_limit)});
  }
  return above;
}

}  // namespace kerf::fitting
