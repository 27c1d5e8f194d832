#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace kerf::bench {

/// How many rows each value of a signal stands for that was sampled more slowly than it was written: nearly
/// all of its changes come after one and the same number of rows, two and more, and by unlike steps. A
/// quantum that a slow motion passes at even times makes even steps, and is none. Nothing for fewer than
/// fifty changes.
template <typename Values>
[[nodiscard]] std::optional<std::size_t> rows_held(const Values& values) {
  constexpr std::size_t fewest = 50;
  constexpr std::size_t longest = 1000;
  constexpr std::size_t most_steps = 20'000;
  constexpr double nearly_all = 0.9;
  constexpr double alike = 0.02;  // of a step
  std::vector<std::size_t> after(longest + 1, 0);
  std::vector<double> steps;
  std::size_t changes = 0;
  std::size_t last = 0;
  for (std::size_t row = 1; row < values.size(); ++row) {
    const double step = std::abs(values[row] - values[row - 1]);
    if (!(step > 0.0)) continue;
    if (last > 0) {
      ++changes;
      ++after[std::min(row - last, longest)];
      if (steps.size() < most_steps) steps.push_back(step);
    }
    last = row;
  }
  if (changes < fewest) return std::nullopt;
  const auto usual = static_cast<std::size_t>(std::ranges::max_element(after) - after.begin());
  if (usual < 2 || usual == longest ||
      static_cast<double>(after[usual]) < nearly_all * static_cast<double>(changes))
    return std::nullopt;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  const double median = *middle;
  const auto even =
      std::ranges::count_if(steps, [&](double step) { return std::abs(step - median) <= alike * median; });
  return 2 * static_cast<std::size_t>(even) < steps.size() ? std::optional(usual) : std::nullopt;
}

}  // namespace kerf::bench
