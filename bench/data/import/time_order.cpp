#include "import/time_order.h"

#include <algorithm>
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

}  // namespace kerf::bench
