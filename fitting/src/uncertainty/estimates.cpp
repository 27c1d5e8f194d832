#include "uncertainty/estimates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "fracture/fracture_intervals.h"
#include "infinite.h"
#include "profiles/beside_zero.h"
#include "profiles/limits.h"
#include "profiles/profile.h"
#include "profiles/separable.h"
#include "ruptures/rupture_intervals.h"
#include "tables.h"
#include "uncertainty/arms.h"
#include "uncertainty/linearise.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

/// What is known of one coordinate.
struct Known {
  double std_error = 0.0;  ///< on the search scale
  Limits limits;
};

/// A parameter that nobody searched.
Known held_at(double value) { return {0.0, {.lower = value, .upper = value, .by = IntervalBy::held}}; }

Estimate estimate_of(const models::ParameterInfo& info, double value, const Known& known) {
  const bool logarithmic = info.scale == models::Scale::logarithmic;
  return {.info = info,
          .value = value,
          .std_error = logarithmic ? value * known.std_error : known.std_error,
          .lower = known.limits.lower,
          .upper = known.limits.upper,
          .by = known.limits.by,
          .p_zero = known.limits.p_zero};
}

bool at_bound(const models::ParameterInfo& info, double value) {
  const double margin = info.scale == models::Scale::logarithmic ? 1.001 : 1.0;
  return value <= info.lower * (info.lower > 0.0 ? margin : 1.0) ||
         value >= info.upper / (info.upper > 0.0 ? margin : 1.0);
}

/// What is not known of parameters, and what is said of it.
struct Unknown {
  std::vector<std::string> names;
  std::string warning;
};

std::string number(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

/// What the limits leave of a parameter of which little is known.
std::string hardly_known(const std::string& name, const Limits& limits) {
  const std::string only = "the data say of '" + name + "' only that it lies ";
  const bool above = std::isfinite(limits.lower) && limits.lower != 0.0;
  const bool below = std::isfinite(limits.upper);
  if (above && below) return only + "between " + number(limits.lower) + " and " + number(limits.upper);
  if (below) return only + "below " + number(limits.upper);
  if (above) return only + "above " + number(limits.lower);
  return "the data say nothing about '" + name + "'";
}

void estimate_tables(FitResult& result, const Problem& problem, const Samples& samples,
                     const Weights& weights, const Solution& solution, double confidence,
                     const RobustLoss& loss) {
  const auto errors = table_errors(problem, samples, weights, solution.values[0], loss);
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const double value = solution.values[0][i];
    Known known{.std_error = errors[i].std_error, .limits = {}};
    if (std::isfinite(known.std_error)) {
      const double half = known.std_error * student_t(confidence, errors[i].degrees_of_freedom);
      known.limits = {.lower = value - half, .upper = value + half, .by = IntervalBy::wald};
    } else {
      ++unknown;
    }
    result.parameters.push_back(estimate_of(problem.parameters[i], value, known));
  }
  if (unknown > 0) {
    result.warnings.push_back(std::to_string(unknown) + " of " + std::to_string(errors.size()) +
                              " points of the tables were visited once or never; they have no interval");
  }
  if (std::ranges::any_of(samples.runs, [](const Run& run) { return run.contact_error > 0.0; }))
    result.warnings.emplace_back("intervals of tables take where the penetration is zero for exact");
  const auto force = rendered(problem, solution.values, samples);
  std::vector<double> left;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (weights[i] > 0.0) left.push_back(force[i] - samples.force[i]);
  }
  result.correlation_time = correlation_time(left);
}

/// The coordinates of a problem and what is known of each.
struct KnownCoordinates {
  std::vector<Problem::Coordinate> of;
  std::vector<Known> known;

  /// That of a parameter in a recording; none where it was not searched.
  [[nodiscard]] Known* find(std::size_t parameter, std::size_t run) {
    for (std::size_t k = 0; k < of.size(); ++k) {
      if (of[k].parameter == parameter && (of[k].run == Estimate::shared || of[k].run == run))
        return &known[k];
    }
    return nullptr;
  }
};

