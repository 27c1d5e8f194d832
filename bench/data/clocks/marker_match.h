#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace kerf::bench {

/// A straight line between two clocks, t = shift_s + (1 + skew) t_other, by least squares over pairs of
/// moments.
struct ClockLine {
  double shift_s = 0.0;
  double skew = 0.0;
  double mean_other_s = 0.0;
  double spread = 0.0;      ///< sum of squares of the other's times about their mean [s²]
  double squares = 0.0;     ///< of the residuals [s²]
  double most_off_s = 0.0;  ///< largest residual

  [[nodiscard]] double at(double other_s) const { return shift_s + (1.0 + skew) * other_s; }
};

/// A moment of the first file and one of the other, by their places, that are taken for the same.
using MarkerPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// Of one pair: its shift, without skew.
[[nodiscard]] ClockLine line_through(const std::vector<double>& first, const std::vector<double>& other,
                                     const MarkerPairs& pairs);

/// Whether markers lie on the line to within `most_off_s`, and its skew is one that clocks have: 0.5 %, and
/// what two markers at the ends leave open.
[[nodiscard]] bool is_of_clocks(const ClockLine& line, double most_off_s);

/// How the markers of two files fit each other where either has some that the other has not: spurious ones,
/// or missed ones.
struct MarkerMatch {
  MarkerPairs pairs;          ///< of the match with most pairs; in order
  std::size_t next_best = 0;  ///< pairs of the best match that has another shift
  /// Whether the match is one: three pairs and more, two thirds of the markers of the file that has fewer,
  /// and two more than with any other shift. By chance a marker more fits often, two more hardly ever.
  bool is_sure = false;
};

/// From each marker of one file laid on each of the other it goes on in both directions from pair to pair,
/// passes over what has no partner, and takes the line through what it met. Cubic in the number of markers:
/// beyond 2e9 steps (a thousand markers each) it tells nothing, and has no pairs.
[[nodiscard]] MarkerMatch match_markers(const std::vector<double>& first, const std::vector<double>& other,
                                        double most_off_s);

}  // namespace kerf::bench
