#include "results/residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>

#include "fits/fit_series.h"
#include "fits/judged_rows.h"
#include "laws/render.h"
#include "recordings/axis_series.h"
#include "results/error_places.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_bins = 60;
constexpr std::size_t fewest_in_bin = 5;

/// Bins of penetration, none with hardly any row: an encoder may have fewer steps than there are bins.
class Bins {
 public:
  explicit Bins(const AxisSeries& series) {
    std::vector<double> penetration;  // of the rows that the law is judged by
    for (std::size_t row = 0; row < series.penetration.size(); ++row)
      if (is_judged(series, row)) penetration.push_back(series.penetration[row]);
    const auto [least, most] = std::minmax_element(penetration.begin(), penetration.end());
    const double width = std::max(1e-12, (*most - *least) / static_cast<double>(most_bins));
    std::array<std::size_t, most_bins> rows{};
    for (const double at : penetration) ++rows[equal_bin(at, *least, width)];
    std::array<std::size_t, most_bins> merged{};
    std::size_t in_bin = 0;
    std::size_t left = penetration.size();
    for (std::size_t bin = 0; bin < most_bins; ++bin) {
      merged[bin] = count_;
      in_bin += rows[bin];
      left -= rows[bin];
      if (in_bin < fewest_in_bin || left < fewest_in_bin) continue;
      ++count_;
      in_bin = 0;
    }
    ++count_;
    of_row_.reserve(series.penetration.size());
    for (const double at : series.penetration) of_row_.push_back(merged[equal_bin(at, *least, width)]);
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t of(std::size_t row) const { return of_row_[row]; }

 private:
  static std::size_t equal_bin(double at, double least, double width) {
    return std::min(most_bins - 1, static_cast<std::size_t>(std::max(0.0, (at - least) / width)));
  }

  std::size_t count_ = 0;
  std::vector<std::size_t> of_row_;
};

/// Numbers that fell into bins.
class Binned {
 public:
  explicit Binned(std::size_t bins) : count_(bins), sum_(bins), squares_(bins) {}
  void add(std::size_t bin, double value) {
    ++count_[bin];
    sum_[bin] += value;
    squares_[bin] += value * value;
  }
  /// Mean and so many standard deviations above it; null where there are fewer rows than that.
  [[nodiscard]] Json means(double deviations = 0.0, std::size_t fewest = fewest_in_bin) const {
    Json list = Json::array();
    for (std::size_t bin = 0; bin < count_.size(); ++bin) {
      if (count_[bin] < fewest) {
        list.push_back(nullptr);
        continue;
      }
      const auto count = static_cast<double>(count_[bin]);
      const double mean = sum_[bin] / count;
      const double variance = std::max(0.0, squares_[bin] / count - mean * mean);
      list.push_back(mean + deviations * std::sqrt(variance));
    }
    return list;
  }

 private:
  std::vector<std::size_t> count_;
  std::vector<double> sum_;
  std::vector<double> squares_;
};

void check_units(const LawFile& law, const schema::Axis& axis) {
  if (law.law.is_spatial())
    throw std::invalid_argument(fmt::format(
        "law '{}' acts on several axes at once; residuals are of laws along one axis", law.law.model()));
  if (law.position_unit == axis.position_unit && law.force_unit == axis.force_unit) return;
  throw std::invalid_argument(fmt::format("the law has {} over {}, and axis '{}' of the recording {} over {}",
                                          law.force_unit, law.position_unit, axis.name, axis.force_unit,
                                          axis.position_unit));
}

/// Smallest and largest of a stretch of rows, in columns; null in one without such a row.
struct ColumnExtremes {
  Json smallest = Json::array();
  Json largest = Json::array();

  /// Of the rows that the law is judged by, or of the others.
  void add(const std::vector<double>& values, const AxisSeries& series, std::size_t begin, std::size_t end,
           bool judged = true) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::size_t row = begin; row < end; ++row) {
      if (is_judged(series, row) != judged) continue;
      least = std::min(least, values[row]);
      most = std::max(most, values[row]);
    }
    const bool none = least > most;
    smallest.push_back(none ? Json(nullptr) : Json(least));
    largest.push_back(none ? Json(nullptr) : Json(most));
  }
};

