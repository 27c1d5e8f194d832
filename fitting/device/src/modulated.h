#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <kerf/identification/output_error.h>
#include <kerf/identification/shots.h>

namespace kerf::identification {

inline constexpr std::size_t half_window = 24;  // ticks
inline constexpr std::size_t window = 2 * half_window + 1;

/// w, w' and w'' at the ticks of a window, in SI.
struct Modulating {
  std::array<double, window> value{};
  std::array<double, window> first{};
  std::array<double, window> second{};

  explicit Modulating(double period_s) {
    const double half_s = static_cast<double>(half_window) * period_s;
    for (std::size_t i = 0; i < window; ++i) {
      const double s = static_cast<double>(i) / static_cast<double>(half_window) - 1.0;
      const double rest = 1.0 - s * s;
      value[i] = std::pow(rest, 4);
      first[i] = -8.0 * s * std::pow(rest, 3) / half_s;
      second[i] = (-8.0 * std::pow(rest, 3) + 48.0 * s * s * rest * rest) / (half_s * half_s);
    }
  }
};

template <typename Value>
double product(const std::array<double, window>& weights, std::size_t begin, const Value& value) {
  double sum = 0.0;
  for (std::size_t i = 0; i < window; ++i) sum += weights[i] * value(begin + i);
  return sum;
}

/// Windows over all stretches, half of each over the one before, of those that are read without a gap.
struct Window {
  std::size_t begin = 0;
  std::size_t place = 0;
  std::size_t cluster = 0;  ///< of an eighth of a stretch's periods, which repeat each other
};
[[nodiscard]] std::vector<Window> windows_of(const AxisData& data, std::span<const Stretch> stretches);

/// What is read, as functions of the tick.
class Signals {
 public:
  /// With the direction by the readings around each; where the axis sticks it is none.
  explicit Signals(const AxisData& data);
  /// With the direction by the friction of a fit: also where and how much the axis sticks.
  Signals(const AxisData& data, const OutputErrorFit& fit);

  [[nodiscard]] double position(std::size_t n) const { return data_.position_m[n]; }
  [[nodiscard]] double direction(std::size_t n) const { return direction_[n]; }
  /// The command that acts at a tick.
  [[nodiscard]] double delayed(std::size_t n, double ticks) const {
    const double at = static_cast<double>(n) - ticks;
    if (at < 0.0) return 0.0;
    // Held from tick to tick: in the mean over the tick around n, a half of a tick later.
    const double shifted = std::max(0.0, at - 0.5);
    const auto whole = static_cast<std::size_t>(shifted);
    const double share = shifted - static_cast<double>(whole);
    const double before = data_.commanded_n[whole];
    const double after = data_.commanded_n[std::min(whole + 1, data_.commanded_n.size() - 1)];
    return before + share * (after - before);
  }

 private:
  const AxisData& data_;
  std::vector<double> direction_;
};

struct LeastSquares {
  Eigen::VectorXd solution;
  Eigen::VectorXd residual;
  Eigen::MatrixXd inverse;
};
[[nodiscard]] LeastSquares least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& right);

/// Columns of m, b, k, f and the offset of each place.
[[nodiscard]] Eigen::MatrixXd columns_of(const AxisData& data, const Signals& signals,
                                         std::span<const Window> windows, std::size_t places);

[[nodiscard]] Eigen::VectorXd forces_of(const AxisData& data, const Signals& signals,
                                        std::span<const Window> windows, double delay_ticks);

}  // namespace kerf::identification