/// Estimates one after another, from the same samples by the same means.
class Estimation {
 public:
  Estimation(FitResult& result, const Problem& problem, const Samples& samples, const Weights& weights,
             const Solution& solution, const FitOptions& options, const RobustLoss& loss)
      : result_(result),
        problem_(problem),
        samples_(samples),
        weights_(weights),
        solution_(solution),
        options_(options),
        loss_(loss) {}

  void run() {
    // What lies at the end of its range is held there, until the others' intervals are known; where that is
    // none, they are widened by what they are beside a little of it.
    Problem inner(problem_);
    std::vector<Problem::Coordinate> at_bounds;
    std::vector<Problem::Coordinate> asleep;
    const auto hold = [&inner](const Problem::Coordinate& coordinate) {
      if (coordinate.run == Estimate::shared) {
        inner.free[coordinate.parameter] = false;
      } else {
        inner.held.push_back(coordinate);  // that of one recording: the others' are searched
      }
    };
    for (const auto& coordinate : problem_.all()) {
      if (at_bound(problem_.parameters[coordinate.parameter], value_of(coordinate)))
        at_bounds.push_back(coordinate);
      else if (is_nothing(coordinate))
        asleep.push_back(coordinate);
    }
    std::ranges::for_each(at_bounds, hold);
    const Problem awake(inner);  // where those at their bounds are looked at
    std::ranges::for_each(asleep, hold);
    if (inner.facts().search == models::Search::ruptures) {
      estimate_between_ruptures(inner);
    } else if (inner.coordinates() > 0) {
      estimate_within(inner);
    }
    for (const auto& coordinate : at_bounds) estimate_at_bound(awake, coordinate);
    for (const auto& coordinate : asleep) estimate_at_bound(inner, coordinate);
    name_arms();
    for (Unknown& unknown : unknowns_) result_.warnings.push_back(std::move(unknown.warning));
    write();
    if (const std::string_view note = problem_.facts().held_note; !note.empty())
      result_.warnings.emplace_back(note);
  }

 private:
  /// Whether a parameter on a logarithmic scale is so small that the search had no reason to go on to its
  /// bound: the sum of squares is the same without it. On that scale nothing moves it from there, so that it
  /// sleeps while others are followed along a ridge.
  [[nodiscard]] bool is_nothing(const Problem::Coordinate& coordinate) const {
    constexpr double small = 1e6;        // times the lower bound; larger ones are not asked
    constexpr double negligible = 1e-3;  // of the variance of a residual
    const models::ParameterInfo& info = problem_.parameters[coordinate.parameter];
    if (info.scale != models::Scale::logarithmic || !may_be_zero(info) ||
        value_of(coordinate) > small * info.lower || problem_.facts().search != models::Search::descent)
      return false;
    Values without(solution_.values);
    for (std::size_t run = 0; run < without.size(); ++run) {
      if (coordinate.run == Estimate::shared || coordinate.run == run)
        without[run][coordinate.parameter] = info.lower;
    }
    Sums with_it;
    Sums none;
    return LawObjective(problem_, samples_, weights_, solution_.values, loss_)
               .evaluate(coordinates_of(problem_, solution_.values), with_it) &&
           LawObjective(problem_, samples_, weights_, without, loss_)
               .evaluate(coordinates_of(problem_, without), none) &&
           std::abs(none.squares - with_it.squares) <=
               negligible * with_it.squares / static_cast<double>(samples_.size());
  }
  [[nodiscard]] double value_of(const Problem::Coordinate& c) const {
    return solution_.values[c.run == Estimate::shared ? 0 : c.run][c.parameter];
  }
  [[nodiscard]] Known* known_of(const Problem::Coordinate& c) {
    return known_.find(c.parameter, c.run == Estimate::shared ? 0 : c.run);
  }
  [[nodiscard]] std::string name_of(const Problem::Coordinate& c) const {
    const std::string& name = problem_.parameters[c.parameter].name;
    return c.run == Estimate::shared ? name : name + " of recording " + std::to_string(c.run + 1);
  }

