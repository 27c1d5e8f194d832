#include "samples.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace kerf::fitting {
namespace {

[[noreturn]] void refuse(const std::string& reason) { throw std::invalid_argument("cannot fit: " + reason); }

void check_finite(std::span<const double> values, const char* name) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    std::ostringstream reason;
    reason << "the " << name << " of sample " << i << " is not finite; leave such samples out";
    refuse(reason.str());
  }
}

std::vector<double> periods(std::span<const double> time_s, double& median_period_s) {
  std::vector<double> all(time_s.size(), 0.0);
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    all[i] = time_s[i] - time_s[i - 1];
    if (!(all[i] > 0.0)) refuse("the time does not increase at sample " + std::to_string(i));
  }
  all[0] = all[1];
  std::vector<double> sorted(all);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  median_period_s = *middle;
  // Uniform sampling up to rounding is uniform: laws keep what they derive from the period.
  for (double& period : all) {
    if (std::abs(period - median_period_s) < 1e-6 * median_period_s) period = median_period_s;
  }
  return all;
}

/// Folds by cycle where there are at least two; else blocks of time.
void assign_folds(Samples& samples, std::span<const std::uint32_t> cycle, std::size_t folds) {
  const std::uint32_t cycles = cycle.empty() ? 0 : *std::max_element(cycle.begin(), cycle.end());
  samples.has_cycles = cycles > 0;
  samples.fold.assign(samples.size(), Samples::no_fold);
  if (cycles >= 2) {
    samples.folds = std::min<std::size_t>(folds, cycles);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (cycle[i] > 0) samples.fold[i] = (cycle[i] - 1) % samples.folds;
    }
  } else {
    samples.folds = folds;
    for (std::size_t i = 0; i < samples.size(); ++i) samples.fold[i] = i * folds / samples.size();
  }
}

}  // namespace

Samples check_series(const Series& series, std::size_t folds) {
  const std::size_t count = series.force.size();
  if (series.time_s.size() != count || series.penetration.size() != count ||
      series.velocity.size() != count || (!series.cycle.empty() && series.cycle.size() != count)) {
    refuse("time, penetration, velocity, force and cycle differ in length");
  }
  if (count < 4) refuse("there are only " + std::to_string(count) + " samples");
  check_finite(series.time_s, "time");
  check_finite(series.penetration, "penetration");
  check_finite(series.velocity, "velocity");
  check_finite(series.force, "force");

  Samples samples;
  samples.force.assign(series.force.begin(), series.force.end());
  samples.period_s = periods(series.time_s, samples.median_period_s);
  samples.duration_s = series.time_s.back() - series.time_s.front();
  for (std::size_t i = 0; i < count; ++i) {
    samples.motion.push_back({.penetration = series.penetration[i], .velocity = series.velocity[i]});
  }
  const auto [least, most] = std::minmax_element(series.penetration.begin(), series.penetration.end());
  samples.least = *least;
  samples.most = *most;
  if (!(samples.most > samples.least))
    refuse("the position is constant, so no law over it can be told from another");
  assign_folds(samples, series.cycle, std::max<std::size_t>(folds, 2));
  return samples;
}

Mask all_of(const Samples& samples) { return Mask(samples.size(), true); }

Mask without_fold(const Samples& samples, std::size_t fold) {
  Mask mask(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) mask[i] = samples.fold[i] != fold;
  return mask;
}

std::vector<double> rendered(const models::Law& law, const Samples& samples) {
  std::vector<double> force;
  force.reserve(samples.size());
  models::Law::State state = law.initial_state();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    force.push_back(law.step(state, samples.motion[i], samples.period_s[i]).force);
  }
  return force;
}

}  // namespace kerf::fitting
