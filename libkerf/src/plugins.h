#pragma once

#include <cstddef>
#include <string>

// Laws of plug-ins, as a host has loaded them.

namespace kerf {

/// Loads a plug-in; one that is loaded already is that one. @returns the name of its law, which lives for
/// good.
/// @throws std::invalid_argument as kerf_plugin_load() says.
const char* loaded_plugin(const std::string& path, const std::string& sha256);

/// Name of the law of one of those that are loaded, in that order; NULL beyond the last.
[[nodiscard]] const char* plugin_model(std::size_t place) noexcept;
[[nodiscard]] std::size_t plugin_count() noexcept;

}  // namespace kerf
