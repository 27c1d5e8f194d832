#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/foreign.h>

#include "laws/law_file.h"
#include "laws/law_toml.h"

namespace kerf::bench {

/// Whether somebody named a plug-in where a law or its file is expected: NAME.so.
[[nodiscard]] bool is_plugin(std::string_view name);

/// Loads the law of a plug-in that a person named on the command line, or in a file that they run; a plug-in
/// that is loaded already is that one. What its trial found to be told is among take_plugin_notes().
/// @throws std::invalid_argument in one line that names the file: missing, no law, or one that does not
///         stand its trial (kerf/plugins/load.h).
const models::ForeignLaw& load_plugin(const std::filesystem::path& file);

/// Names of laws, with those of plug-ins in place of their files.
[[nodiscard]] std::vector<std::string> laws_named(std::vector<std::string> laws);

/// A plug-in as a law file: its law with its initial parameters, from the axis' zero on.
[[nodiscard]] LawFile law_of_plugin(const std::filesystem::path& file);

/// What a law file says of the plug-in that its law is of: "[plugin]" with its name and SHA-256. Empty for a
/// law of the house.
[[nodiscard]] std::string plugin_text(const models::Law& law);
/// "the plug-in mylaw.so, SHA-256 ..."; empty likewise.
[[nodiscard]] std::string plugin_in_words(const models::Law& law);

/// Holds that against what is loaded. Another content of the same law is told among take_plugin_notes().
/// @throws std::invalid_argument where the law needs a plug-in that is not given.
void require_plugin(const Place& place, const toml::table& root, std::string_view model);

/// What is to be told of plug-ins since the last call, a line each: a step that allocates or is slow, a law
/// file of another content.
[[nodiscard]] std::vector<std::string> take_plugin_notes();

}  // namespace kerf::bench
