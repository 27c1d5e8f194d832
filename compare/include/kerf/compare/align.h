#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/compare/series.h>

namespace kerf::compare {

/// Which row of one run belongs to which of another.
enum class AlignBy : std::uint8_t {
  tick,      ///< row i and row i
  time,      ///< the same time; values between rows on straight lines
  position,  ///< the same position within the same stroke
  lag,       ///< the same time but for one lag, which is estimated
};

/// @throws std::invalid_argument that lists the names.
[[nodiscard]] AlignBy align_by(std::string_view name);
[[nodiscard]] std::string_view name_of(AlignBy by) noexcept;

/// How much later one run is than another, as the forces themselves say.
struct Lag {
  double seconds = 0.0;
  double ticks = 0.0;        ///< in periods of the expected run
  double std_error_s = 0.0;  ///< one standard deviation
  std::string channel;       ///< from which it is known best
};

struct AlignOptions {
  AlignBy by = AlignBy::tick;
  double most_lag_s = 0.5;  ///< that is looked for
};

/// A step of a clock over more than two and a half periods, where the other run has rows.
struct TimeGap {
  bool of_got = false;  ///< else of the expected run
  double begin_s = 0.0;
  double end_s = 0.0;
  std::size_t rows = 0;  ///< of the other run, which are not compared
};

/// Two runs on the rows of the expected one, as far as both have them.
struct Aligned {
  Series expected;
  Series got;
  std::optional<Lag> lag;                 ///< where it was estimated
  std::optional<double> no_lag_within_s;  ///< where it is longer than was looked for: none is taken out
  std::vector<TimeGap> gaps;              ///< by time and lag
  std::vector<std::string> notes;         ///< what was left out
};

/// Puts two runs beside each other. Channels must be the same, in the same order.
///
/// By time and lag: no straight line stands for a gap of either run; rows of the other in it are left out.
///
/// By position: strokes of the axis that moves most, told apart by reversals of a fiftieth of its range or
/// more, are paired in their order; within one the force of `got` is that at the position of `expected`, on
/// straight lines. Rows at positions that the partner did not reach are left out.
/// @throws std::invalid_argument where that makes no sense: no times, times that do not overlap, no
/// positions, another number of strokes, forces without a lag that could be told.
[[nodiscard]] Aligned aligned(const Series& expected, const Series& got, const AlignOptions& options);

/// The lag that the forces of all channels say together, weighted by how well each knows it. None where no
/// force changes, or least is left at the longest that is looked for.
[[nodiscard]] std::optional<Lag> lag_between_runs(const Series& expected, const Series& got,
                                                  double most_lag_s);

}  // namespace kerf::compare
