#include "fits/contact_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr double gap_s = 0.5;
constexpr double margin_s = 0.1;
constexpr double deviations = 4.0;
constexpr double deviation_of_mad = 1.4826;
constexpr std::size_t fewest_rows = 20;

/// White noise from row to row where a force is felt, by second differences: their variance is six times its.
/// Elsewhere a sensor may stand still, and what was recorded beside the contact is not to decide.
double noise_of(const std::vector<double>& force, double felt_n) {
  std::vector<double> sizes;
  for (std::size_t i = 2; i < force.size(); ++i) {
    if (std::abs(force[i - 1]) > felt_n)
      sizes.push_back(std::abs(force[i] - 2.0 * force[i - 1] + force[i - 2]));
  }
  return sizes.empty() ? 0.0 : deviation_of_mad * quantile(std::move(sizes), 0.5) / std::sqrt(6.0);
}

}  // namespace

std::size_t mark_contact(AxisSeries& series, double felt_n) {
  const std::size_t rows = series.force.size();
  const double least = std::max(felt_n, deviations * noise_of(series.force, felt_n));
  constexpr double never = std::numeric_limits<double>::infinity();
  std::vector<double> next_s(rows, never);  // when a force is felt again
  for (std::size_t i = rows; i-- > 0;) {
    if (std::abs(series.force[i]) > least)
      next_s[i] = series.time_s[i];
    else if (i + 1 < rows)
      next_s[i] = next_s[i + 1];
  }
  series.counts.assign(rows, 0);
  std::size_t counted = 0;
  double last_s = -never;
  for (std::size_t i = 0; i < rows; ++i) {
    const double now_s = series.time_s[i];
    if (next_s[i] == now_s) last_s = now_s;
    const bool close = now_s - last_s <= margin_s || next_s[i] - now_s <= margin_s;
    series.counts[i] = close || next_s[i] - last_s <= gap_s ? 1 : 0;
    counted += series.counts[i];
  }
  if (counted >= fewest_rows && counted < rows) return counted;
  series.counts.clear();
  return rows;
}

}  // namespace kerf::bench
