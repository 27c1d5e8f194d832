#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace kerf::bench {

/// Where to look for the end of something that holds at first.
struct Search {
  double lower = 0.0;   ///< > 0
  double upper = 0.0;   ///< > lower
  double share = 1e-2;  ///< how closely to find it, as a share of itself
  int scan = 12;        ///< equal steps of the logarithm in which the first failure is looked for
};

/// The largest number below which none was seen to fail: the range is scanned in steps from below, and the
/// step of the first failure is divided until it is small enough. `lower` if it fails there, `upper` if none
/// ever fails. `hold(numbers)` is a std::vector<bool>, asked of up to `many` increasing numbers at once,
/// where that costs little more than asking of one.
template <typename Hold>
[[nodiscard]] double first_change_of_many(const Search& search, std::size_t many, Hold hold) {
  const auto between = [](double lower, double upper, std::size_t part, std::size_t parts) {
    return lower * std::pow(upper / lower, static_cast<double>(part) / static_cast<double>(parts));
  };
  std::vector<double> numbers{search.lower};
  const auto steps = static_cast<std::size_t>(search.scan);
  for (std::size_t i = 1; i < steps; ++i) numbers.push_back(between(search.lower, search.upper, i, steps));
  numbers.push_back(search.upper);
  double good = search.lower;
  double bad = search.upper;
  for (std::size_t begin = 0;; begin += many) {
    if (begin >= numbers.size()) return search.upper;
    const auto part = std::span(numbers).subspan(begin, std::min(many, numbers.size() - begin));
    const std::vector<bool> held = hold(part);
    const auto failed = static_cast<std::size_t>(std::ranges::find(held, false) - held.begin()) + begin;
    if (failed == 0) return search.lower;
    if (failed == begin + part.size()) continue;
    good = numbers[failed - 1];
    bad = numbers[failed];
    break;
  }
  while (bad > good * (1.0 + search.share)) {
    numbers.clear();
    for (std::size_t i = 1; i <= many; ++i) numbers.push_back(between(good, bad, i, many + 1));
    const std::vector<bool> held = hold(std::span<const double>(numbers));
    const auto failed = static_cast<std::size_t>(std::ranges::find(held, false) - held.begin());
    bad = failed < many ? numbers[failed] : bad;
    good = failed > 0 ? numbers[failed - 1] : good;
  }
  return std::sqrt(good * bad);
}

/// The same by one question after another, each step halved: `holds(number)`.
template <typename Holds>
[[nodiscard]] double first_change(const Search& search, Holds holds) {
  return first_change_of_many(search, 1, [&](std::span<const double> numbers) {
    return std::vector<bool>{static_cast<bool>(holds(numbers.front()))};
  });
}

}  // namespace kerf::bench
