#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::schema {

/// Where a recording is found: under its own name, or as the `NAME.partial` that a writer has not closed.
struct Place {
  std::filesystem::path file;
  bool partial = false;  ///< not closed
  bool being_written =
      false;  ///< a living process is at work on it (never known on a file system without locks)
};

/// Looks for a recording by its name or by that of its partial file; the partial one comes first, as it is
/// the newer. @throws std::invalid_argument if there is neither.
[[nodiscard]] Place find_recording(const std::filesystem::path& name);

/// The end of a recording, to be looked at again and again while it is written.
struct Tail {
  std::string uuid;
  std::string status;
  std::vector<Axis> axes;
  bool measures_force = false;
  std::uint64_t rows = 0;
  Row last;  ///< the last row, if there is any
  std::uint64_t events = 0;
  std::optional<Event> last_event;
};

/// Reads only the end of a file: some milliseconds, however long the recording is.
/// @throws FormatError, of damage a DamageError; std::system_error, std::invalid_argument as
/// read_recording().
[[nodiscard]] Tail read_tail(const std::filesystem::path& file);

}  // namespace kerf::schema