  void estimate_within(const Problem& inner) {
    const LawObjective objective(inner, samples_, weights_, solution_.values, loss_);
    const Eigen::VectorXd at = coordinates_of(inner, solution_.values);
    Uncertainty uncertainty;
    std::vector<Limits> limits;
    if (options_.intervals == Intervals::white) {
      uncertainty = as_of_white_noise(objective, at, solution_, weights_, options_.confidence);
      limits = wald_limits_of(inner, at, uncertainty);
      result_.covariance_by = CovarianceBy::white;
    } else {
      const Linearisation linear = linearise(objective, inner, solution_, samples_, weights_, loss_);
      if (inner.facts().search == models::Search::threshold && !is_least(linear)) {
        return take_none(
            inner, "the memberships were trained on means, and are not those of least squares: no intervals");
      }
      uncertainty = uncertainty_of(linear, options_.confidence);
      limits = limits_within(inner, objective, at, linear, uncertainty);
      result_.covariance_by = uncertainty.by_cycles ? CovarianceBy::cycles : CovarianceBy::residuals;
      if (inner.facts().search == models::Search::fracture && inner.coordinates() == problem_.coordinates())
        events_ = limits_by_events(inner, samples_, weights_, solution_, loss_, linear, uncertainty,
                                   options_.confidence);
      if (!events_.warning.empty()) result_.warnings.push_back(events_.warning);
    }
    result_.correlation_time = std::min(uncertainty.correlation_time, static_cast<double>(samples_.size()));
    take(inner, uncertainty, limits);
    if (options_.profile) {
      result_.profiles =
          profiles_of(inner, samples_, weights_, solution_.values, loss_, uncertainty, result_.searched);
    }
  }

  /// Between its ruptures the law is an element, whose intervals are those of one; of the line at which it
  /// ruptures the rows tell that do.
  void estimate_between_ruptures(const Problem& inner) {
    BetweenRuptures between(inner, samples_, weights_, solution_, loss_);
    Problem& element = between.parts.element;
    std::copy_n(inner.free.begin(), element.free.size(), element.free.begin());
    if (element.coordinates() == 0) return;
    const Solution alone = between.alone(loss_);
    const LawObjective objective(element, between.parts.samples, between.parts.weights, alone.values, loss_);
    const Eigen::VectorXd at = coordinates_of(element, alone.values);
    if (options_.intervals == Intervals::white) {
      const Uncertainty white =
          as_of_white_noise(objective, at, alone, between.parts.weights, options_.confidence);
      result_.covariance_by = CovarianceBy::white;
      take(element, white, wald_limits_of(element, at, white));
      return take_line(inner, {});
    }
    const Linearisation linear = linearise(objective, element, alone, samples_, weights_, loss_);
    Uncertainty uncertainty = uncertainty_of(linear, options_.confidence);
    const std::vector<Limits> limits = limits_within(element, objective, at, linear, uncertainty);
    result_.covariance_by = uncertainty.by_cycles ? CovarianceBy::cycles : CovarianceBy::residuals;
    result_.correlation_time = std::min(uncertainty.correlation_time, static_cast<double>(samples_.size()));
    const ByRuptures line = limits_by_ruptures(between, loss_, alone.squares, uncertainty);
    if (!line.doubt.empty()) return take_none(inner, line.doubt + ": no intervals");
    take(element, uncertainty, limits);
    take_line(inner, line);
    if (options_.profile) {
      result_.profiles = profiles_of(element, between.parts.samples, between.parts.weights, alone.values,
                                     loss_, uncertainty, result_.searched);
    }
  }

