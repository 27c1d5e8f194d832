#pragma once

#include <cstdint>
#include <filesystem>

namespace kerf::schema {

struct RepairOptions {
  std::filesystem::path output;  ///< empty: the name that the recording was to have
  bool replace = false;          ///< an existing output is replaced
};

struct Repaired {
  std::filesystem::path file;
  std::uint64_t rows = 0;
  double duration_s = 0.0;
};

/// Closes a recording that its writer left open: every row that reached the file is written anew under the
/// final name, with the status "aborted: ..." and an event; only when that stands on the disk is the partial
/// file removed (kept, if `output` names another place). The damaged file itself is never written to.
/// @throws std::invalid_argument if there is nothing to close, its writer is still at work, or the output
///         exists; FormatError; std::system_error, and then the partial file stays as it was.
[[nodiscard]] Repaired repair(const std::filesystem::path& name, const RepairOptions& options);

}  // namespace kerf::schema
