#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <kerf/schema/final_name.h>
#include <kerf/schema/recorded_rows.h>

#include "files/progress.h"

namespace kerf::bench {

/// What `kerf convert` is asked for.
struct ConvertOptions {
  std::filesystem::path output;  ///< its ending says the format: .csv, .mat or .mcap, in any case
  schema::Existing existing = schema::Existing::keep;
  ShowProgress progress = show_no_progress;
};

/// What it wrote.
struct Converted {
  std::string format;  ///< "csv", "mat", "mcap"
  std::uint64_t rows = 0;
  std::size_t columns = 0;
  std::uint64_t events = 0;
  std::vector<std::filesystem::path> files;  ///< the output first, then what lies beside it
};

/// By the ending of an output: "csv", "mat" or "mcap".
/// @throws std::invalid_argument for an ending that no format has.
[[nodiscard]] std::string conversion_format(const std::filesystem::path& output);

/// The files that such an output consists of, itself first. @throws as conversion_format().
[[nodiscard]] std::vector<std::filesystem::path> files_of_conversion(const std::filesystem::path& output,
                                                                     const schema::Recording& about);

/// Writes the rows of a recording, its events and what it says of itself for other programs
/// (docs/converting.md). Reads some rows at a time; a MAT-file takes the memory of one column.
/// @throws as conversion_format(); std::invalid_argument for a recording that a format cannot hold;
///         std::system_error, and as schema::take_name() does. What fails leaves nothing behind.
[[nodiscard]] Converted convert(const schema::RecordedRows& rows, const ConvertOptions& options);

}  // namespace kerf::bench