  /// Takes the curvature of a law that misfits into the uncertainty.
  [[nodiscard]] std::vector<Limits> limits_within(const Problem& inner, const LawObjective& objective,
                                                  const Eigen::VectorXd& at, const Linearisation& linear,
                                                  Uncertainty& uncertainty) const {
    Sums sums{.squares = linear.residuals.squaredNorm(), .score = linear.score, .normal = linear.normal};
    if (loss_.kind != Loss::squares && !objective.evaluate(at, sums))  // whose squares cost less
      return std::vector<Limits>(uncertainty.determined.size());
    Eigen::MatrixXd hessian = sums.normal;
    if (uncertainty.correlation_time > no_misfit_below && inner.facts().search == models::Search::descent) {
      hessian = hessian_of(objective, at, sums);
      take_curvature(uncertainty, sums, hessian);
    }
    const auto cheaper = [&]() -> std::unique_ptr<const Objective> {
      if (loss_.kind != Loss::squares) return nullptr;
      return SeparableSums::around(objective, inner, at, linear.residuals);
    };
    return limits_of(inner, objective, at, sums, hessian, uncertainty, linear.scale, options_.threads,
                     cheaper);
  }

  void take(const Problem& inner, const Uncertainty& uncertainty, const std::vector<Limits>& limits) {
    known_.of = inner.all();
    std::vector<bool> logarithmic;
    for (std::size_t k = 0; k < known_.of.size(); ++k) {
      const auto diagonal = static_cast<Eigen::Index>(k);
      known_.known.push_back({.std_error = uncertainty.determined[k]
                                               ? std::sqrt(uncertainty.covariance(diagonal, diagonal))
                                               : infinite,
                              .limits = limits[k]});
      if (!std::isnan(error_by_events(k))) known_.known.back() = {events_.std_error[k], events_.limits[k]};
      result_.searched.push_back(name_of(known_.of[k]));
      logarithmic.push_back(inner.parameters[known_.of[k].parameter].scale == models::Scale::logarithmic);
    }
    result_.correlation.assign(uncertainty.correlation.data(),
                               uncertainty.correlation.data() + uncertainty.correlation.size());
    for (const UnidentifiableDirection& unidentifiable : uncertainty.unidentifiable) {
      const auto told = [&](const auto& part) { return std::isfinite(error_by_events(part.first)); };
      if (std::ranges::all_of(unidentifiable.parts, told)) continue;
      std::vector<std::string> names;
      for (const auto& [place, share] : unidentifiable.parts) names.push_back(result_.searched[place]);
      if (names.size() > 1) ++result_.undetermined_directions;
      std::string warning = names.size() == 1 ? hardly_known(names[0], limits[unidentifiable.parts[0].first])
                                              : describe(unidentifiable, result_.searched, logarithmic);
      unknowns_.push_back({std::move(names), std::move(warning)});
    }
    warn_of_zeros(inner);
  }

  /// Whether the solution is where the sum of squares is least, to a small share of a standard error. Notes
  /// how long the residuals remember.
  [[nodiscard]] bool is_least(const Linearisation& linear) {
    constexpr double negligible = 0.02;  // of the rise in one standard error
    result_.correlation_time = correlation_time({linear.residuals.begin(), linear.residuals.end()});
    const double promise = linear.score.dot(solve_normal(linear.normal, linear.score));
    const double unit = linear.residuals.squaredNorm() * result_.correlation_time /
                        static_cast<double>(linear.residuals.size());
    return promise <= negligible * unit;
  }

  /// Estimates that are not those of least squares vary otherwise than these do: by how much is not known.
  void take_none(const Problem& inner, std::string why) {
    known_.of = inner.all();
    known_.known.assign(known_.of.size(), Known{.std_error = infinite, .limits = {}});
    unknowns_.push_back({{}, std::move(why)});
  }

