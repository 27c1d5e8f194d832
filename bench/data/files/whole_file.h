#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kerf::bench {

/// Reads a file. @throws std::system_error that names it.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& file);

/// Writes a file under a temporary name beside it and renames it, so that a half-written one never stands
/// under the final name. @throws std::system_error that names the file; nothing is left behind then.
void write_whole_file(const std::filesystem::path& file, std::string_view content);

/// @throws std::invalid_argument if `file` exists and `replace` is false, naming --force as the mend.
void refuse_to_replace(const std::filesystem::path& file, bool replace);

}  // namespace kerf::bench
