#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace kerf::bench {

/// A uniform grid over samples at any times, so that a filter that needs uniform samples may be run on them:
/// the values are interpolated linearly on the grid of the median period, filtered, and interpolated back.
class UniformSamples {
 public:
  /// Times increase; at least two. Where a step exceeds `longest_gap_s`, the samples before and after it are
  /// filtered apart, each as if it were all there is.
  /// @throws std::invalid_argument for fewer than two times, or times that do not increase.
  explicit UniformSamples(const std::vector<double>& time_s, double longest_gap_s = 1e300);

  [[nodiscard]] double rate_hz() const noexcept { return rate_hz_; }
  [[nodiscard]] std::size_t stretches() const noexcept { return stretches_.size(); }

  /// `filter` is given the uniform samples of a stretch and returns as many.
  using Filter = std::function<std::vector<double>(const std::vector<double>&)>;
  [[nodiscard]] std::vector<double> filtered(const std::vector<double>& values, const Filter& filter) const;

 private:
  /// Samples [begin, end) and their grid; a single sample has none and stays as it is.
  struct Stretch {
    std::size_t begin = 0;
    std::vector<double> time_s;
    std::vector<double> grid_s;
  };

  double rate_hz_ = 0.0;
  std::vector<Stretch> stretches_;
};

}  // namespace kerf::bench