  /// What is known of the line at which tissue ruptures, besides the element that does.
  void take_line(const Problem& inner, const ByRuptures& line) {
    for (const auto& coordinate : inner.all()) {
      const std::string& name = inner.parameters[coordinate.parameter].name;
      if (known_.find(coordinate.parameter, 0) != nullptr) continue;
      const Limits& limits = name.starts_with("per_speed") ? line.per_speed : line.constant;
      known_.of.push_back(coordinate);
      known_.known.push_back({.std_error = line.std_error(limits), .limits = limits});
      if (!std::isfinite(known_.known.back().std_error))
        unknowns_.push_back({{name}, hardly_known(name, limits)});
    }
  }

  /// What the rows that break say of a coordinate; NaN where they say nothing.
  [[nodiscard]] double error_by_events(std::size_t k) const {
    return k < events_.std_error.size() ? events_.std_error[k] : std::numeric_limits<double>::quiet_NaN();
  }

  /// A parameter that may as well be zero is said to be so, unless more than that is said of it.
  void warn_of_zeros(const Problem& inner) {
    if (inner.facts().search != models::Search::descent) return;
    for (std::size_t k = 0; k < known_.of.size(); ++k) {
      const double p = known_.known[k].limits.p_zero;
      const auto said = [&](const Unknown& unknown) {
        return std::ranges::find(unknown.names, result_.searched[k]) != unknown.names.end();
      };
      if (!(p > 1.0 - options_.confidence) || std::ranges::any_of(unknowns_, said)) continue;
      unknowns_.push_back({{result_.searched[k]},
                           "'" + result_.searched[k] + "' is not told from zero (p = " + number(p) + ")"});
    }
  }

  /// A parameter at its lower bound, where that stands for none, has a limit above it.
  void estimate_at_bound(const Problem& inner, const Problem::Coordinate& coordinate) {
    const models::ParameterInfo& info = problem_.parameters[coordinate.parameter];
    const std::string name = name_of(coordinate);
    Known known{.std_error = infinite, .limits = {}};
    std::string warning = "'" + name + "' lies at the bound of its range: no interval";
    const bool at_zero = may_be_zero(info) && value_of(coordinate) < 0.5 * info.upper &&
                         inner.facts().search == models::Search::descent &&
                         options_.intervals == Intervals::correlated;
    if (at_zero) {
      Problem with(inner);
      with.free[coordinate.parameter] = true;
      std::erase(with.held, coordinate);
      known.limits = limits_of_zero(with, coordinate);
      if (std::isfinite(known.limits.upper))
        warning = "'" + name + "' is zero, as far as the data tell: below " + number(known.limits.upper) +
                  "; the others' intervals allow for it";
    }
    known_.of.push_back(coordinate);
    known_.known.push_back(known);
    unknowns_.push_back({{name}, std::move(warning)});
  }

  /// Widens the others' intervals by what is not known of it.
  [[nodiscard]] Limits limits_of_zero(const Problem& with, const Problem::Coordinate& coordinate) {
    const LawObjective objective(with, samples_, weights_, solution_.values, loss_);
    const Eigen::VectorXd at = coordinates_of(with, solution_.values);
    const auto all = with.all();
    const auto held = std::ranges::find_if(all, [&](const Problem::Coordinate& c) {
      return c.parameter == coordinate.parameter && c.run == coordinate.run;
    });
    Sums sums;
    if (!objective.evaluate(at, sums)) return {};
    const Uncertainty uncertainty =
        uncertainty_of(linearise(objective, with, solution_, samples_, weights_, loss_), options_.confidence);
    const AboveZero above = limits_above_zero(with, objective, at, held - all.begin(), sums, uncertainty);
    for (Eigen::Index k = 0; k < at.size(); ++k) {
      const Problem::Coordinate& other = all[static_cast<std::size_t>(k)];
      Known* const known = known_of(other);
      if (known == nullptr || other == coordinate || !std::isfinite(known->std_error)) continue;
      const double with_it = uncertainty.determined[static_cast<std::size_t>(k)]
                                 ? std::sqrt(uncertainty.covariance(k, k))
                                 : infinite;
      const Eigen::Index place = k < held - all.begin() ? k : k - 1;  // among the others
      if (hangs_on(at[k], known->std_error, with_it, above.beside, place))
        forget(*known, other, coordinate);
      else if (!above.beside.empty())
        widen(*known, other, above.beside, place);
    }
    return above.limits;
  }

