#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kerf::bench {

/// Reads a file of our own; what somebody named is a NamedFile. @throws std::system_error that names it.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& file);

/// Writes a file under a temporary name beside it and renames it, so that a half-written one never stands
/// under the final name. @throws std::system_error that names the file; nothing is left behind then.
void write_whole_file(const std::filesystem::path& file, std::string_view content);

/// Asked before the work that ends in `file`, whose folder may yet have to be made.
/// @throws std::invalid_argument if it exists and `replace` is false, naming --force as the mend;
///         std::system_error if nothing can be written where it is to stand.
void require_output(const std::filesystem::path& file, bool replace);

}  // namespace kerf::bench
