#include "recordings/contact_rows.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "signal/quantiles.h"
#include "signal/row_noise.h"
#include "signal/streamed_median.h"

namespace kerf::bench {
namespace {

constexpr double gap_s = 0.5;
constexpr double margin_s = 0.1;
constexpr double deviations = 4.0;
constexpr std::size_t fewest_in_contact = 20;

/// The size from which a force is felt. Noise is taken where a force is felt already: elsewhere a sensor may
/// stand still, and what was recorded beside the contact is not to decide.
template <typename Forces, typename Median>
double least_felt(const Forces& force, double felt_n, const Median& median_of) {
  const auto each = [&](const auto& look) {
    each_second_difference(
        force, [&](std::size_t row) { return std::abs(force[row]) > felt_n; }, look);
  };
  const double median = median_of(each);
  return std::isnan(median) ? felt_n : std::max(felt_n, deviations * noise_of_second_differences(median));
}

template <typename Times, typename Forces>
ContactRows spans_of(const Times& time_s, const Forces& force, double least) {
  ContactRows found{.least = least, .spans = {}};
  auto& spans = found.spans;
  double last_s = 0.0;  // when a force was felt last
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (std::abs(force[i]) > least) {
      if (spans.empty() || !(time_s[i] - last_s <= gap_s)) {
        std::size_t begin = i;
        const std::size_t first = spans.empty() ? 0 : spans.back().end;
        while (begin > first && time_s[i] - time_s[begin - 1] <= margin_s) --begin;
        spans.push_back({.begin = begin, .end = i});
      }
      spans.back().end = i + 1;
      last_s = time_s[i];
    } else if (!spans.empty() && spans.back().end == i && time_s[i] - last_s <= margin_s) {
      spans.back().end = i + 1;
    }
  }
  for (const RowSpan& span : spans) found.rows += span.end - span.begin;
  return found;
}

}  // namespace

ContactRows contact_rows(const BlockedValues& time_s, const BlockedValues& force, double felt_n) {
  const auto median = [](const auto& each) { return StreamedMedian::of(each); };
  return spans_of(time_s, force, least_felt(force, felt_n, median));
}

std::size_t mark_contact(AxisSeries& series, double felt_n) {
  const auto median = [](const auto& each) {
    std::vector<double> sizes;
    each([&](double size) { sizes.push_back(size); });
    return quantile(std::move(sizes), 0.5);
  };
  const std::size_t rows = series.force.size();
  const ContactRows found = spans_of(series.time_s, series.force, least_felt(series.force, felt_n, median));
  series.counts.clear();
  if (found.rows < fewest_in_contact || found.rows == rows) return rows;
  series.counts.assign(rows, 0);
  for (const RowSpan& span : found.spans) {
    std::fill(series.counts.begin() + static_cast<std::ptrdiff_t>(span.begin),
              series.counts.begin() + static_cast<std::ptrdiff_t>(span.end), 1);
  }
  return found.rows;
}

}  // namespace kerf::bench
