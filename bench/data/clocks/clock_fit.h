#pragma once

#include <cstddef>
#include <vector>

namespace kerf::bench {

/// One quantity over time by one clock; times increase, values are finite.
struct ClockedSeries {
  std::vector<double> time_s;
  std::vector<double> values;
};

/// How another clock goes by the first: t = shift_s + (1 + skew) t_other. A skew above zero is of a clock
/// that is slow.
struct ClockFit {
  double shift_s = 0.0;
  double skew = 0.0;
  double shift_error_s = 0.0;  ///< standard errors
  double skew_error = 0.0;
  double correlation = 0.0;  ///< of the two series where they overlap, at the fit
  std::size_t rows = 0;      ///< of the coarser series, that were compared
  std::size_t markers = 0;   ///< that were compared instead (fit_markers()); 0: the series were
  double t95 = 2.131;        ///< standard errors times this are half an interval of 95 %
  /// Moments [s] of markers between others that only one of both has, by its own clock: spurious, or missed
  /// by the other.
  std::vector<double> first_alone_s = {};
  std::vector<double> other_alone_s = {};
};

/// Blocks of the overlap that are left out by turns for the standard errors, and what follows for an interval
/// of 95 %: Student's t of 15 degrees of freedom.
inline constexpr std::size_t clock_blocks = 16;
inline constexpr double clock_t95 = 2.131;

/// Brings two clocks together by what both saw of one quantity. Gain and offset of the other series are free.
///
/// The two are filtered alike (zero-phase Butterworth, 0.2 of the coarser rate) and laid on grids of that
/// rate. The largest correlation coefficient over all shifts with a quarter of overlap, for skews of 0 to
/// +-5e-3, gives a start; from there a(t) = g b + o is solved for shift, skew, g and o, with the slope of b
/// as the instrument, so that noise of a in its own slope does not bias them. Standard errors are those of
/// the delete-one-block jackknife, which allows for residuals that hang together.
/// @throws std::invalid_argument (without a file's name) if they are too short, have nothing in common (a
///         correlation below 0.5), if another shift serves nearly as well (cycles that are all alike), or the
///         data do not determine the clock.
[[nodiscard]] ClockFit fit_clock(const ClockedSeries& first, const ClockedSeries& other);

}  // namespace kerf::bench
