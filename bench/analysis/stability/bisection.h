#pragma once

#include <cmath>

namespace kerf::bench {

/// Where to look for the end of something that holds at first.
struct Search {
  double lower = 0.0;   ///< > 0
  double upper = 0.0;   ///< > lower
  double share = 1e-2;  ///< how closely to find it, as a share of itself
  int scan = 12;        ///< equal steps of the logarithm in which the first failure is looked for
};

/// The largest number below which `holds(number)` was never seen to fail: the range is scanned in steps from
/// below, and the step of the first failure is halved until it is small enough. `lower` if it fails there,
/// `upper` if it never fails.
template <typename Holds>
[[nodiscard]] double first_change(const Search& search, Holds holds) {
  if (!holds(search.lower)) return search.lower;
  const double step = std::log(search.upper / search.lower) / search.scan;
  double good = search.lower;
  double bad = search.upper;
  for (int i = 1;; ++i) {
    bad = i < search.scan ? search.lower * std::exp(i * step) : search.upper;
    if (!holds(bad)) break;
    if (i == search.scan) return search.upper;
    good = bad;
  }
  while (bad > good * (1.0 + search.share)) {
    const double middle = std::sqrt(good * bad);
    (holds(middle) ? good : bad) = middle;
  }
  return std::sqrt(good * bad);
}

}  // namespace kerf::bench
