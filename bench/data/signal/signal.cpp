#include "signal/signal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <thread>

#include "signal/filters.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

/// Slope at the origin of the parabola fitted to the points (time, value) around it, a straight line for two.
class SlopeFit {
 public:
  void add(double time, double value) noexcept {
    double power = 1.0;
    for (std::size_t k = 0; k < moments_.size(); ++k) {
      moments_[k] += power;
      if (k < products_.size()) products_[k] += power * value;
      power *= time;
    }
  }

  [[nodiscard]] double slope() const noexcept {
    const auto& [s0, s1, s2, s3, s4] = moments_;
    const auto& [y0, y1, y2] = products_;
    const double determinant = s0 * (s2 * s4 - s3 * s3) - s1 * (s1 * s4 - s2 * s3) + s2 * (s1 * s3 - s2 * s2);
    const double scale = s0 * s2 * s4;
    if (determinant > 1e-12 * scale) {
      return (s0 * (y1 * s4 - y2 * s3) - y0 * (s1 * s4 - s2 * s3) + s2 * (s1 * y2 - s2 * y1)) / determinant;
    }
    const double line = s0 * s2 - s1 * s1;
    return line > 0.0 ? (s0 * y1 - s1 * y0) / line : 0.0;
  }

 private:
  std::array<double, 5> moments_{};
  std::array<double, 3> products_{};
};

struct Stretch {
  std::size_t begin;
  std::size_t end;
};

/// The slopes of a stretch of samples, each from the samples around it at whatever times they have.
void fit_slopes(std::span<const double> time_s, std::span<const double> values, double window_s,
                Stretch stretch, std::vector<double>& slopes) {
  const std::size_t count = values.size();
  std::size_t begin = 0;
  std::size_t end = 0;
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    while (begin < i && time_s[i] - time_s[begin] > 0.5 * window_s) ++begin;
    while (end < count && time_s[end] - time_s[i] <= 0.5 * window_s) ++end;
    // A sparse stretch takes its nearest neighbours, so that there is always a slope.
    const std::size_t first = std::min(begin, i > 0 ? i - 1 : 0);
    const std::size_t last = std::max(end, std::min(i + 2, count));
    const double span_s = std::max(time_s[last - 1] - time_s[i], time_s[i] - time_s[first]);
    if (!(span_s > 0.0)) continue;
    SlopeFit fit;
    for (std::size_t k = first; k < last; ++k) fit.add((time_s[k] - time_s[i]) / span_s, values[k]);
    slopes[i] = fit.slope() / span_s;
  }
}

/// The slopes of all samples, a long series in stretches on all cores: each is the same whoever finds it.
void fit_slopes_on_all_cores(std::span<const double> time_s, std::span<const double> values, double window_s,
                             std::vector<double>& slopes) {
  constexpr std::size_t worth_a_thread = 50'000;
  const std::size_t count = values.size();
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t parts = std::clamp<std::size_t>(count / worth_a_thread, 1, cores);
  const auto fit_part = [&](std::size_t part) {
    fit_slopes(time_s, values, window_s, {.begin = part * count / parts, .end = (part + 1) * count / parts},
               slopes);
  };
  for_each_index(parts, parts, fit_part);
}

/// How many samples a window reaches to each side if the times are uniform; 0 if they are not.
std::size_t uniform_reach(std::span<const double> time_s, double window_s) {
  if (time_s.size() < 2) return 0;
  const double period_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  const double reach = 0.5 * window_s / period_s;
  if (!(reach >= 1.0) || 2.0 * reach + 1.0 >= static_cast<double>(time_s.size())) return 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (!(std::abs(time_s[i] - time_s[i - 1] - period_s) <= 1e-6 * period_s)) return 0;
  }
  return static_cast<std::size_t>(reach);
}

/// The same slopes at uniform times, where the parabola's slope is a sum of differences: the ends are left
/// out.
void convolve_slopes(std::span<const double> time_s, std::span<const double> values, std::size_t reach,
                     std::vector<double>& slopes) {
  const std::size_t count = values.size();
  const double period_s = (time_s.back() - time_s.front()) / static_cast<double>(count - 1);
  double squares = 0.0;
  for (std::size_t k = 1; k <= reach; ++k) squares += static_cast<double>(k * k);
  const double scale = 0.5 / (squares * period_s);
  for (std::size_t i = reach; i + reach < count; ++i) {
    double sum = 0.0;
    for (std::size_t k = 1; k <= reach; ++k) sum += static_cast<double>(k) * (values[i + k] - values[i - k]);
    slopes[i] = scale * sum;
  }
}

}  // namespace

std::vector<double> low_pass_zero_phase(std::span<const double> values, double rate_hz, double corner_hz) {
  return SampledFilter({.kind = FilterKind::butterworth2, .corner_hz = corner_hz}, rate_hz).run(values);
}

std::vector<double> differentiate(std::span<const double> time_s, std::span<const double> values,
                                  double window_s) {
  if (time_s.size() != values.size()) throw std::invalid_argument("times and values differ in number");
  if (!(window_s > 0.0)) throw std::invalid_argument("the window of a derivative must be greater than zero");
  window_s *= 1.0 + 1e-6;  // a neighbour on the very edge counts, however its time was rounded
  std::vector<double> slopes(values.size(), 0.0);
  const std::size_t reach = uniform_reach(time_s, window_s);
  if (reach == 0) {
    fit_slopes_on_all_cores(time_s, values, window_s, slopes);
  } else {
    fit_slopes(time_s, values, window_s, {.begin = 0, .end = reach}, slopes);
    convolve_slopes(time_s, values, reach, slopes);
    fit_slopes(time_s, values, window_s, {.begin = values.size() - reach, .end = values.size()}, slopes);
  }
  return slopes;
}

std::vector<double> interpolate(std::span<const double> time_s, std::span<const double> values,
                                std::span<const double> new_time_s) {
  if (time_s.empty() || time_s.size() != values.size()) {
    throw std::invalid_argument("an interpolation needs as many values as times, and at least one");
  }
  std::vector<double> result;
  result.reserve(new_time_s.size());
  for (const double time : new_time_s) {
    const auto above = std::upper_bound(time_s.begin(), time_s.end(), time);
    if (above == time_s.begin()) {
      result.push_back(values.front());
    } else if (above == time_s.end()) {
      result.push_back(values.back());
    } else {
      const auto i = static_cast<std::size_t>(above - time_s.begin());
      const double share = (time - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
      result.push_back(values[i - 1] + share * (values[i] - values[i - 1]));
    }
  }
  return result;
}

}  // namespace kerf::bench
