#include "starts.h"

#include <algorithm>
#include <cmath>

#include <kerf/models/piecewise.h>

#include "least_squares.h"
#include "segments.h"

namespace kerf::fitting {
namespace {

constexpr double small = 1e-6;  ///< of the whole, in place of a part that must be positive and is not
constexpr std::size_t starts_kept = 3;

struct Start {
  std::vector<double> values;
  double sum_of_squares;
};

/// Columns of the law's response to each linear parameter, and the best combination.
Eigen::Vector2d combine(const std::vector<double>& first, const std::vector<double>& second,
                        const Samples& samples, const Mask& mask, double& sum_of_squares) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double total = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!mask[i]) continue;
    const Eigen::Vector2d row(first[i], second[i]);
    normal += row * row.transpose();
    right += row * samples.force[i];
    total += samples.force[i] * samples.force[i];
  }
  const Eigen::Vector2d best = solve_normal(normal, right);
  sum_of_squares = total - right.dot(best);
  return best;
}

Start kelvin_start(const Samples& samples, const Mask& mask, double relaxation_time_s) {
  const auto arm = rendered(models::Law::make("kelvin", std::vector{1e-9, 1.0, relaxation_time_s}), samples);
  std::vector<double> spring;
  for (const models::Motion& motion : samples.motion) spring.push_back(std::max(0.0, motion.penetration));
  Start start{.values = {}, .sum_of_squares = 0.0};
  Eigen::Vector2d stiffness = combine(spring, arm, samples, mask, start.sum_of_squares);
  const double scale = std::max({std::abs(stiffness[0]), std::abs(stiffness[1]), 1e-6});
  stiffness = stiffness.cwiseMax(small * scale);
  start.values = {stiffness[0], stiffness[1], stiffness[1] * relaxation_time_s};
  return start;
}

Start exponential_start(const Problem& problem, const Samples& samples, const Mask& mask, double growth) {
  const models::Options& options = problem.law_options;
  const auto thickness = options.find("thickness");
  const double exponent = growth * (thickness != options.end() ? std::get<double>(thickness->second) : 0.1) /
                          std::max(samples.most, 1e-12);
  const double bounded = std::clamp(exponent, problem.parameters[1].lower, problem.parameters[1].upper);
  const auto elastic =
      rendered(models::Law::make("exponential", std::vector{1.0, bounded, 0.0}, options), samples);
  std::vector<double> viscous;
  for (const models::Motion& motion : samples.motion) {
    viscous.push_back(motion.penetration > 0.0 ? motion.velocity : 0.0);
  }
  Start start{.values = {}, .sum_of_squares = 0.0};
  const Eigen::Vector2d best = combine(elastic, viscous, samples, mask, start.sum_of_squares);
  start.values = {std::max(best[0], 1e-12), bounded, best[1]};
  return start;
}

Start precontact_start(const Problem& problem, const Samples& samples, const Mask& mask, double share) {
  Start start{.values = {1.0, std::max(share * samples.most, problem.parameters[1].lower)},
              .sum_of_squares = 0.0};
  const auto elastic = rendered(models::Law::make("precontact", start.values, problem.law_options), samples);
  const std::vector<double> nothing(elastic.size(), 0.0);
  start.values[0] = std::max(combine(elastic, nothing, samples, mask, start.sum_of_squares)[0],
                             problem.parameters[0].lower);
  return start;
}

/// A law that is linear in all its parameters: its response to each of them, combined at best.
Start linear_start(const Problem& problem, const Samples& samples, const Mask& mask) {
  const auto count = static_cast<Eigen::Index>(problem.parameters.size());
  Eigen::MatrixXd response(static_cast<Eigen::Index>(samples.size()), count);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(response.rows());
  for (Eigen::Index k = 0; k < count; ++k) {
    std::vector<double> unit(problem.parameters.size(), 0.0);
    unit[static_cast<std::size_t>(k)] = 1.0;
    const auto column =
        rendered(models::Law::make(std::string(problem.model), unit, problem.law_options), samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      response(static_cast<Eigen::Index>(i), k) = mask[i] ? column[i] : 0.0;
    }
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (mask[i]) force[static_cast<Eigen::Index>(i)] = samples.force[i];
  }
  Eigen::VectorXd best = least_squares(response, force);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto& info = problem.parameters[static_cast<std::size_t>(k)];
    best[k] = std::clamp(best[k], info.lower, info.upper);
  }
  return {.values = {best.data(), best.data() + best.size()}, .sum_of_squares = 0.0};
}

}  // namespace

std::vector<std::vector<double>> scan_starts(const Problem& problem, const Samples& samples,
                                             const Mask& mask) {
  std::vector<Start> starts;
  if (problem.model == "kelvin") {
    const double shortest = 2.0 * samples.median_period_s;
    const double longest = std::max(samples.duration_s, 4.0 * shortest);
    constexpr int steps = 12;
    for (int i = 0; i <= steps; ++i) {
      starts.push_back(kelvin_start(samples, mask,
                                    shortest * std::pow(longest / shortest, static_cast<double>(i) / steps)));
    }
  } else if (problem.model == "scissors_analytic") {
    starts.push_back(linear_start(problem, samples, mask));
  } else if (problem.model == "precontact") {
    for (const double share : {0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 2.0}) {
      starts.push_back(precontact_start(problem, samples, mask, share));
    }
  } else {
    for (const double growth : {0.1, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 13.0, 20.0}) {
      starts.push_back(exponential_start(problem, samples, mask, growth));
    }
  }
  std::sort(starts.begin(), starts.end(),
            [](const Start& a, const Start& b) { return a.sum_of_squares < b.sum_of_squares; });
  std::vector<std::vector<double>> best;
  for (std::size_t i = 0; i < std::min(starts_kept, starts.size()); ++i) best.push_back(starts[i].values);
  return best;
}

std::vector<double> segmented_start(const Problem& problem, const Samples& samples, const Mask& mask) {
  const models::Piecewise<double> shape = [&] {
    // The shape alone is wanted: any increasing knots will do.
    std::vector<double> values(problem.parameters.size(), 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
    return models::Piecewise<double>::make(values, problem.law_options);
  }();
  const auto knots = best_knots(samples, mask, shape.knots - 1, shape.loop);
  if (knots.empty()) return {};
  std::vector<double> start = knots;
  for (const bool closing : {true, false}) {
    if (!closing && !shape.loop) break;
    const auto forces = forces_at_knots(samples, mask, knots, {.loop = shape.loop, .closing = closing});
    start.insert(start.end(), forces.begin(), forces.end());
  }
  return start;
}

}  // namespace kerf::fitting
