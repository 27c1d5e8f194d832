#pragma once

#include <cstdint>
#include <string>

#include <kerf/schema/recording_file.h>

namespace kerf::bench {

/// A longer one would keep whoever waits for other answers for seconds.
inline constexpr std::uint64_t max_rows_inspected = 1'000'000;

/// What a recording is worth, for its page: "inspection" as `kerf inspect --json` has it, along the axis that
/// it takes by default; "clipped", the runs of clipped rows with their times; or null and "why_none" for one
/// that is longer than max_rows_inspected or still written.
[[nodiscard]] std::string recording_inspection_json(const schema::RecordingFile& file);

}  // namespace kerf::bench
