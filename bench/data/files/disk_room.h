#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace kerf::bench {

/// Asked before work that ends in `file`, or in a folder that is yet to be made, with about so many bytes.
/// What the file system does not tell is no reason to refuse.
/// @throws std::system_error (ENOSPC) that says how much is needed for what, and how much there is.
void require_disk(const std::filesystem::path& file, std::uintmax_t bytes, std::string_view needed_for);

/// What the results of one recording take at most, about [bytes]: law files, tables, charts.
inline constexpr std::uintmax_t bytes_of_results = std::uintmax_t{1} << 20U;

}  // namespace kerf::bench
