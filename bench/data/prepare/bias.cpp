#include "prepare/bias.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr std::size_t fewest_idle_rows = 10;

/// The straight line (or the mean) through one axis' free rows.
struct Line {
  double offset = 0.0;
  double slope = 0.0;
  double offset_error = 0.0;
  double slope_error = 0.0;
  double noise = 0.0;
  double correlation_rows = 1.0;
};

Line fit_line(const std::vector<double>& t, const std::vector<double>& f, bool sloped) {
  const auto count = static_cast<double>(t.size());
  double mean_t = 0.0;
  double mean_f = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    mean_t += t[i] / count;
    mean_f += f[i] / count;
  }
  double tt = 0.0;
  double tf = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    tt += (t[i] - mean_t) * (t[i] - mean_t);
    tf += (t[i] - mean_t) * (f[i] - mean_f);
  }
  Line line;
  line.slope = sloped ? tf / tt : 0.0;
  line.offset = mean_f - line.slope * mean_t;
  std::vector<double> residuals;
  double squares = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    residuals.push_back(f[i] - line.offset - line.slope * t[i]);
    squares += residuals.back() * residuals.back();
  }
  const double variance = squares / std::max(count - (sloped ? 2.0 : 1.0), 1.0);
  line.correlation_rows = rows_that_count_as_one(residuals);
  line.noise = std::sqrt(variance);
  line.slope_error = sloped ? std::sqrt(line.correlation_rows * variance / tt) : 0.0;
  line.offset_error =
      std::sqrt(line.correlation_rows * variance * (1.0 / count + (sloped ? mean_t * mean_t / tt : 0.0)));
  return line;
}

void check(const schema::Recording& recording, const std::vector<bool>& free, bool drift) {
  if (recording.force_measured.empty()) {
    throw std::invalid_argument("the recording holds no measured force to take a bias off");
  }
  const double begin_s = recording.time.front();
  const double quarter_s = 0.25 * (recording.time.back() - begin_s);
  std::size_t all = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t row = 0; row < free.size(); ++row) {
    if (!free[row]) continue;
    ++all;
    first += recording.time[row] <= begin_s + quarter_s ? 1 : 0;
    last += recording.time[row] >= recording.time.back() - quarter_s ? 1 : 0;
  }
  if (all < fewest_idle_rows) {
    throw std::invalid_argument(fmt::format(
        "--bias: {} rows are free of contact, {} are needed; --free A:B says when nothing is touched", all,
        fewest_idle_rows));
  }
  if (drift && (first < fewest_idle_rows || last < fewest_idle_rows)) {
    throw std::invalid_argument(fmt::format(
        "--drift: {} rows in the first quarter of the time were found to be free, and {} in the last; {} are "
        "needed in each. What drifts fast looks like a contact: say when nothing is touched (--free "
        "A:B,C:D), or "
        "record some time without contact at both ends",
        first, last, fewest_idle_rows));
  }
}

}  // namespace

double rows_that_count_as_one(const std::vector<double>& residuals) {
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    squares += residuals[i] * residuals[i];
    if (i > 0) products += residuals[i] * residuals[i - 1];
  }
  const double r = squares > 0.0 ? std::clamp(products / squares, 0.0, 0.999999) : 0.0;
  return (1.0 + r) / (1.0 - r);
}

Bias remove_bias(schema::Recording& recording, const std::vector<bool>& free, bool drift) {
  check(recording, free, drift);
  const std::size_t axes = recording.dimensions();
  const double begin_s = recording.time.front();
  Bias bias;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    std::vector<double> t;
    std::vector<double> f;
    for (std::size_t row = 0; row < free.size(); ++row) {
      const double force = recording.force_measured[row * axes + axis];
      if (!free[row] || !std::isfinite(force)) continue;
      t.push_back(recording.time[row] - begin_s);
      f.push_back(force);
    }
    if (t.size() < fewest_idle_rows) continue;
    const Line line = fit_line(t, f, drift);
    for (std::size_t row = 0; row < free.size(); ++row) {
      recording.force_measured[row * axes + axis] -=
          line.offset + line.slope * (recording.time[row] - begin_s);
    }
    bias.rows = std::max(bias.rows, t.size());
    bias.axes.push_back({.axis = recording.axes[axis].name,
                         .unit = recording.axes[axis].force_unit,
                         .offset = line.offset,
                         .offset_error = line.offset_error,
                         .drift_per_minute = 60.0 * line.slope,
                         .drift_per_minute_error = 60.0 * line.slope_error,
                         .noise = line.noise,
                         .correlation_rows = line.correlation_rows});
  }
  if (bias.axes.empty())
    throw std::invalid_argument("--bias: no axis has ten finite forces among its free rows");
  return bias;
}

}  // namespace kerf::bench
