#include "starts/threshold.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "kerf/fitting/rupture.h"

namespace kerf::fitting {
namespace {

constexpr std::size_t cells =
    16;  ///< a side, in which a threshold's samples are averaged before the training

/// Means of the samples in the cells of a grid over depth and speed: a threshold is a smooth surface.
RuptureSamples in_cells(const Samples& samples, const Weights& weights) {
  double fastest = 0.0;
  for (const models::Motion& motion : samples.motion) fastest = std::max(fastest, std::abs(motion.velocity));
  struct Mean {
    double weight = 0.0, depth = 0.0, speed = 0.0, force = 0.0;
  };
  std::map<std::pair<std::size_t, std::size_t>, Mean> means;
  const auto cell = [](double value, double most) {
    return std::min(cells - 1, static_cast<std::size_t>(value / most * static_cast<double>(cells)));
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto [depth, velocity] = samples.motion[i];
    if (!(weights[i] > 0.0) || !(depth > 0.0)) continue;
    Mean& mean = means[{cell(depth, samples.most), fastest > 0.0 ? cell(std::abs(velocity), fastest) : 0}];
    mean.weight += weights[i];
    mean.depth += weights[i] * depth;
    mean.speed += weights[i] * std::abs(velocity);
    mean.force += weights[i] * samples.force[i];
  }
  RuptureSamples table;
  for (const auto& [place, mean] : means) {
    table.depth_m.push_back(mean.depth / mean.weight);
    table.speed_m_per_s.push_back(mean.speed / mean.weight);
    table.force_n.push_back(mean.force / mean.weight);
  }
  return table;
}

}  // namespace

Solution solve_threshold(const Problem& problem, const Samples& samples, const Weights& weights) {
  const auto memberships = static_cast<std::size_t>(std::get<double>(problem.law_options.at("memberships")));
  try {
    const RuptureFit fit = train_rupture(in_cells(samples, weights), {.memberships = memberships});
    std::vector<double> values = fit.law.values();
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = std::clamp(values[i], problem.parameters[i].lower, problem.parameters[i].upper);
    }
    return {.values = Values(problem.runs, values),
            .converged = fit.converged,
            .iterations = static_cast<int>(fit.iterations),
            .message = fit.message};
  } catch (const std::invalid_argument& error) {
    return {.values = {}, .message = error.what()};
  }
}

}  // namespace kerf::fitting
