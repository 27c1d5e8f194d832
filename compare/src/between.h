#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

namespace kerf::compare {

/// What a signal is between its samples: whoever shifted it took one of these.
enum class Kernel : std::uint8_t { linear, cubic, sinc };
inline constexpr std::array kernels{Kernel::linear, Kernel::cubic, Kernel::sinc};
inline constexpr std::size_t kernel_reach = 16;  ///< rows on either side that a value may depend on

/// Weights of the samples around a place between two of them, `share` of the way from one to the next.
struct Taps {
  std::array<double, 2 * kernel_reach> weight{};
  std::size_t count = 1;
  std::size_t before = 0;  ///< samples before the one at or before the place
  double share = 0.0;
};

[[nodiscard]] inline Taps taps_of(double share, Kernel kernel) noexcept {
  Taps taps{.share = share};
  if (share == 0.0) {
    taps.weight[0] = 1.0;
  } else if (kernel == Kernel::linear) {
    taps.count = 2;
    taps.weight[0] = 1.0 - share;
    taps.weight[1] = share;
  } else if (kernel == Kernel::cubic) {  // Lagrange through four samples
    taps.count = 4;
    taps.before = 1;
    taps.weight[0] = -share * (share - 1.0) * (share - 2.0) / 6.0;
    taps.weight[1] = (share + 1.0) * (share - 1.0) * (share - 2.0) / 2.0;
    taps.weight[2] = -(share + 1.0) * share * (share - 2.0) / 2.0;
    taps.weight[3] = (share + 1.0) * share * (share - 1.0) / 6.0;
  } else {
    taps.count = 2 * kernel_reach;
    taps.before = kernel_reach - 1;
    double sum = 0.0;
    for (std::size_t i = 0; i < taps.count; ++i) {
      const double apart = share + static_cast<double>(kernel_reach) - 1.0 - static_cast<double>(i);
      const double window = std::cos(0.5 * std::numbers::pi * apart / static_cast<double>(kernel_reach));
      // The sine of pi apart is that of pi share, with a sign.
      taps.weight[i] = (i % 2 == 1 ? 1.0 : -1.0) / apart * window * window;
      sum += taps.weight[i];
    }
    for (double& weight : taps.weight) weight /= sum;
  }
  return taps;
}

/// The value `taps.share` of the way from a row to the next; near the ends on a straight line, beyond them
/// that of the end.
[[nodiscard]] inline double value_at(std::span<const double> values, std::ptrdiff_t row,
                                     const Taps& taps) noexcept {
  const auto size = static_cast<std::ptrdiff_t>(values.size());
  if (row < 0) return values.front();
  if (row >= size - 1) return values.back();
  const auto at = static_cast<std::size_t>(row);
  if (at < taps.before || at - taps.before + taps.count > values.size())
    return values[at] + taps.share * (values[at + 1] - values[at]);
  double sum = 0.0;
  const double* const first = values.data() + (at - taps.before);
  for (std::size_t i = 0; i < taps.count; ++i) sum += taps.weight[i] * first[i];
  return sum;
}

/// The same at one place.
[[nodiscard]] inline double value_between(std::span<const double> values, double at, Kernel kernel) noexcept {
  const double row = std::floor(at);
  return value_at(values, static_cast<std::ptrdiff_t>(row), taps_of(at - row, kernel));
}

/// Values of a signal a number of rows, with a fraction, before each.
class Delayed {
 public:
  Delayed(std::span<const double> values, double ticks, Kernel kernel)
      : values_(values),
        whole_(static_cast<std::ptrdiff_t>(std::ceil(ticks))),
        taps_(taps_of(static_cast<double>(whole_) - ticks, kernel)) {}

  [[nodiscard]] double operator()(std::size_t row) const noexcept {
    return value_at(values_, static_cast<std::ptrdiff_t>(row) - whole_, taps_);
  }

 private:
  std::span<const double> values_;
  std::ptrdiff_t whole_;
  Taps taps_;
};

/// Where a function of one number is least in [low, high], by trial at nine places and golden sections.
template <typename Function>
[[nodiscard]] double least_within(const Function& function, double low, double high) {
  constexpr int places = 8;
  const double step = (high - low) / places;
  double best = low;
  double least = function(low);
  for (int i = 1; i <= places; ++i) {
    const double at = low + step * i;
    if (const double value = function(at); value < least) {
      least = value;
      best = at;
    }
  }
  constexpr double golden = 0.6180339887498949;
  double a = std::max(low, best - step);
  double b = std::min(high, best + step);
  double c = b - golden * (b - a);
  double d = a + golden * (b - a);
  double at_c = function(c);
  double at_d = function(d);
  for (int i = 0; i < 40; ++i) {
    if (at_c < at_d) {
      b = d;
      d = c;
      at_d = at_c;
      c = b - golden * (b - a);
      at_c = function(c);
    } else {
      a = c;
      c = d;
      at_c = at_d;
      d = a + golden * (b - a);
      at_d = function(d);
    }
  }
  // A whole number that is as good is meant.
  const double middle = 0.5 * (a + b);
  return function(std::round(middle)) <= function(middle) ? std::round(middle) : middle;
}

}  // namespace kerf::compare
