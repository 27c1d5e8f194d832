#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <kerf/compare/series.h>

namespace kerf::compare {

/// What may have happened to forces.
enum class Change : std::uint8_t {
  rounding,    ///< the last digits
  not_finite,  ///< NaN or infinity
  silence,     ///< zero force over some ticks, or to the end
  stuck,       ///< the same force from a tick on
  sign,
  axes,      ///< axes of one unit took each other's place, perhaps with another sign
  rotation,  ///< of three axes, or of two
  unit,      ///< a factor that is known: degrees, mm, gf
  gain,
  offset,
  drift,       ///< a straight line over time
  saturation,  ///< cut at a largest or smallest force
  lag,         ///< by ticks or fractions of one
  rate,        ///< the same over another time
  lost,        ///< samples are not there
  doubled,     ///< samples are there twice
  inserted,    ///< samples are there that were not
  repeated,    ///< samples were replaced by the one before
  spike,
  vibration,
  noise,
  state,       ///< what a law remembers was other at a tick, and dies away
  trajectory,  ///< the force was asked for at other positions
  parameters,  ///< another function of the same motion
};

/// "lost", as JSON and tables name it.
[[nodiscard]] std::string_view name_of(Change change) noexcept;

/// A change that would make such a difference.
struct Finding {
  Change change = Change::gain;
  std::vector<std::size_t> channels;  ///< in which
  /// What is left of the difference once it is taken away: RMS over that of the difference.
  double remainder = 1.0;
  std::string sentence;                                 ///< without the channels
  std::vector<std::pair<std::string, double>> numbers;  ///< {"factor", 57.3}, {"row", 400}, ...
};

/// How much of a difference may be left for a change to be named: one twentieth of its RMS.
inline constexpr double named_remainder = 0.05;

/// What is known besides the forces.
struct Facts {
  std::optional<bool> law_changed;         ///< its file
  std::optional<bool> trajectory_changed;  ///< none: as the positions say, if both have them
};

struct Diagnosis {
  bool explained = true;         ///< in every channel that differs
  std::vector<Finding> names;    ///< that explain the difference of their channels, the best first
  std::vector<Finding> guesses;  ///< the two best where none does
};

/// Says what changed between two runs, per channel and jointly. A change is named if what is left once it is
/// taken away is less than `named_remainder`; where several are, all are named, since they are one signal: a
/// gain, a unit and a parameter of a linear law. For a channel that none explains there are guesses. Rows
/// that the times say are missing are named whatever they leave, and then what changed in the others.
/// Channels must be the same, in the same order. @throws std::invalid_argument if they are not.
[[nodiscard]] Diagnosis diagnose(const Series& expected, const Series& got, const Facts& facts = {});

/// Each name, with its channels, as a line; "unexplained" with the guesses.
[[nodiscard]] std::vector<std::string> sentences_of(const Diagnosis& diagnosis, const Series& expected);

/// Rows of one run that belong to rows of another, with what is missing or added between them left out.
struct MatchedRows {
  std::vector<std::size_t> expected;
  std::vector<std::size_t> got;
  std::size_t edits = 0;  ///< places at which rows are missing or added
  bool by_time = false;   ///< as the times say, where the forces do not
};

/// Finds them by the values themselves, and where those are not the same but for such rows by the times, if
/// both runs have them and they step over what is missing. None if nothing is, or nothing tells of it.
[[nodiscard]] std::optional<MatchedRows> matched_rows(const Series& expected, const Series& got);

/// These rows of a series.
[[nodiscard]] Series rows_of(const Series& series, const std::vector<std::size_t>& rows);

}  // namespace kerf::compare
