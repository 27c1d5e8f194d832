#include "ruptures/drops.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace kerf::fitting {
namespace {

constexpr double drop_share = 0.5;
constexpr double drop_time_s = 0.02;
constexpr double least_peak_share = 0.1;  ///< of the largest force: what is less is noise
constexpr double beyond_noise = 5.0;      ///< standard deviations, of a mean drop
constexpr double beyond_at_once = 4.0;    ///< likewise, of one from a row to the next

std::size_t rows_of_a_drop(const Samples& samples) {
  return static_cast<std::size_t>(std::max(1.0, std::round(drop_time_s / samples.median_period_s)));
}

/// By how much the force is less in the 20 ms from a row on than in those before it, on average.
/// Of its recording alone, whose first and last rows stand for those beyond it.
double mean_drop(const Samples& samples, std::size_t row) {
  const std::size_t many = rows_of_a_drop(samples);
  const auto own = std::ranges::find_if(samples.runs, [&](const Run& run) { return row < run.end; });
  const auto [first, end] = own == samples.runs.end() ? std::pair<std::size_t, std::size_t>(0, samples.size())
                                                      : std::pair(own->begin, own->end);
  double before = 0.0;
  double after = 0.0;
  for (std::size_t k = 0; k < many; ++k) {
    before += samples.force[row - std::min(row - first, k + 1)];
    after += samples.force[std::min(row + k, end - 1)];
  }
  return (before - after) / static_cast<double>(many);
}

}  // namespace

double drop_at(const Samples& samples, std::size_t row) {
  const double at_once = row > 0 ? samples.force[row - 1] - samples.force[row] : 0.0;
  return std::max(at_once, mean_drop(samples, row));
}

RuptureRows drops_of(const Samples& samples, const Weights& weights) {
  const double largest = *std::ranges::max_element(samples.force);
  const double noise = noise_of_rows(samples, weights);
  const double least_peak = std::max(least_peak_share * largest, beyond_noise * noise);
  const std::size_t ahead = rows_of_a_drop(samples);
  const double least_drop = beyond_noise * noise * std::sqrt(2.0 / static_cast<double>(ahead));
  const double least_at_once = beyond_at_once * noise * std::sqrt(2.0);
  const std::vector<double>& force = samples.force;
  const auto at_once = [&](std::size_t j) {
    return force[j - 1] - force[j] >= std::max(drop_share * force[j - 1], least_at_once) &&
           force[j - 1] >= least_peak;
  };
  RuptureRows rows;
  for (const Run& run : samples.runs) {
    for (std::size_t i = run.begin; i + 1 < run.end; ++i) {
      const double peak = force[i];
      if (!(weights[i] > 0.0) || peak < least_peak || !(samples.motion[i].velocity > 0.0)) continue;
      const std::size_t last = std::min(i + ahead, run.end - 1);
      std::size_t low = i;
      std::size_t row = i + 1;
      bool falls_at_once = false;
      for (std::size_t j = i + 1; j <= last && !falls_at_once; ++j) {
        if (force[j] < force[low]) low = j;
        falls_at_once = at_once(j);
        if (falls_at_once || force[j - 1] - force[j] > force[row - 1] - force[row]) row = j;
      }
      if (falls_at_once) low = row;
      if (force[low] > (1.0 - drop_share) * peak || !(weights[row] > 0.0)) continue;
      if (!falls_at_once && mean_drop(samples, row) < least_drop) continue;
      rows.push_back(row);
      i = std::max(row, low);
    }
  }
  return rows;
}

}  // namespace kerf::fitting
