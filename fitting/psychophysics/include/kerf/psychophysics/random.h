#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace kerf::psychophysics {

/// The same numbers from a seed on every machine and with every compiler, which the distributions of <random>
/// do not promise: a plan that is made again from its seed is the same plan.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1), of 53 bits.
  [[nodiscard]] double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// One of 0 .. count - 1, all equally likely. count > 0.
  [[nodiscard]] std::size_t below(std::size_t count) {
    const std::uint64_t bound = count;
    const std::uint64_t uneven = (UINT64_MAX % bound + 1) % bound;
    std::uint64_t drawn = engine_();
    while (drawn > UINT64_MAX - uneven) drawn = engine_();
    return static_cast<std::size_t>(drawn % bound);
  }

  [[nodiscard]] bool chance(double probability) { return uniform() < probability; }

  /// Normal, of mean 0 and variance 1 [BoxMuller1958]. Two uniform numbers each, so that what follows
  /// does not depend on whether one was left over; the last bit is that of the machine's log and cos.
  [[nodiscard]] double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

  [[nodiscard]] int successes(int trials, double probability) {
    int count = 0;
    for (int i = 0; i < trials; ++i) count += chance(probability) ? 1 : 0;
    return count;
  }

  /// Beta-binomial, by Polya's urn: each answer makes the next of its kind more likely. `correlation` is that
  /// of two answers, in [0, 1).
  [[nodiscard]] int successes(int trials, double probability, double correlation) {
    const double theta = correlation / (1.0 - correlation);
    int count = 0;
    for (int i = 0; i < trials; ++i)
      count += chance((probability + count * theta) / (1.0 + i * theta)) ? 1 : 0;
    return count;
  }

  template <typename T>
  void shuffle(std::vector<T>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(i)]);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace kerf::psychophysics