void add_over_time(const AxisSeries& series, const std::vector<double>& force,
                   const std::vector<double>& residual, std::size_t columns, Json& to) {
  const std::size_t rows = residual.size();
  const std::size_t count = std::clamp<std::size_t>(columns, 1, rows);
  Json time_s = Json::array();
  ColumnExtremes left;
  ColumnExtremes measured;
  ColumnExtremes not_judged;
  ColumnExtremes by_law;
  for (std::size_t column = 0; column < count; ++column) {
    const std::size_t begin = column * rows / count;
    const std::size_t end = (column + 1) * rows / count;
    time_s.push_back(series.time_s[begin]);
    left.add(residual, series, begin, end);
    measured.add(series.force, series, begin, end);
    not_judged.add(series.force, series, begin, end, false);
    by_law.add(force, series, begin, end);
  }
  to["time_s"] = std::move(time_s);
  to["smallest"] = std::move(left.smallest);
  to["largest"] = std::move(left.largest);
  to["over_time"] = {{"measured_smallest", std::move(measured.smallest)},
                     {"measured_largest", std::move(measured.largest)},
                     {"not_judged_smallest", std::move(not_judged.smallest)},
                     {"not_judged_largest", std::move(not_judged.largest)},
                     {"law_smallest", std::move(by_law.smallest)},
                     {"law_largest", std::move(by_law.largest)}};
}

/// Of each row, closing and opening apart.
std::size_t branch_of(const AxisSeries& series, std::size_t row) {
  return series.velocity[row] >= 0.0 ? 0 : 1;
}

void add_over_penetration(const AxisSeries& series, const Bins& bins, const std::vector<double>& force,
                          Json& to) {
  Binned penetration(bins.count());
  Binned residual(bins.count());
  std::array<Binned, 2> measured{Binned(bins.count()), Binned(bins.count())};  // closing, opening
  std::array<Binned, 2> by_law = measured;
  for (std::size_t row = 0; row < force.size(); ++row) {
    if (!is_judged(series, row)) continue;
    const std::size_t bin = bins.of(row);
    const std::size_t branch = branch_of(series, row);
    penetration.add(bin, series.penetration[row]);
    residual.add(bin, series.force[row] - force[row]);
    measured[branch].add(bin, series.force[row]);
    by_law[branch].add(bin, force[row]);
  }
  to["penetration"] = penetration.means(0.0, 1);
  to["mean"] = residual.means(0.0, 1);
  to["low"] = residual.means(-1.0, 1);
  to["high"] = residual.means(1.0, 1);
  to["loop"] = {{"measured_closing", measured[0].means()},
                {"measured_opening", measured[1].means()},
                {"law_closing", by_law[0].means()},
                {"law_opening", by_law[1].means()}};
}

void add_interval(const AxisSeries& series, const Bins& bins, const models::Law& law,
                  const FitUncertainty& known, Json& to) {
  const std::vector<double> half = force_interval(law, series, known);
  if (half.empty()) return;
  std::array<Binned, 2> wide{Binned(bins.count()), Binned(bins.count())};
  for (std::size_t row = 0; row < half.size(); ++row)
    if (is_judged(series, row)) wide[branch_of(series, row)].add(bins.of(row), half[row]);
  to["interval"] = {
      {"confidence", known.confidence}, {"closing", wide[0].means()}, {"opening", wide[1].means()}};
}

}  // namespace

Json residuals_of(const schema::Recording& recording, std::size_t axis, const LawFile& law,
                  std::size_t columns, const std::optional<FitUncertainty>& known, const Json& fits) {
  const schema::Axis& about = recording.axes.at(axis);
  check_units(law, about);
  AxisSeries series = fit_series(recording, axis, law.contact);
  if (series.force.empty()) throw std::invalid_argument("the recording has no row that is finite");
  const fitting::Jnd jnd = fitting::jnd_of(about.force_unit, about.lever);
  const std::size_t counted = mark_judged(series, recording, axis, fits).rows;
  const models::Law fitted = without_rendering_aids(law.law);
  const std::vector<double> force = render(fitted, series);
  std::vector<double> residual;
  double squares = 0.0;
  double worst = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    residual.push_back(series.force[i] - force[i]);
    if (!is_judged(series, i)) continue;
    squares += residual.back() * residual.back();
    worst = std::max(worst, std::abs(residual.back()));
  }
  Json result{{"axis", about.name},
              {"position_unit", about.position_unit},
              {"force_unit", about.force_unit},
              {"rows", counted},
              {"rmse", std::sqrt(squares / static_cast<double>(counted))},
              {"worst", worst},
              {"jnd_n", jnd.at(fitting::rms_of(fitted_view(series)))}};
  const Bins bins(series);
  add_over_time(series, force, residual, columns, result);
  add_over_penetration(series, bins, force, result);
  result["places"] = error_places(recording, axis, series, residual);
  if (known) add_interval(series, bins, fitted, *known, result);
  return result;
}

}  // namespace kerf::bench
