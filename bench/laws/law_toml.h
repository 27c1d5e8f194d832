#pragma once

#include <string>

#include <toml++/toml.h>

#include "laws/law_file.h"

namespace kerf::bench {

/// Parses TOML. @throws std::invalid_argument with `name` and the line.
[[nodiscard]] toml::table parse_toml(const std::string& text, const std::string& name);

/// A law that stands in a table of a larger file, such as the tissue of a scene. Messages as in
/// parse_law_file().
[[nodiscard]] LawFile law_from_table(const toml::table& table, const std::string& name);

}  // namespace kerf::bench
