#pragma once

#include <cmath>
#include <limits>

namespace kerf::bench {

/// The largest float that is not above a value, and the smallest that is not below it.
inline float rounded_down(double value) noexcept {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) <= value
             ? nearest
             : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}
inline float rounded_up(double value) noexcept {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) >= value
             ? nearest
             : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

/// The smallest and the largest of the finite values that were added.
class RunningExtremes {
 public:
  /// What is not finite is passed over: less itself it is NaN, and no comparison with that holds.
  void add(double value) noexcept {
    const double finite = value + (value - value);
    if (finite < smallest_) smallest_ = finite;
    if (finite > largest_) largest_ = finite;
  }
  void add_bucket(float smallest, float largest) noexcept {
    if (static_cast<double>(smallest) < smallest_) smallest_ = static_cast<double>(smallest);
    if (static_cast<double>(largest) > largest_) largest_ = static_cast<double>(largest);
  }
  [[nodiscard]] bool has_any() const noexcept { return smallest_ <= largest_; }
  [[nodiscard]] float smallest() const noexcept { return has_any() ? rounded_down(smallest_) : nothing; }
  [[nodiscard]] float largest() const noexcept { return has_any() ? rounded_up(largest_) : nothing; }

 private:
  static constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
  double smallest_ = std::numeric_limits<double>::infinity();
  double largest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace kerf::bench
