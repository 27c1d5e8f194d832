#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "clocks/clock_fit.h"

namespace kerf::bench {

/// Where a channel crosses a level, upwards or downwards: a marker, as a sync pulse or a tap on the sensor
/// leaves it.
struct MarkerRule {
  std::string channel;
  bool falls = false;
  double level = 0.0;      ///< in SI
  bool has_level = false;  ///< else half way between the least and the most value
};

/// Reads "trigger", "trigger>2.5", "trigger<2.5" for a fall, or two of them, "trigger,sync>0.5": of the first
/// file and of the other one; one alone is of both. Levels are in SI. @throws std::invalid_argument that
/// shows how one is written.
[[nodiscard]] std::vector<MarkerRule> parse_markers(std::string_view text);

/// The moments of a channel's markers. A rising one counts again when the channel has been below the level by
/// a tenth of its range, or half way to its least value if that is nearer, a falling one likewise above.
/// Between the two rows it lies where a line crosses the level, and in their middle where the step is half of
/// the range and more, of which nothing tells when it came.
struct Markers {
  std::vector<double> time_s;
  double period_s = 0.0;  ///< the usual step of the time: a marker is known to within one
};
/// @throws std::invalid_argument (without a file's name) if there is none.
[[nodiscard]] Markers markers_of(const ClockedSeries& series, const MarkerRule& rule);

/// Brings two clocks together by markers that both saw, t = shift_s + (1 + skew) t_other.
///
/// One marker gives the shift alone: the skew is 0 and its error NaN. Two and more give both, by least
/// squares. Where one file has more markers than the other, those of the shorter one are laid on each stretch
/// of the longer one, and the one stretch that fits is taken; where none does, some are missing or spurious,
/// and match_markers() finds those that both have. A marker is known to within a step of the time, evenly:
/// its variance is that of both steps, (a^2 + b^2) / 12, or that of the residuals where this is larger.
/// @throws std::invalid_argument (without a file's name) that says how many each has and what fits none, if
///         they do not fit each other to within both steps and a clock error of 0.5 %, or if several shifts
///         serve alike (pulses at equal times).
[[nodiscard]] ClockFit fit_markers(const Markers& first, const Markers& other);

}  // namespace kerf::bench
