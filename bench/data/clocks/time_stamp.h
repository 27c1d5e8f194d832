#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// A moment as a logger writes it.
struct TimeStamp {
  std::int64_t ns =
      0;  ///< since 1970-01-01T00:00:00 of UTC, or of the clock that wrote it; leap seconds not counted
  bool has_zone = false;  ///< it says where: `ns` is of UTC
};

/// Reads a date and time of ISO 8601, or with a date DD.MM.YYYY, at the start of [begin, end) and returns
/// where it ends, or `begin` if there is none: YYYY-MM-DD, 'T' or one blank, hh:mm:ss, a fraction behind '.'
/// or ',' of as many digits as nanoseconds have (further ones have to be zeros), then nothing, 'Z', or an
/// offset +hh:mm, +hhmm or +hh. Years are 1950 to 2149, which 64 bits of nanoseconds hold with their
/// differences. No leap second, no 24:00:00, no date that does not exist. Where columns are separated by
/// commas or blanks, those are no part.
const char* parse_time_stamp(const char* begin, const char* end, char separator, TimeStamp& stamp) noexcept;

/// Whether a whole field is one.
[[nodiscard]] bool is_time_stamp(std::string_view field, TimeStamp& stamp) noexcept;

/// "2026-01-31T12:00:00.123456789", with Z if it is of UTC.
[[nodiscard]] std::string time_stamp_text(const TimeStamp& stamp);

/// The start of a recording in words, with its clock; empty if unknown.
[[nodiscard]] std::string start_text(const schema::Header& header);

}  // namespace kerf::bench
