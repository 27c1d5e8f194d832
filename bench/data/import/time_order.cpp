#include "import/time_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace kerf::bench {

std::vector<std::size_t> rows_in_order(std::span<const double> time_s) {
  // From the last row to the first: how many rows the longest increasing choice holds that begins with this
  // one. latest_begin[n] is the latest time with which a choice of n + 1 rows begins, and falls with n.
  std::vector<std::size_t> lengths(time_s.size(), 0);
  std::vector<double> latest_begin;
  for (std::size_t row = time_s.size(); row-- > 0;) {
    const double time = time_s[row];
    if (!std::isfinite(time)) continue;
    const auto place = std::lower_bound(latest_begin.begin(), latest_begin.end(), time, std::greater<>());
    lengths[row] = static_cast<std::size_t>(place - latest_begin.begin()) + 1;
    if (place == latest_begin.end()) {
      latest_begin.push_back(time);
    } else {
      *place = time;
    }
  }

  std::vector<std::size_t> rows;
  rows.reserve(latest_begin.size());
  double last = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < time_s.size(); ++row) {
    if (lengths[row] == 0 || lengths[row] != latest_begin.size() - rows.size() || !(time_s[row] > last))
      continue;
    rows.push_back(row);
    last = time_s[row];
  }
  return rows;
}

namespace {

constexpr std::size_t fewest_of_a_stretch = 10;
constexpr std::size_t looked_at = 5;

double middle_of(std::span<const double> time_s, std::size_t begin, std::size_t end) {
  std::array<double, looked_at> some{};
  std::size_t count = 0;
  for (std::size_t row = begin; row < end && count < looked_at; ++row) {
    if (std::isfinite(time_s[row])) some.at(count++) = time_s[row];
  }
  std::sort(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : some.at(count / 2);
}

}  // namespace

std::vector<std::size_t> clock_restarts(std::span<const double> time_s) {
  std::vector<std::size_t> restarts;
  std::size_t begin = 0;
  for (std::size_t row = fewest_of_a_stretch; row + fewest_of_a_stretch <= time_s.size(); ++row) {
    if (row - begin < fewest_of_a_stretch || !(time_s[row] < time_s[row - 1])) continue;
    const double start = middle_of(time_s, begin, begin + looked_at);
    const double half = 0.5 * (middle_of(time_s, row - looked_at, row) - start);
    if (!(time_s[row] < start + half) || !(middle_of(time_s, row, row + looked_at) < start + half)) continue;
    restarts.push_back(row);
    begin = row;
  }
  return restarts;
}

}  // namespace kerf::bench
