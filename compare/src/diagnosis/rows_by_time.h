#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kerf/compare/diagnose.h"

namespace kerf::compare {

/// Rows that are missing in either run at one place.
struct Edit {
  std::size_t expected_row = 0;
  std::size_t got_row = 0;
  std::size_t lost = 0;
  std::size_t added = 0;
  std::size_t first = 0;  ///< the first expected row that may be meant: those between look the same
};

/// Rows of one moment by the clocks of both runs, whatever their forces. None where either has no times, no
/// row is missing but at the end, or the clocks do not step over what is.
[[nodiscard]] std::optional<MatchedRows> matched_by_time(const Series& expected, const Series& got);

/// The places at which rows have no partner, but for the end.
[[nodiscard]] std::vector<Edit> edits_of(const MatchedRows& rows);

}  // namespace kerf::compare
