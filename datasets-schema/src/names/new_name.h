#pragma once

#include <filesystem>

namespace kerf::schema {

/// No error where there is nothing of that name.
[[nodiscard]] bool is_folder(const std::filesystem::path& path);

// Three ways to a name that nobody has: the next where a file system does not know the one before. Each
// returns 0 or errno: EEXIST if somebody has the name; is_unknown() if this way is not known here.

[[nodiscard]] bool is_unknown(int error) noexcept;

/// By RENAME_NOREPLACE.
[[nodiscard]] int rename_exclusively(const std::filesystem::path& from, const std::filesystem::path& to);
/// By a second name (a link), which is never given over another one; of files only.
[[nodiscard]] int link_exclusively(const std::filesystem::path& from, const std::filesystem::path& to);
/// By an empty file or folder that takes the name, and is then replaced. Whoever replaces that in between
/// without looking is replaced in turn; and whoever is killed in between leaves it empty.
[[nodiscard]] int replace_placeholder(const std::filesystem::path& from, const std::filesystem::path& to);

/// By the first way that is known here. Returns false if somebody has the name.
/// @throws std::system_error
[[nodiscard]] bool rename_new(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace kerf::schema
