#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/foreign.h>

#include "laws/law_file.h"
#include "laws/plugin_mention.h"

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

}  // namespace kerf::bench
