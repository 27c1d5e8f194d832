#include "results/residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>

#include "fits/fit_series.h"
#include "inspect/counted_rows.h"
#include "laws/render.h"
#include "recordings/axis_series.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t bins = 60;
constexpr std::size_t fewest_in_bin = 5;

/// Numbers that fell into bins of penetration.
class Binned {
 public:
  void add(std::size_t bin, double value) {
    ++count_[bin];
    sum_[bin] += value;
    squares_[bin] += value * value;
  }
  /// Mean and so many standard deviations above it; null where there are few.
  [[nodiscard]] Json means(double deviations = 0.0) const {
    Json list = Json::array();
    for (std::size_t bin = 0; bin < bins; ++bin) {
      if (count_[bin] < fewest_in_bin) {
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
  std::array<std::size_t, bins> count_{};
  std::array<double, bins> sum_{};
  std::array<double, bins> squares_{};
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

void add_over_time(const AxisSeries& series, const std::vector<double>& residual, std::size_t columns,
                   Json& to) {
  const std::size_t rows = residual.size();
  const std::size_t count = std::clamp<std::size_t>(columns, 1, rows);
  std::array<Json, 3> lists{Json::array(), Json::array(), Json::array()};
  for (std::size_t column = 0; column < count; ++column) {
    const auto begin = static_cast<std::ptrdiff_t>(column * rows / count);
    const auto end = static_cast<std::ptrdiff_t>((column + 1) * rows / count);
    const auto [least, most] = std::minmax_element(residual.begin() + begin, residual.begin() + end);
    lists[0].push_back(series.time_s[static_cast<std::size_t>(begin)]);
    lists[1].push_back(*least);
    lists[2].push_back(*most);
  }
  to["time_s"] = std::move(lists[0]);
  to["smallest"] = std::move(lists[1]);
  to["largest"] = std::move(lists[2]);
}

void add_over_penetration(const AxisSeries& series, const std::vector<double>& force, Json& to) {
  const auto [least, most] = std::minmax_element(series.penetration.begin(), series.penetration.end());
  const double first = *least;
  const double width = std::max(1e-12, (*most - first) / static_cast<double>(bins));
  Binned residual;
  std::array<Binned, 2> measured;  // closing, opening
  std::array<Binned, 2> by_law;
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double place = (series.penetration[i] - first) / width;
    const std::size_t bin = std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, place)));
    const std::size_t branch = series.velocity[i] >= 0.0 ? 0 : 1;
    residual.add(bin, force[i] - series.force[i]);
    measured[branch].add(bin, series.force[i]);
    by_law[branch].add(bin, force[i]);
  }
  Json penetration = Json::array();
  for (std::size_t bin = 0; bin < bins; ++bin)
    penetration.push_back(first + width * (static_cast<double>(bin) + 0.5));
  to["penetration"] = std::move(penetration);
  to["mean"] = residual.means();
  to["low"] = residual.means(-1.0);
  to["high"] = residual.means(1.0);
  to["loop"] = {{"measured_closing", measured[0].means()},
                {"measured_opening", measured[1].means()},
                {"law_closing", by_law[0].means()},
                {"law_opening", by_law[1].means()}};
}

}  // namespace

Json residuals_of(const schema::Recording& recording, std::size_t axis, const LawFile& law,
                  std::size_t columns) {
  const schema::Axis& about = recording.axes.at(axis);
  check_units(law, about);
  AxisSeries series = fit_series(recording, axis, law.contact);
  if (series.force.empty()) throw std::invalid_argument("the recording has no row that is finite");
  const fitting::Jnd jnd = fitting::jnd_of(about.force_unit, about.lever);
  const std::size_t counted = mark_counted(series, recording, axis, {}, jnd.threshold).rows;
  const std::vector<double> force = render(without_rendering_aids(law.law), series);
  std::vector<double> residual;
  double squares = 0.0;
  double worst = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    residual.push_back(force[i] - series.force[i]);
    if (!series.counts.empty() && series.counts[i] == 0) continue;
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
  add_over_time(series, residual, columns, result);
  add_over_penetration(series, force, result);
  return result;
}

}  // namespace kerf::bench
