#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "exported_law.h"

namespace kerf::bench {

/// Every host there is, as `kerf export --as` lists them.
[[nodiscard]] std::span<const Host> hosts();
/// @throws std::invalid_argument that lists them.
[[nodiscard]] const Host& host_named(std::string_view name);

/// Reads a law for a host.
/// @param name of its files and functions; empty: made of the file's
/// @throws as read_law_file(); std::invalid_argument for a name that is no identifier, and with the reason
/// for
///         a law that the host cannot carry.
[[nodiscard]] ExportedLaw read_for(const Host& host, const std::filesystem::path& law,
                                   const std::string& name);

/// Writes the files for a host into a folder. @returns their names, below it
std::vector<std::string> write_for(const Host& host, const ExportedLaw& law,
                                   const std::filesystem::path& folder);

}  // namespace kerf::bench
