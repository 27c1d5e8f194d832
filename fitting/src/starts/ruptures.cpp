#include "starts/ruptures.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kerf::fitting {
namespace {

constexpr double drop_share = 0.5;
constexpr double drop_time_s = 0.02;
constexpr double least_peak_share = 0.1;  ///< of the largest force: what is less is noise

/// Where the force falls by more than half of it within 20 ms while the tool goes on: row of each peak.
std::vector<std::size_t> ruptures_in(const Samples& samples, const Run& run, double least_peak) {
  std::vector<std::size_t> peaks;
  const auto ahead =
      static_cast<std::size_t>(std::max(1.0, std::round(drop_time_s / samples.median_period_s)));
  for (std::size_t i = run.begin; i + 1 < run.end; ++i) {
    const double peak = samples.force[i];
    if (peak < least_peak || samples.force[i + 1] >= peak || !(samples.motion[i].velocity > 0.0)) continue;
    const std::size_t last = std::min(i + ahead, run.end - 1);
    const auto low = std::min_element(samples.force.begin() + static_cast<std::ptrdiff_t>(i),
                                      samples.force.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    if (*low > (1.0 - drop_share) * peak) continue;
    peaks.push_back(i);
    i = static_cast<std::size_t>(low - samples.force.begin());
  }
  return peaks;
}

/// The samples cut at the ruptures: each part is a run that begins with relaxed tissue at zero penetration.
Samples between_ruptures(const Samples& samples, const std::vector<std::size_t>& peaks) {
  Samples parts(samples);
  parts.runs.clear();
  std::vector<std::size_t> borders;
  for (const Run& run : samples.runs) borders.push_back(run.begin);
  for (const std::size_t peak : peaks) borders.push_back(peak + 1);
  std::sort(borders.begin(), borders.end());
  borders.push_back(samples.size());
  for (std::size_t k = 0; k + 1 < borders.size(); ++k) {
    if (borders[k + 1] == borders[k]) continue;
    parts.runs.push_back({.begin = borders[k], .end = borders[k + 1], .noise_n = 0.0});
    const bool after_rupture = std::find(peaks.begin(), peaks.end(), borders[k] - 1) != peaks.end();
    const double reference = after_rupture ? samples.motion[borders[k]].penetration : 0.0;
    for (std::size_t i = borders[k]; i < borders[k + 1]; ++i) parts.motion[i].penetration -= reference;
  }
  return parts;
}

/// Force over speed at the ruptures: slope and intercept, or the mean where all are alike.
std::pair<double, double> threshold_line(const Samples& samples, const std::vector<std::size_t>& peaks) {
  double n = 0.0, s = 0.0, ss = 0.0, f = 0.0, sf = 0.0;
  for (const std::size_t i : peaks) {
    const double speed = std::abs(samples.motion[i].velocity);
    n += 1.0;
    s += speed;
    ss += speed * speed;
    f += samples.force[i];
    sf += speed * samples.force[i];
  }
  const double spread = ss - s * s / n;
  const double slope = n > 2.0 && spread > 1e-4 * ss ? (sf - s * f / n) / spread : 0.0;
  return {slope, (f - slope * s) / n};
}

}  // namespace

Solution solve_ruptures(const Problem& problem, const Samples& samples, const Weights& weights) {
  const double largest = *std::max_element(samples.force.begin(), samples.force.end());
  std::vector<std::size_t> peaks;
  for (const Run& run : samples.runs) {
    const auto more = ruptures_in(samples, run, least_peak_share * largest);
    peaks.insert(peaks.end(), more.begin(), more.end());
  }
  std::erase_if(peaks, [&](std::size_t i) { return !(weights[i] > 0.0); });
  if (peaks.size() < 2)
    return {.values = {}, .message = "the force never drops as it does where tissue ruptures"};
  const Samples parts = between_ruptures(samples, peaks);
  Problem element{.model = "kelvin", .runs = parts.runs.size()};
  element.parameters = models::Law::parameters("kelvin");
  element.free.assign(3, true);
  element.own.assign(3, false);
  Solution solution = search(element, parts, weights, {});
  if (solution.values.empty()) return solution;
  std::vector<double> values = solution.values[0];
  const auto [slope, constant] = threshold_line(samples, peaks);
  for (std::size_t i = values.size(); i < problem.parameters.size(); ++i) {
    const std::string& name = problem.parameters[i].name;
    values.push_back(name.starts_with("per_speed")                                            ? slope
                     : name.starts_with("constant")                                           ? constant
                     : name.ends_with("width[0]") || name.find("_width") != std::string::npos ? 1.0
                                                                                              : 0.0);
  }
  solution.values = Values(problem.runs, values);
  return solution;
}

}  // namespace kerf::fitting
