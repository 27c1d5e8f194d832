#include "replay/force_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kerf::bench {
namespace {

constexpr double deviation_of_median = 1.4826;

/// The value below which a share of the values lies; they are put into another order. Zero of none.
double value_below(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  const auto at = values.begin() + place;
  std::ranges::nth_element(values, at);
  return *at;
}

std::vector<double> finite_of(std::span<const double> force) {
  std::vector<double> finite;
  finite.reserve(force.size());
  std::ranges::copy_if(force, std::back_inserter(finite), [](double one) { return std::isfinite(one); });
  return finite;
}

/// Sizes of the second differences, of all rows but the first and the last.
std::vector<double> bends_of(const std::vector<double>& force) {
  std::vector<double> bends;
  bends.reserve(force.size());
  for (std::size_t i = 2; i < force.size(); ++i)
    bends.push_back(std::abs(force[i] - 2.0 * force[i - 1] + force[i - 2]));
  return bends;
}

/// The least step, if most steps are no larger.
double step_quantum_of(const std::vector<double>& force, double tiny) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < force.size(); ++i) {
    const double step = std::abs(force[i] - force[i - 1]);
    if (step > tiny) steps.push_back(step);
  }
  if (steps.empty()) return 0.0;
  const double least = std::ranges::min(steps);
  const auto single = std::ranges::count_if(steps, [&](double one) { return one < 1.001 * least; });
  return 2 * static_cast<std::size_t>(single) >= steps.size() ? least : 0.0;
}

/// By all rows but the hundredth in which most happens.
double noise_of_steps(std::vector<double> bends, double quantum) {
  const double most = value_below(bends, 0.99);
  double squares = 0.0;
  for (const double bend : bends) squares += bend <= most ? bend * bend : 0.0;
  return std::sqrt(squares / (6.0 * static_cast<double>(bends.size())) + quantum * quantum / 12.0);
}

/// Rows with a value that neither is the one before nor lies on a straight line between others.
std::vector<std::size_t> new_rows(const std::vector<double>& force, const std::vector<double>& bends,
                                  double straight) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < bends.size(); ++i) {
    if (bends[i] <= straight) continue;
    if (rows.empty() || force[i + 1] != force[rows.back()]) rows.push_back(i + 1);
  }
  return rows;
}

/// From how far each new value is from the line between its neighbours, which are not equally far away.
double noise_of_new(const std::vector<double>& force, const std::vector<std::size_t>& rows) {
  std::vector<double> apart;
  for (std::size_t i = 2; i < rows.size(); ++i) {
    const double share =
        static_cast<double>(rows[i - 1] - rows[i - 2]) / static_cast<double>(rows[i] - rows[i - 2]);
    const double line = force[rows[i - 2]] + share * (force[rows[i]] - force[rows[i - 2]]);
    apart.push_back(std::abs(force[rows[i - 1]] - line) /
                    std::sqrt(1.0 + share * share + (1.0 - share) * (1.0 - share)));
  }
  return deviation_of_median * value_below(apart, 0.5);
}

}  // namespace

double noise_of(std::span<const double> force) {
  constexpr double share_of_new = 0.01;  // corners of a force of straight lines are fewer
  constexpr std::size_t enough = 30;
  const std::vector<double> values = finite_of(force);
  std::vector<double> bends = bends_of(values);
  if (bends.empty()) return 0.0;
  double peak = 0.0;
  for (const double one : values) peak = std::max(peak, std::abs(one));
  const double tiny = 1e-9 * peak;
  if (const double quantum = step_quantum_of(values, tiny); quantum > 0.0)
    return noise_of_steps(bends, quantum);
  std::vector<double> in_order = bends;
  const double noise = deviation_of_median * value_below(in_order, 0.5) / std::sqrt(6.0);
  const double straight = std::max(tiny, 0.01 * value_below(in_order, 0.95));
  const std::vector<std::size_t> rows = new_rows(values, bends, straight);
  if (rows.size() < enough ||
      static_cast<double>(rows.size()) < share_of_new * static_cast<double>(bends.size()))
    return noise;
  return std::max(noise, noise_of_new(values, rows));
}

}  // namespace kerf::bench
