#include "fits/row_doubts.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "fits/fit_series.h"

namespace kerf::bench {
namespace {

/// A force that does not change by what a hand feels tells no law from a constant.
std::string nothing_changes(const AxisSeries& series, const fitting::FitOptions& settings) {
  const auto [least, most] = std::ranges::minmax_element(series.force);
  if (*least == *most) return "";  // which no fit takes
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < series.force.size(); ++i) {
    if (!series.counts.empty() && series.counts[i] == 0) continue;
    sum += series.force[i];
    squares += series.force[i] * series.force[i];
    count += 1.0;
  }
  const double mean = sum / count;
  const double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
  const double jnd = settings.jnd.at(std::sqrt(squares / count));
  if (!(deviation <= jnd)) return "";
  const std::string& unit = settings.force_unit;
  return fmt::format(
      "a force of {:.3g} {} that never changes is within the JND of {:.3g} {} too: the recording does not "
      "say "
      "how the force depends on the motion",
      mean, unit, jnd, unit);
}

/// By time, since rows that are not finite are no part of a series. Returns how many are left.
std::size_t leave_out_rows(const schema::Recording& recording, const std::vector<RowSpan>& spans,
                           AxisSeries& series) {
  series.counts.resize(series.force.size(), 1);
  auto row = series.time_s.begin();
  for (const RowSpan& span : spans) {
    row = std::lower_bound(row, series.time_s.end(), recording.time.at(span.begin));
    for (; row != series.time_s.end() && *row <= recording.time.at(span.end - 1); ++row)
      series.counts[static_cast<std::size_t>(row - series.time_s.begin())] = 0;
  }
  return static_cast<std::size_t>(std::ranges::count(series.counts, 1));
}

}  // namespace

CountedRows mark_rows(const FitSource& source, const RowChoice& choice, double felt, AxisSeries& series) {
  CountedRows counted = mark_counted(series, *source.recording, source.axis, choice, felt);
  if (source.not_the_tissue.empty()) return counted;
  counted.rows = leave_out_rows(*source.recording, source.not_the_tissue, series);
  if (counted.rows < fewest_counted)
    throw std::invalid_argument(
        fmt::format("in {} rows it is in contact where its blank has been, and {} are needed", counted.rows,
                    fewest_counted));
  return counted;
}

CountedSeries counted_series(const FitSource& source, const RowChoice& choice, const fitting::Jnd& jnd) {
  CountedSeries made{.series = fit_series(*source.recording, source.axis, source.contact), .counted = {}};
  if (made.series.force.empty()) throw std::invalid_argument("the recording has no row that is finite");
  made.counted = mark_rows(source, choice, jnd.threshold, made.series);
  return made;
}

std::string nothing_felt(const AxisSeries& series, const fitting::FitOptions& settings) {
  const double felt = fitting::rms_of(fitted_view(series));
  const double jnd = settings.jnd.at(felt);
  if (felt > jnd) return "";
  const std::string& unit = settings.force_unit;
  return fmt::format(
      "no force at all is within the JND of {:.3g} {} too, at a root mean square force of {:.3g} {}: what is "
      "fitted to it is noise",
      jnd, unit, felt, unit);
}

std::vector<std::string> doubts_of(const AxisSeries& series, const fitting::FitOptions& settings) {
  if (series.force.empty()) return {};
  std::vector<std::string> doubts;
  std::string of_the_force = nothing_felt(series, settings);
  if (of_the_force.empty()) of_the_force = nothing_changes(series, settings);
  if (!of_the_force.empty()) doubts.push_back(std::move(of_the_force));
  if (settings.folds >= 2 && !series.cycle.empty() && *std::ranges::max_element(series.cycle) == 1) {
    doubts.emplace_back(
        "there is only one cycle: errors are held out by blocks of time within it, and say nothing of the "
        "next");
  }
  return doubts;
}

std::string rows_left_out(const AxisSeries& series) {
  if (series.left_out == 0) return "";
  return fmt::format("{} rows are not finite and are left out", series.left_out);
}

}  // namespace kerf::bench
