#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "import/import.h"

namespace kerf::bench {

/// An import as a file describes it, which is written once for all files of an instrument:
///
///     map = "time=5[ms],position=4[deg],force=2[gf]"     # or a list of texts; as --map has it
///     sheet = "Run 1"                                    # the others as the options of `kerf import`
///     stretch = 2
///     rate = 100                                         # [Hz]
///     resample = 1000                                    # [Hz]
///     velocity_window = 0.02                             # [s]
///     origin = [0.5, 0, 0.1]                             # [m]
///     point = [0, 0, 0.08]                               # [m]
///     sensor_rotation = [0, 0, 45]                       # [deg]
///     strict = true
///
/// Every key but `map` may be left out.
struct ImportFile {
  std::string map;        ///< as --map has it
  ImportOptions options;  ///< without the map
};

/// @throws std::invalid_argument with file and line.
[[nodiscard]] ImportFile read_import_file(const std::filesystem::path& file);

/// The same as text: what read_import_file() reads back as it was.
[[nodiscard]] std::string import_file_text(const ImportFile& file);

/// A rotation vector that people give in degrees.
[[nodiscard]] std::array<double, 3> radians_of(std::array<double, 3> degrees);

/// Whether what --map was given names such a file: it ends in .toml and maps nothing.
[[nodiscard]] bool names_import_file(std::string_view map);

/// Options that were given, and those of the file for what was left as it is.
[[nodiscard]] ImportOptions with_file_behind(ImportOptions given, const ImportOptions& file);

/// What the parts of --map say, entries or one file, beside options that were given and win over it.
/// @throws std::invalid_argument for two files, and as read_import_file() and parse_map() do.
[[nodiscard]] ImportOptions import_options_of(const std::vector<std::string>& maps, ImportOptions given);

}  // namespace kerf::bench
