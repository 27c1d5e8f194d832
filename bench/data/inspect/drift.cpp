#include "inspect/drift.h"

#include <array>
#include <cmath>
#include <vector>

#include "signal/quantiles.h"
#include "signal/row_noise.h"

namespace kerf::bench {
namespace {

constexpr std::size_t windows = 16;
constexpr std::uint64_t fewest_in_window = 20;
constexpr std::size_t fewest_windows = 4;

struct Window {
  std::uint64_t rows = 0;
  double time = 0.0;  // sums
  double value = 0.0;
};

struct Point {
  double time_s;
  double value;
};

std::vector<Point> means_of(const BlockedValues& time_s, const BlockedValues& values,
                            std::span<const RowSpan> contacts) {
  const double first_s = time_s[0];
  const double span_s = time_s[time_s.size() - 1] - first_s;
  std::array<Window, windows> sums{};
  InSpans in_contact(contacts);
  for (std::uint64_t row = 0; row < values.size(); ++row) {
    const double share = (time_s[row] - first_s) / span_s;
    if (in_contact(row) || !std::isfinite(values[row]) || !(share >= 0.0 && share <= 1.0)) continue;
    Window& window = sums[std::min(windows - 1, static_cast<std::size_t>(share * windows))];
    ++window.rows;
    window.time += time_s[row];
    window.value += values[row];
  }
  std::vector<Point> means;
  for (const Window& window : sums) {
    const auto rows = static_cast<double>(window.rows);
    if (window.rows >= fewest_in_window) means.push_back({window.time / rows, window.value / rows});
  }
  return means;
}

}  // namespace

std::optional<Drift> drift_of(const BlockedValues& time_s, const BlockedValues& values,
                              std::span<const RowSpan> contacts) {
  if (values.size() < 2) return std::nullopt;
  const std::vector<Point> means = means_of(time_s, values, contacts);
  if (means.size() < fewest_windows) return std::nullopt;
  std::vector<double> levels, slopes, offsets, sizes;
  for (std::size_t i = 0; i < means.size(); ++i) {
    levels.push_back(means[i].value);
    for (std::size_t j = i + 1; j < means.size(); ++j)
      slopes.push_back((means[j].value - means[i].value) / (means[j].time_s - means[i].time_s));
  }
  Drift drift{.level = median(levels), .per_s = median(std::move(slopes)), .windows = means.size()};
  drift.over_all = drift.per_s * (time_s[time_s.size() - 1] - time_s[0]);
  for (const Point& mean : means) offsets.push_back(mean.value - drift.per_s * mean.time_s);
  const double offset = median(offsets);
  for (const double one : offsets) sizes.push_back(std::abs(one - offset));
  drift.scatter = deviation_of_mad * median(std::move(sizes));
  return drift;
}

}  // namespace kerf::bench
