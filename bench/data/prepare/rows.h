#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/recording.h>

#include "prepare/onset.h"

namespace kerf::bench {

/// Keeps the rows that are true: of every column, with their times and ticks as they were, so that what is
/// missing stays visible as a jump. Phases keep their rows that are left (those with none go), events those
/// that happened at a row that is kept.
void keep_rows(schema::Recording& recording, const std::vector<bool>& keep);

/// Rows where time, position, velocity and the forces are finite, in every axis that has any finite value.
[[nodiscard]] std::vector<bool> finite_rows(const schema::Recording& recording);

/// Keeps the rows of these cycles alone and numbers the cycles anew from 1, with their branches, means and
/// flags.
/// @throws std::invalid_argument if the recording was not segmented, or a cycle is not there.
void keep_cycles(schema::Recording& recording, const std::vector<std::uint32_t>& cycles);

/// `2-8,10` as a list that increases. @throws std::invalid_argument that shows how one is written.
[[nodiscard]] std::vector<std::uint32_t> parse_cycles(std::string_view text);

/// `0:1.5,30:32` in seconds. @throws std::invalid_argument that shows how one is written.
[[nodiscard]] std::vector<TimeSpan> parse_spans(std::string_view text);

}  // namespace kerf::bench