  /// Takes into an interval what it is beside each value of another parameter that lies at zero.
  void widen(Known& known, const Problem::Coordinate& coordinate, const std::vector<BestBeside>& beside,
             Eigen::Index place) {
    const models::ParameterInfo& info = problem_.parameters[coordinate.parameter];
    const auto [limits, growth] =
        widened(known.limits, info, to_search_scale(info, value_of(coordinate)), beside, place);
    known = {.std_error = growth * known.std_error, .limits = limits};
    if (std::isfinite(limits.lower) && std::isfinite(limits.upper)) return;
    const std::string name = name_of(coordinate);
    const auto said = std::ranges::find_if(unknowns_, [&](const Unknown& unknown) {
      return std::ranges::find(unknown.names, name) != unknown.names.end();
    });
    if (said == unknowns_.end())
      unknowns_.push_back({{name}, hardly_known(name, limits)});
    else if (said->names.size() == 1)
      said->warning = hardly_known(name, limits);
  }

  void forget(Known& known, const Problem::Coordinate& other, const Problem::Coordinate& zero) {
    known = {.std_error = infinite, .limits = {}};
    const std::string name = name_of(other);
    std::string warning = "'" + name + "' is told only as long as '" + name_of(zero) + "' is zero";
    unknowns_.push_back({{name}, std::move(warning)});
  }

  /// An arm of which little is known, and that is as well left away, is named as a whole.
  void name_arms() {
    const auto seen = std::ranges::count_if(weights_, [](double weight) { return weight > 0.0; });
    const double worth = static_cast<double>(seen) / std::max(1.0, result_.correlation_time);
    for (const Arm& arm : arms_of(problem_)) {
      const auto is_of_the_arm = [&](const Unknown& unknown) {
        return std::ranges::any_of(arm, [&](std::size_t parameter) {
          return std::ranges::find(unknown.names, problem_.parameters[parameter].name) != unknown.names.end();
        });
      };
      if (std::ranges::none_of(unknowns_, is_of_the_arm) ||
          !does_without(arm, problem_, samples_, weights_, solution_, loss_, worth, options_.confidence))
        continue;
      std::erase_if(unknowns_, is_of_the_arm);
      ++result_.undetermined_arms;
      result_.warnings.push_back("the arm of '" + problem_.parameters[arm.front()].name + "' and '" +
                                 problem_.parameters[arm.back()].name +
                                 "' is not determined: the data do not tell this law from one without it");
    }
  }

  void write() {
    for (std::size_t i = 0; i < problem_.parameters.size(); ++i) {
      for (std::size_t run = 0; run < (problem_.own[i] ? problem_.runs : 1); ++run) {
        const double value = solution_.values[run][i];
        const Known* const known = known_.find(i, run);
        Estimate estimate =
            estimate_of(problem_.parameters[i], value, known != nullptr ? *known : held_at(value));
        if (problem_.own[i]) estimate.recording = run;
        (run == 0 ? result_.parameters : result_.others).push_back(std::move(estimate));
      }
    }
  }

  FitResult& result_;
  const Problem& problem_;
  const Samples& samples_;
  const Weights& weights_;
  const Solution& solution_;
  const FitOptions& options_;
  const RobustLoss& loss_;
  KnownCoordinates known_;
  ByEvents events_;
  std::vector<Unknown> unknowns_;
};

}  // namespace

void estimate_parameters(FitResult& result, const Problem& problem, const Samples& samples,
                         const Weights& weights, const Solution& solution, const FitOptions& options,
                         const RobustLoss& loss) {
  if (problem.facts().search == models::Search::tables) {
    estimate_tables(result, problem, samples, weights, solution, options.confidence, loss);
  } else {
    Estimation(result, problem, samples, weights, solution, options, loss).run();
  }
}

}  // namespace kerf::fitting
