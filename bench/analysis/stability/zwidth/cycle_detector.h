#pragma once

#include <cstddef>
#include <vector>

namespace kerf::bench {

/// What a window of a signal has of oscillation.
struct FoundCycle {
  bool is_significant = false;
  std::size_t bin = 0;      ///< of the largest peak over its neighbours; its frequency is bin / (ticks T)
  double rms = 0.0;         ///< of the oscillation about it, in the unit of the signal
  double over_floor = 0.0;  ///< power of the peak over the mean of its neighbours
};

/// Looks for one oscillation in a window of N ticks, a tick at a time.
///
/// The window is weighted by Hann's, and its periodogram P taken at all bins from the lowest to the highest
/// (a recursion of Goertzel each: two products a tick). At a bin k the floor is the mean of the L neighbours
/// at k +- 3, 5, 7, ..., which hardly share noise with each other or with k under this window. In Gaussian
/// noise whose spectrum is smooth over 2 L bins, whatever its colour,
///
///     P_k / floor ~ F(2, 2 L),   Pr(P_k / floor > f) = (1 + f / L)^-L
///
/// so that with m bins the largest passes f = L ((m / a)^(1/L) - 1) by chance in a share a of windows at most
/// (Bonferroni). Adding and judging allocate nothing.
class CycleDetector {
 public:
  struct Options {
    std::size_t ticks = 1000;       ///< N, >= 100
    std::size_t lowest_bin = 5;     ///< below it lies what a hand does
    std::size_t highest_bin = 400;  ///< < N / 2 - 4
    std::size_t neighbours = 16;    ///< L, even
    double false_alarms = 1e-3;     ///< a
  };

  /// @throws std::invalid_argument for a window that is too short, or bins that are not in it.
  explicit CycleDetector(const Options& options);

  void restart() noexcept;
  /// A further tick; of no effect once the window is full.
  void add(double value) noexcept;
  [[nodiscard]] bool is_full() const noexcept { return tick_ == options_.ticks; }
  /// Of a full window; nothing significant in another.
  [[nodiscard]] FoundCycle judge() const noexcept;
  /// Rms of an oscillation about a bin, from the power of it and its three neighbours on each side, as far as
  /// they are looked at.
  [[nodiscard]] double rms_at(std::size_t bin) const noexcept;
  /// f.
  [[nodiscard]] double threshold() const noexcept { return threshold_; }

 private:
  [[nodiscard]] double power(std::size_t bin) const noexcept;

  Options options_;
  std::size_t first_bin_;  ///< of the recursions
  double threshold_;
  std::vector<double> window_;
  std::vector<double> turn_;  ///< 2 cos(2 pi k / N)
  std::vector<double> now_, before_;
  double offset_ = 0.0;  ///< the first value, so that a constant loses no digits
  std::size_t tick_ = 0;
};

}  // namespace kerf::bench
