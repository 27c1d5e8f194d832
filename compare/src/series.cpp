#include "kerf/compare/series.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::compare {
namespace {

void require_rows(const std::vector<Channel>& columns, std::size_t rows, const std::string& name) {
  for (const Channel& one : columns) {
    if (one.value.size() == rows) continue;
    throw std::invalid_argument(
        fmt::format("{}: column '{}' has {} rows where the others have {}; all must be of one length", name,
                    one.name, one.value.size(), rows));
  }
}

}  // namespace

std::size_t Series::rows() const noexcept { return channels.empty() ? 0 : channels.front().value.size(); }

double Series::time_of(std::size_t row) const noexcept {
  return row < time_s.size() ? time_s[row] : static_cast<double>(row) * period_s;
}

double Series::period() const {
  if (time_s.size() < 2) return period_s;
  std::vector<double> steps;
  steps.reserve(time_s.size() - 1);
  for (std::size_t row = 1; row < time_s.size(); ++row) steps.push_back(time_s[row] - time_s[row - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

void require_sound(const Series& series, const std::string& name) {
  if (series.channels.empty())
    throw std::invalid_argument(
        fmt::format("{}: there is no force; expected a column in N or N·m or more", name));
  for (const Channel& one : series.channels) {
    if (one.unit == "N" || one.unit == "N·m") continue;
    throw std::invalid_argument(
        fmt::format("{}: '{}' is in '{}', expected N or N·m", name, one.name, one.unit));
  }
  const std::size_t rows = series.rows();
  require_rows(series.channels, rows, name);
  require_rows(series.positions, rows, name);
  require_rows(series.velocities, rows, name);
  if (series.time_s.empty()) {
    if (!(series.period_s > 0.0))
      throw std::invalid_argument(
          fmt::format("{}: a period of {} s, expected more than zero", name, series.period_s));
    return;
  }
  if (series.time_s.size() != rows)
    throw std::invalid_argument(fmt::format("{}: {} times for {} rows", name, series.time_s.size(), rows));
  for (std::size_t row = 1; row < rows; ++row) {
    if (series.time_s[row] > series.time_s[row - 1]) continue;
    throw std::invalid_argument(fmt::format("{}: the time of row {} is {} s after {} s; times must increase",
                                            name, row, series.time_s[row], series.time_s[row - 1]));
  }
}

Series in_order_of(const Series& expected, Series got) {
  const std::string names = names_of(got.channels);
  std::vector<Channel> channels;
  for (const Channel& wanted : expected.channels) {
    const auto found = std::ranges::find_if(
        got.channels, [&](const Channel& one) { return one.name == wanted.name && one.unit == wanted.unit; });
    if (found != got.channels.end()) channels.push_back(std::move(*found));
  }
  if (channels.size() != expected.channels.size() || channels.size() != got.channels.size())
    throw std::invalid_argument(
        fmt::format("the forces are {} where {} are expected", names, names_of(expected.channels)));
  got.channels = std::move(channels);
  return got;
}

std::string names_of(const std::vector<Channel>& channels) {
  std::string text;
  for (const Channel& one : channels)
    text += fmt::format("{}{} [{}]", text.empty() ? "" : ", ", one.name, one.unit);
  return text;
}

}  // namespace kerf::compare
