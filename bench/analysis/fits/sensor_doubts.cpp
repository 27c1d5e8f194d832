#include "fits/sensor_doubts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/core.h>

#include "fits/fit_series.h"
#include "inspect/clipping.h"
#include "inspect/drift.h"
#include "recordings/row_span.h"
#include "signal/blocked_values.h"

namespace kerf::bench {
namespace {

/// The values stay where they are.
BlockedValues seen(const std::vector<double>& values) {
  return {values.size(), [&values](std::uint64_t first, std::span<double> block) {
            std::ranges::copy(std::span(values).subspan(first, block.size()), block.begin());
          }};
}

std::vector<double> counted(const std::vector<double>& values, const AxisSeries& series) {
  if (series.counts.empty()) return values;
  std::vector<double> kept;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (series.counts[row] != 0) kept.push_back(values[row]);
  }
  return kept;
}

/// Spans of rows in which the tool is engaged by more than a share of the range of its penetration.
std::vector<RowSpan> engaged(const std::vector<double>& penetration) {
  constexpr double least_share = 0.02;
  const auto ends = std::ranges::minmax(penetration);
  const double border = ends.min + least_share * (ends.max - ends.min);
  std::vector<RowSpan> spans;
  for (std::size_t row = 0; row < penetration.size(); ++row) {
    if (!(penetration[row] > border)) continue;
    if (spans.empty() || spans.back().end != row) spans.push_back({.begin = row, .end = row});
    spans.back().end = row + 1;
  }
  return spans;
}

}  // namespace

std::string clipped_force(const AxisSeries& series, const fitting::FitOptions& settings) {
  const std::vector<double> force = counted(series.force, series);
  const std::vector<double> penetration = counted(series.penetration, series);
  const EndsOfRange ends = ends_of_force(seen(force), seen(penetration));
  for (const EndOfRange& end : {ends.most, ends.least}) {
    if (!end.is_clipped.value_or(false) || std::abs(end.value) <= settings.jnd.threshold) continue;
    return fmt::format(
        "the force stands at {:.4g} {} in {} rows, up to {} on end, while the tool moves on: its sensor is "
        "clipped, which no law gives back; leave such cycles out (--cycles), or measure with a wider range",
        end.value, settings.force_unit, end.rows, end.longest);
  }
  return "";
}

std::string drifting_force(const AxisSeries& series, const fitting::FitOptions& settings) {
  constexpr double beyond_scatter = 5.0;
  const std::vector<RowSpan> spans = engaged(series.penetration);
  const auto drift = drift_of(seen(series.time_s), seen(series.force), spans);
  if (!drift) return "";
  const double jnd = settings.jnd.at(fitting::rms_of(fitted_view(series)));
  if (!(std::abs(drift->over_all) > std::max(jnd, beyond_scatter * drift->scatter))) return "";
  return fmt::format(
      "where the tool was least engaged, the force went by {:.3g} {} from the first row to the last, along a "
      "straight line: a sensor that drifts does that, and no law of the motion; 'kerf prepare --bias "
      "--drift' "
      "takes it off where the tool is free",
      drift->over_all, settings.force_unit);
}

}  // namespace kerf::bench
