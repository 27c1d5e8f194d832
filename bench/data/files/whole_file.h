#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/final_name.h>

namespace kerf::bench {

/// Reads a file of our own; what somebody named is a NamedFile. @throws std::system_error that names it.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& file);

/// Writes a file under a temporary name beside it and renames it, so that a half-written one never stands
/// under the final name. @throws std::system_error that names the file, and nothing is left behind; as
/// schema::take_name() does.
void write_whole_file(const std::filesystem::path& file, std::string_view content,
                      schema::Existing existing = schema::Existing::replace);
/// The same of a content in parts, one after the other, which are not put together in memory.
void write_whole_file(const std::filesystem::path& file, std::span<const std::string_view> parts,
                      schema::Existing existing = schema::Existing::replace);

/// Where `file` is to stand, or the nearest folder above it that is there already.
[[nodiscard]] std::filesystem::path existing_folder_of(const std::filesystem::path& file);

/// Asked before the work that ends in `file`, whose folder may yet have to be made.
/// Removes what killed runs have left unfinished there.
/// @throws std::invalid_argument if it has no name, or is one of the inputs that were protected, or exists
/// and
///         `replace` is false, naming --force as the mend; std::system_error if nothing can be written where
///         it is to stand.
void require_output(const std::filesystem::path& file, bool replace);

/// The same of a file that is read to be changed.
void require_change(const std::filesystem::path& file);

/// From now on no output takes the place of this file, whatever may be replaced: it is read for the output.
void protect_input(const std::filesystem::path& file);

/// What require_output() has removed since this was last asked.
[[nodiscard]] std::vector<std::filesystem::path> take_removed_leftovers();

}  // namespace kerf::bench
