#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <kerf/compare/series.h>
#include <kerf/compare/tolerance.h>
#include <kerf/compare/vibration.h>

namespace kerf::compare {

/// One force beside the expected one.
struct ForceDifference {
  std::size_t tick = 0;      ///< row of `expected`
  std::size_t got_tick = 0;  ///< row of `got`: another one where samples are missing
  std::size_t channel = 0;
  double expected = 0.0;
  double got = 0.0;
  double allowed = 0.0;  ///< by the tolerance; 0 where it has to be exact
  double jnds = 0.0;     ///< the difference, in JNDs of the expected force

  [[nodiscard]] double difference() const noexcept { return got - expected; }
};

/// Ticks [begin, end) outside the tolerance. Two that are less than ten ticks apart are one.
struct Interval {
  std::size_t begin = 0;
  std::size_t end = 0;
};
inline constexpr std::size_t most_intervals = 1000;  ///< that are kept

/// What came of one channel.
struct ChannelComparison {
  ChannelName channel;
  std::size_t outside = 0;          ///< ticks outside the tolerance
  double largest_difference = 0.0;  ///< of all finite ticks, also those within the tolerance
  std::size_t largest_at = 0;       ///< its tick, the first of such
  double largest_jnds = 0.0;
  double largest_expected = 0.0;  ///< largest of the expected forces
  double largest_got = 0.0;
  double rms_difference = 0.0;
  std::optional<std::size_t> first_outside;  ///< its tick
  std::size_t not_finite = 0;                ///< ticks in which either force is no finite number
  std::vector<Interval> intervals;           ///< outside, in their order
  std::optional<double> slew;    ///< largest change of the difference from tick to tick, by the period [N/s]
  std::optional<double> drift;   ///< of a straight line through the difference, over the run [N]
  std::vector<BandLevel> bands;  ///< of the difference, where a tolerance asks for them
};

struct Comparison {
  bool passed = true;
  std::size_t expected_rows = 0;
  std::size_t got_rows = 0;
  std::size_t differing = 0;  ///< ticks that are not bit for bit the same
  std::size_t outside = 0;    ///< ticks with a channel outside the tolerance
  std::optional<std::size_t> first_outside;
  std::vector<ChannelComparison> channels;
  std::optional<ForceDifference> worst;  ///< the farthest outside the tolerance, in JNDs; else the farthest
  std::vector<std::string> messages;     ///< why it did not pass, the gravest first
};

/// Compares forces with those expected, tick by tick and channel by channel: row i with row i, as far as both
/// have rows. Another number of rows, or other channels, do not pass, whatever the tolerance.
[[nodiscard]] Comparison compare(const Series& expected, const Series& got, const Tolerance& tolerance);

/// The same, but of runs of different length that are one run with samples missing or added: what is there in
/// both is compared with its own partner, so that one lost sample is not an error of every tick after it.
/// Ticks are those of `expected`.
[[nodiscard]] Comparison compare_with_gaps(const Series& expected, const Series& got,
                                           const Tolerance& tolerance);

}  // namespace kerf::compare
