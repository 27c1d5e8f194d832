#include "starts/fracture_fit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include <kerf/models/exponential.h>
#include <kerf/models/fracture.h>

#include "starts/scan.h"

namespace kerf::fitting {
namespace {

constexpr int depths = 16;              ///< at which tissue may have yielded, on the first grid
constexpr int refinements = 14;         ///< of that depth, by golden section
constexpr double blade_width_m = 0.01;  ///< held: forces tell only its product with the toughness
constexpr double drop_share = 0.5;
constexpr double drop_time_s = 0.02;
constexpr double least_peak_share = 0.1;  ///< of the largest force: what is less is noise

double squares_of(const Problem& problem, const Samples& samples, const Weights& weights,
                  const std::vector<double>& values, const RobustLoss& loss) {
  const auto force = rendered(problem, Values(problem.runs, values), samples);
  double squares = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    squares += loss(weights[i] * (force[i] - samples.force[i]) * (force[i] - samples.force[i])).rho;
  }
  return squares;
}

/// The samples before each run first comes to a depth: there the tissue is whole.
Weights before_depth(const Samples& samples, const Weights& weights, double depth) {
  Weights whole(weights);
  for (const Run& run : samples.runs) {
    bool broken = false;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      broken = broken || samples.motion[i].penetration > depth;
      if (broken) whole[i] = 0.0;
    }
  }
  return whole;
}

double force_of_cutting(const Samples& samples, const Weights& weights, double depth) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.motion[i].penetration <= depth || !(samples.motion[i].velocity > 0.0)) continue;
    sum += weights[i] * samples.force[i];
    count += weights[i];
  }
  return count > 0.0 ? std::max(sum / count, 1e-9) : 1e-9;
}

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

/// The fracture law that goes best with one depth of yielding.
class FractureSearch {
 public:
  FractureSearch(const Problem& problem, const RobustLoss& loss) : problem_(problem), loss_(loss) {
    const auto given = problem.law_options.find("thickness");
    if (given != problem.law_options.end()) thickness_ = std::get<double>(given->second);
    whole_.law_options = {{"thickness", thickness_}, {"viscous", false}};
    whole_.parameters = models::Law::parameters(whole_.model, whole_.law_options);
    whole_.free.assign(whole_.parameters.size(), true);
    whole_.own.assign(whole_.parameters.size(), false);
    whole_.runs = problem.runs;
  }

  [[nodiscard]] std::vector<double> values(const Samples& samples, const Weights& weights, double depth) {
    const Solution elastic = search(whole_, samples, before_depth(samples, weights, depth), {},
                                    {.loss = loss_, .function_tolerance = 1e-10});
    ++iterations_;
    if (elastic.values.empty()) return {};
    const double amplitude = elastic.values[0][0];
    const double exponent = elastic.values[0][1];
    const models::Exponential<double> tissue{
        .amplitude = amplitude, .exponent = exponent, .thickness = thickness_};
    const double energy = tissue.stored_energy(depth);
    std::vector<double> all{amplitude, exponent, energy,
                            force_of_cutting(samples, weights, depth) / blade_width_m, blade_width_m};
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = std::clamp(all[i], problem_.parameters[i].lower, problem_.parameters[i].upper);
    }
    return all;
  }
  [[nodiscard]] double squares(const Samples& samples, const Weights& weights, double depth) {
    const auto all = values(samples, weights, depth);
    return all.empty() ? std::numeric_limits<double>::infinity()
                       : squares_of(problem_, samples, weights, all, loss_);
  }
  [[nodiscard]] double yield_depth(const std::vector<double>& all) const {
    return models::Fracture<double>::make(all, problem_.law_options).yield_depth();
  }
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  const Problem& problem_;
  const RobustLoss& loss_;
  Problem whole_{.model = "exponential"};
  double thickness_ = 0.1;
  int iterations_ = 0;
};

}  // namespace

Solution solve_fracture(const Problem& problem, const Samples& samples, const Weights& weights,
                        const Values& near, const RobustLoss& loss) {
  if (!(samples.most > 0.0)) return {.values = {}, .message = "the tool never met the tissue"};
  FractureSearch search(problem, loss);
  const Samples few = thinned(samples, 1000);
  const Weights light = thinned_weights(samples, weights, few);
  const double step = samples.most / (depths + 1);
  double at = near.empty() ? 2.0 * step : search.yield_depth(near[0]);
  if (near.empty()) {
    double least = search.squares(few, light, at);
    for (int i = 3; i <= depths; ++i) {
      const double squares = search.squares(few, light, i * step);
      if (squares < least) {
        least = squares;
        at = i * step;
      }
    }
  }
  constexpr double golden = 0.6180339887498949;
  double low = at - step;
  double high = at + step;
  double a = high - golden * (high - low);
  double b = low + golden * (high - low);
  double at_a = search.squares(few, light, a);
  double at_b = search.squares(few, light, b);
  for (int i = 0; i < refinements; ++i) {
    if (at_a <= at_b) {  // between two samples all depths are alike: the least of them is before the break
      high = b;
      b = std::exchange(a, b - golden * (b - low));
      at_b = std::exchange(at_a, search.squares(few, light, a));
    } else {
      low = a;
      a = std::exchange(b, a + golden * (high - a));
      at_a = std::exchange(at_b, search.squares(few, light, b));
    }
  }
  const auto best = search.values(samples, weights, at_a <= at_b ? a : b);
  if (best.empty()) return {.values = {}, .message = "too few samples before the tissue yields"};
  return {.values = Values(problem.runs, best),
          .converged = true,
          .iterations = search.iterations(),
          .message = "least squares over the depth of yielding"};
}

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
