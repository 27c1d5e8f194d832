#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "recordings/axis_series.h"
#include "recordings/contact_rows.h"

namespace kerf::bench {

/// By which cycles laws are fitted and judged; they run through the others.
struct CycleChoice {
  enum class By : std::uint8_t {
    good,   ///< those that carry no flag
    all,    ///< whatever is said of them
    listed  ///< those of these numbers
  };
  By by = By::good;
  std::vector<std::uint32_t> listed{};
};

/// `good`, `all` or `2-8,10`. @throws std::invalid_argument that shows how one is written.
[[nodiscard]] CycleChoice parse_cycle_choice(std::string_view text);

/// As parse_cycle_choice() reads it.
[[nodiscard]] std::string in_words(const CycleChoice& choice);

/// By which rows laws are fitted and judged.
struct RowChoice {
  Counted rows = Counted::contact;
  CycleChoice cycles{};
};

struct LeftOutCycle {
  std::uint32_t number = 0;
  std::string reason;
};

/// No choice may leave fewer rows.
inline constexpr std::size_t fewest_counted = 20;

/// What a choice of rows comes to.
struct CountedRows {
  std::size_t rows = 0;                ///< that count
  std::size_t contact = 0;             ///< that are in contact; all, if those were not asked for
  std::size_t cycles = 0;              ///< there are
  std::vector<LeftOutCycle> left_out;  ///< of these
  bool none_is_good = false;           ///< so that all were taken
};

/// Marks the rows of a series of an axis that count: those in contact, from `felt` on, within the cycles that
/// were chosen. A cycle that is left out is none any more, and the others are numbered anew from 1, so that
/// folds are of what is left. Cycles are chosen along their own axis alone.
/// Where of good cycles fewer than 20 rows would be left, all count, which is said.
/// @throws std::invalid_argument for listed cycles that are not there, or of which fewer than 20 rows are
/// left.
CountedRows mark_counted(AxisSeries& series, const schema::Recording& recording, std::size_t axis,
                         const RowChoice& choice, double felt);

/// The same choice with its cycles by number, for who asks for them many times.
[[nodiscard]] CycleChoice settled(const CycleChoice& choice, const schema::Recording& recording,
                                  std::size_t axis, double felt);

/// What was left out, as JSON has it: number and reason of each.
[[nodiscard]] nlohmann::ordered_json as_json(const std::vector<LeftOutCycle>& left_out);

/// What was left out, in a sentence that says how to have it; empty where nothing was.
[[nodiscard]] std::string cycles_left_out(const CountedRows& counted);

}  // namespace kerf::bench
