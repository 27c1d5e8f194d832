#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kerf/compare/diagnose.h"

namespace kerf::compare {

/// One channel of two runs, as far as both have rows, and what lies between.
struct ForcePair {
  std::size_t channel = 0;
  std::string unit;
  std::span<const double> expected;
  std::span<const double> got;
  std::vector<double> difference;
  std::vector<char> contact;  ///< ticks in which there is a force in either
  double period_s = 1e-3;
  double peak = 0.0;            ///< largest force of either
  double tiny = 0.0;            ///< what is no difference: 1e-9 of it
  double rms_difference = 0.0;  ///< over all rows
  bool differs = false;

  [[nodiscard]] std::size_t rows() const noexcept { return expected.size(); }
  /// RMS of got - predicted over that of the difference, in rows [begin, end).
  template <typename Predicted>
  [[nodiscard]] double remainder(const Predicted& predicted, std::size_t begin, std::size_t end) const;
  template <typename Predicted>
  [[nodiscard]] double remainder(const Predicted& predicted) const {
    return remainder(predicted, 0, rows());
  }
};

using Findings = std::vector<Finding>;

// Each adds what it finds in a channel, with its remainder; what leaves more than a guess may is left out.
inline constexpr double guessed_remainder = 0.9;
void add_finding(Findings& found, const ForcePair& pair, Finding finding);

void find_scales(const ForcePair& pair, Findings& found);     ///< sign, unit, gain, offset, drift, saturation
void find_stretches(const ForcePair& pair, Findings& found);  ///< silence, stuck, spike, repeated
void find_times(const ForcePair& pair, Findings& found);      ///< lag, and rate of as many rows
void find_waves(const ForcePair& pair, Findings& found);      ///< vibration, noise
void find_state(const ForcePair& pair, Findings& found);
/// Rate of another number of rows, over the whole of both.
void find_rate(const ForcePair& pair, std::span<const double> expected, std::span<const double> got,
               Findings& found);
/// Of several axes at once: axes, rotation, and what of it is a sign.
void find_axes(const std::vector<ForcePair>& pairs, Findings& found);
/// Of the motion that forces were asked for at: parameters, trajectory.
void find_motion(const ForcePair& pair, const Series& expected, const Series& got, const Facts& facts,
                 Findings& found);
/// Of all channels at once: lost, doubled, inserted.
void find_edits(const Series& expected, const Series& got, const std::vector<ForcePair>& pairs,
                Findings& found);

template <typename Predicted>
double ForcePair::remainder(const Predicted& predicted, std::size_t begin, std::size_t end) const {
  double left = 0.0;
  double all = 0.0;
  for (std::size_t row = begin; row < end; ++row) {
    const double rest = got[row] - predicted(row);
    left += rest * rest;
    all += difference[row] * difference[row];
  }
  if (!(all > 0.0)) return left > 0.0 ? 1e9 : 0.0;
  // What rounding leaves of a large force is nothing to be explained.
  const double floor = static_cast<double>(end - begin) * tiny * tiny;
  return left <= floor ? 0.0 : std::sqrt(left / all);
}

}  // namespace kerf::compare
